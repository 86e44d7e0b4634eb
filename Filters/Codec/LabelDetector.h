// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   LabelDetector
 * @brief   tells labels and masks from measured values (internal)
 *
 * Labels are whole numbers, of any type, few of them in one place: where a block of 4x4x4 samples
 * has different values at all, it has 8 of them or fewer in the mean. They are either few in all
 * (16), or far apart: smooth fields that were rounded have few values in a block, too, but then
 * each is next to another.
 */
#ifndef LabelDetector_h
#define LabelDetector_h

#include "Codec/HiddenSamples.h"

#include "vtkType.h"

#include <cstddef>
#include <set>

class vtkDataArray;

class LabelDetector
{
public:
  /// Error that leaves a label on its side of the half-integers next to it.
  static constexpr double Tolerance = 0.49;

  HiddenSamples Hidden;

  /// Takes the slabs [first, last) of a volume into account, of one component of an array whose
  /// first tuple is the first sample of slab `first`. Slabs must come in order.
  void AddSlabs(
    const int dims[3], vtkTypeInt64 first, vtkTypeInt64 last, vtkDataArray* array, int component);

  /// Whether what was seen already is no labels.
  bool IsSettled() const { return this->HasOthers; }

  /// Whether all that was seen is labels.
  bool FindsLabels() const;

private:
  struct Worker;

  void AddBlock(const float* samples, int count);
  bool AreCrowded() const;

  bool HasOthers = false;
  std::set<float> Values;       // up to one more than is few in all
  vtkTypeInt64 Blocks = 0;      // with different values
  vtkTypeInt64 BlockValues = 0; // different ones, of all these
  double Spans = 0.0;           // largest less smallest value, of all these
};

#endif
