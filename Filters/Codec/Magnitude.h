// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which samples of an array are compressed: one of its components, or, with VTK's habit of -1 for a
 * component, the magnitude of its vectors (internal).
 */
#ifndef Magnitude_h
#define Magnitude_h

#include "Status.h"

#include "vtkSmartPointer.h"

class vtkDataArray;

/// An array and the component of it that has the samples.
struct ChosenSamples
{
  vtkSmartPointer<vtkDataArray> Array;
  int Component = 0;
  int Original = 0; ///< what they were: the component, or Magnitude
};

/// Whether an array has a component, or `component` stands for its magnitude.
bool HasComponent(vtkDataArray* array, int component);

/// Whether an array is of a type that has NaN and infinite values.
bool HasNonFinite(vtkDataArray* array);

/// Computes the magnitudes where they are asked for and the array has several components: as
/// doubles of types that float32 does not hold, else as floats. Anything else is chosen as it is.
/// An error where there is no memory for them.
Status ChooseSamples(vtkDataArray* array, int component, ChosenSamples& samples);

#endif
