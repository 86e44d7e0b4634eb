// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SampleUnits
 * @brief   the units of a stream's values: a sample is Offset + Scale times the value (internal)
 */
#ifndef SampleUnits_h
#define SampleUnits_h

class vtkDataArray;
struct HiddenSamples;

struct SampleUnits
{
  double Offset = 0.0;
  double Scale = 1.0;

  bool IsIdentity() const { return this->Offset == 0.0 && this->Scale == 1.0; }

  /**
   * Finds units in which float32 can hold the visible, finite samples of a component. The identity
   * for types of at most 24 bits. Otherwise, takes the middle off values that differ by less than a
   * 16th of their magnitude, and scales what is beyond float32.
   */
  static SampleUnits Find(vtkDataArray* array, int component, const HiddenSamples& hidden);

  /// Scales by a power of two, so that a value of this magnitude lands between 1 and 2.
  void Normalize(double magnitude);
};

#endif
