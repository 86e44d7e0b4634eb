// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SampleUnits
 * @brief   the units of a stream's values: a sample is Offset + Scale times the value (internal)
 */
#ifndef SampleUnits_h
#define SampleUnits_h

#include "vtkType.h"

#include <limits>

class vtkDataArray;
struct HiddenSamples;

struct SampleUnits
{
  double Offset = 0.0;
  double Scale = 1.0;

  bool IsIdentity() const { return this->Offset == 0.0 && this->Scale == 1.0; }

  /// Finds the units of samples that are all in one array, see UnitsFinder.
  static SampleUnits Find(vtkDataArray* array, int component, const HiddenSamples& hidden);

  /// Scales by a power of two, so that a value of this magnitude lands between 1 and 2.
  void Normalize(double magnitude);
};

/**
 * Finds units in which float32 and zfp can hold the visible, finite samples of one component, which
 * come in one array or in several of one type. The identity for types of at most 16 bits.
 * Otherwise, takes the middle off values that differ by less than a 16th of their magnitude where
 * float32 cannot hold these, and scales what is too large for float32, or where zfp might find
 * blocks too small. The order of the arrays, and how they are cut, do not matter.
 */
class UnitsFinder
{
public:
  /// Takes samples into account, as far as they can still change the units.
  void Add(vtkDataArray* array, int component, const HiddenSamples& hidden);

  /// Whether further samples of the same type cannot change the units any more.
  bool IsSettled() const;

  SampleUnits GetUnits() const;

private:
  bool HasValues() const { return this->Low <= this->High; }
  double GetMagnitude() const;
  bool NeedsOffset() const;

  int Type = VTK_VOID;
  bool IsSmallType = false; // of at most 16 bits
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();
};

#endif
