// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   LevelFilter
 * @brief   makes a level of detail of the one before, some slices at a time (internal)
 *
 * HalvingFilter's along x, then y, then z, as far as the level halves them. Slices are taken in
 * order; those are kept that coming ones need. What comes out depends neither on how many are added
 * at a time, nor on the number of threads.
 *
 * A coarse cell is hidden where more than half of the fine cells in it are: themselves, or by a
 * corner.
 */
#ifndef LevelFilter_h
#define LevelFilter_h

#include "Codec/LevelShape.h"
#include "Codec/LevelSlice.h"

#include <deque>
#include <vector>

class LevelFilter
{
public:
  /// Makes of a level with so many samples per axis the one of a shape.
  LevelFilter(const int dims[3], const LevelShape& shape, int threads);

  /// Takes the next slices, and returns those of the coarse level that can be made now, in order.
  std::vector<LevelSlice> Add(std::vector<LevelSlice> slices);

  /// How far the interpolant of the coarse samples made so far is off the visible fine ones at
  /// most, where its cells have no hidden corner.
  float GetLargestDistance() const { return this->LargestDistance; }

  /// The most fine slices that were kept from one call to the next.
  int GetMostSlicesKept() const { return this->MostKept; }

private:
  using Bytes = std::vector<unsigned char>;

  /// Slices that are kept, by their numbers.
  class Window
  {
  public:
    void Add(LevelSlice slice) { this->Slices.push_back(std::move(slice)); }
    void ForgetBefore(int number);
    int GetEnd() const { return this->First + static_cast<int>(this->Slices.size()); }
    int GetSize() const { return static_cast<int>(this->Slices.size()); }
    const LevelSlice& Get(int number) const { return this->Slices[number - this->First]; }

  private:
    std::deque<LevelSlice> Slices;
    int First = 0;
  };

  /// A fine slice, by its number, and the coarse ones that it lies between, or on.
  struct Comparison
  {
    int Fine;
    const LevelSlice* Before;
    const LevelSlice* After; ///< null if the fine one lies on the other
  };

  int StepAlong(int axis) const { return this->Shape.Halves[axis] ? 2 : 1; }
  bool IsReady(int coarse) const;
  std::vector<LevelSlice> ReduceAlongX(const std::vector<LevelSlice>& slices) const;
  std::vector<LevelSlice> ReduceAlongY(std::vector<LevelSlice> slices) const;
  std::vector<LevelSlice> MakeSlices() const;
  LevelSlice MakeRoomFor(int coarse) const;
  int FirstNear(int coarse) const;
  int LastNear(int coarse) const;
  Bytes FindHiddenCells(int coarse) const;
  bool HidesCell(int x, int y, int z) const;
  bool HidesMostCells(int x, int y, int z) const;
  void Compare(const std::vector<LevelSlice>& made);
  float CompareRow(const Comparison& slices, int y) const;

  int Dimensions[3];
  LevelShape Shape;
  int Threads;
  Window Fine;
  Window Reduced;  // along x and y
  LevelSlice Last; // the coarse slice made last
  int Made = 0;    // coarse slices
  int MostKept = 0;
  float LargestDistance = 0.0f;
};

#endif
