// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   RateFinder
 * @brief   finds the least rate that keeps the samples of some slabs within a tolerance (internal)
 *
 * Every block is encoded and decoded at the rate that its slab began with; one that is not within
 * the tolerance is bisected for the least rate that keeps it. Errors do not fall at every step, so
 * that blocks seen before may be off at a higher rate: only a pass in which the rate did not rise
 * has seen all blocks at the rate.
 */
#ifndef RateFinder_h
#define RateFinder_h

#include "Codec/HiddenSamples.h"
#include "Codec/SampleUnits.h"

#include "vtkType.h"

class vtkDataArray;

class RateFinder
{
public:
  SampleUnits Units;
  HiddenSamples Hidden;
  double Tolerance = 0.0; ///< in the samples' own units
  int Threads = 0;

  /// Takes the slabs [first, last) of a volume into account, of one component of an array whose
  /// first tuple is the first sample of slab `first`.
  void AddSlabs(
    const int dims[3], vtkTypeInt64 first, vtkTypeInt64 last, vtkDataArray* array, int component);

  /// Finds the bits of a block for all of a volume. False if there are none, see GetLeastError().
  bool Find(const int dims[3], vtkDataArray* array, int component);

  int GetBlockBits() const { return this->BlockBits; }
  void SetBlockBits(int bits) { this->BlockBits = bits; } ///< to begin with

  /// The error that the worst block has at the highest rate, where it is above the tolerance, else
  /// 0.
  double GetLeastError() const { return this->LeastError; }

private:
  struct Worker;

  int BlockBits = 9;
  double LeastError = 0.0;
};

#endif
