// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelFilter.h"

#include "Codec/HalvingFilter.h"
#include "Codec/SliceLoop.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{
using Bytes = std::vector<unsigned char>;

//------------------------------------------------------------------------------
LevelRow RowOf(const LevelSlice& slice, int y, int width)
{
  const std::size_t first = static_cast<std::size_t>(y) * width;
  return { slice.Values.data() + first, slice.Hidden.empty() ? nullptr : &slice.Hidden[first] };
}

//------------------------------------------------------------------------------
// Makes room for a slice's samples, and if asked for, its flags.
LevelSlice MakeRoom(int width, int height, bool withFlags)
{
  const std::size_t samples = static_cast<std::size_t>(width) * height;
  LevelSlice slice;
  slice.Values.resize(samples);
  slice.Hidden.resize(withFlags ? samples : 0);
  return slice;
}

//------------------------------------------------------------------------------
// The mean of 1, 2 or 4 rows, and what their hidden samples hide.
struct MeanRow
{
  std::vector<float> Values;
  Bytes Hidden;
  bool IsMasked = false;

  void Make(const LevelRow rows[4], int number, int width)
  {
    const float weight = 1.0f / number;
    this->Values.assign(width, 0.0f);
    this->IsMasked = false;
    for (int i = 0; i < number; ++i)
    {
      const float* const values = rows[i].Values;
      for (int x = 0; x < width; ++x)
      {
        this->Values[x] += weight * values[x];
      }
      if (rows[i].Hidden)
      {
        this->Hide(rows[i].Hidden, width);
      }
    }
  }

  void Hide(const unsigned char* flags, int width)
  {
    if (!this->IsMasked)
    {
      this->Hidden.assign(width, 0);
    }
    this->IsMasked = true;
    std::transform(this->Hidden.begin(), this->Hidden.end(), flags, this->Hidden.begin(),
      [](unsigned char a, unsigned char b) { return a | b; });
  }

  bool Hides(int x) const { return this->IsMasked && this->Hidden[x]; }
};

//------------------------------------------------------------------------------
// Finds how far a row of fine samples is off the interpolant of a row of coarse ones.
float DistanceOfRows(const LevelRow& fine, int count, const MeanRow& coarse, bool isHalved)
{
  const float* const values = coarse.Values.data();
  float most = 0.0f;
  if (!fine.Hidden && !coarse.IsMasked)
  {
    for (int x = 0; x < count; ++x)
    {
      const float expected =
        isHalved ? 0.5f * values[x / 2] + 0.5f * values[(x + 1) / 2] : values[x];
      const float off = std::abs(fine.Values[x] - expected);
      most = off > most ? off : most;
    }
    return most;
  }
  for (int x = 0; x < count; ++x)
  {
    const int low = isHalved ? x / 2 : x, high = isHalved ? (x + 1) / 2 : x;
    if (!(fine.Hidden && fine.Hidden[x]) && !coarse.Hides(low) && !coarse.Hides(high))
    {
      const float expected = 0.5f * values[low] + 0.5f * values[high];
      most = std::max(most, std::abs(fine.Values[x] - expected));
    }
  }
  return most;
}
}

//------------------------------------------------------------------------------
void LevelFilter::Window::ForgetBefore(int number)
{
  while (this->First < number && !this->Slices.empty())
  {
    this->Slices.pop_front();
    ++this->First;
  }
}

//------------------------------------------------------------------------------
LevelFilter::LevelFilter(const int dims[3], const LevelShape& shape, int threads)
  : Shape(shape)
  , Threads(threads > 0 ? threads : omp_get_max_threads())
{
  std::copy_n(dims, 3, this->Dimensions);
}

//------------------------------------------------------------------------------
std::vector<LevelSlice> LevelFilter::Add(std::vector<LevelSlice> slices)
{
  for (LevelSlice& slice : this->ReduceAlongY(this->ReduceAlongX(slices)))
  {
    this->Reduced.Add(std::move(slice));
  }
  for (LevelSlice& slice : slices)
  {
    this->Fine.Add(std::move(slice));
  }
  std::vector<LevelSlice> made = this->MakeSlices();
  this->Compare(made);
  if (!made.empty())
  {
    this->Last = made.back();
    this->Made += static_cast<int>(made.size());
  }
  const int step = this->StepAlong(2), next = step * this->Made;
  this->Fine.ForgetBefore(next - step + 1);
  this->Reduced.ForgetBefore(this->Shape.Halves[2] ? next - HalvingFilter::Reach : next);
  this->MostKept = std::max({ this->MostKept, this->Fine.GetSize(), this->Reduced.GetSize() });
  return made;
}

//------------------------------------------------------------------------------
// A coarse slice needs the fine ones that the filter reaches, and that its cells lie between.
bool LevelFilter::IsReady(int coarse) const
{
  const int needed = this->Shape.Halves[2] ? 2 * coarse + HalvingFilter::Reach : coarse + 1;
  return coarse < this->Shape.Dimensions[2] &&
    this->Fine.GetEnd() > std::min(needed, this->Dimensions[2] - 1);
}

//------------------------------------------------------------------------------
std::vector<LevelSlice> LevelFilter::ReduceAlongX(const std::vector<LevelSlice>& slices) const
{
  const int width = this->Dimensions[0], height = this->Dimensions[1];
  const int reduced = this->Shape.Dimensions[0];
  std::vector<LevelSlice> along;
  for (const LevelSlice& slice : slices)
  {
    along.push_back(this->Shape.Halves[0] ? MakeRoom(reduced, height, !slice.Hidden.empty())
                                          : LevelSlice{ slice.Values, slice.Hidden, {} });
  }
  if (this->Shape.Halves[0])
  {
    ForEachRow(this->Threads, along, reduced,
      [&](std::size_t slice, int y, float* values, unsigned char* hidden)
      { HalvingFilter::FilterAlong(RowOf(slices[slice], y, width), width, values, hidden); });
  }
  return along;
}

//------------------------------------------------------------------------------
std::vector<LevelSlice> LevelFilter::ReduceAlongY(std::vector<LevelSlice> slices) const
{
  if (!this->Shape.Halves[1])
  {
    return slices;
  }
  const int width = this->Shape.Dimensions[0], height = this->Dimensions[1];
  std::vector<LevelSlice> across;
  for (const LevelSlice& slice : slices)
  {
    across.push_back(MakeRoom(width, this->Shape.Dimensions[1], !slice.Hidden.empty()));
  }
  ForEachRow(this->Threads, across, width,
    [&](std::size_t slice, int y, float* values, unsigned char* hidden)
    {
      LevelRow rows[HalvingFilter::Taps];
      for (int i = 0; i < HalvingFilter::Taps; ++i)
      {
        const int from = 2 * y + i - HalvingFilter::Reach;
        rows[i] = from >= 0 && from < height ? RowOf(slices[slice], from, width) : LevelRow();
      }
      HalvingFilter::FilterAcross(rows, width, values, hidden);
    });
  for (LevelSlice& slice : across)
  {
    ClearUnlessAny(slice.Hidden);
  }
  return across;
}

//------------------------------------------------------------------------------
// Makes all coarse slices that can be made now.
std::vector<LevelSlice> LevelFilter::MakeSlices() const
{
  std::vector<LevelSlice> made;
  for (int coarse = this->Made; this->IsReady(coarse); ++coarse)
  {
    made.push_back(this->Shape.Halves[2] ? this->MakeRoomFor(coarse) : this->Reduced.Get(coarse));
  }
  if (this->Shape.Halves[2])
  {
    const int width = this->Shape.Dimensions[0];
    ForEachRow(this->Threads, made, width,
      [&](std::size_t slice, int y, float* values, unsigned char* hidden)
      {
        LevelRow rows[HalvingFilter::Taps];
        const int coarse = this->Made + static_cast<int>(slice);
        for (int z = this->FirstNear(coarse); z <= this->LastNear(coarse); ++z)
        {
          rows[z - 2 * coarse + HalvingFilter::Reach] = RowOf(this->Reduced.Get(z), y, width);
        }
        HalvingFilter::FilterAcross(rows, width, values, hidden);
      });
  }
  for (std::size_t i = 0; i < made.size(); ++i)
  {
    ClearUnlessAny(made[i].Hidden);
    made[i].HiddenCells = this->FindHiddenCells(this->Made + static_cast<int>(i));
  }
  return made;
}

//------------------------------------------------------------------------------
// The fine slices that the filter takes for a coarse one.
int LevelFilter::FirstNear(int coarse) const
{
  return std::max(2 * coarse - HalvingFilter::Reach, 0);
}

int LevelFilter::LastNear(int coarse) const
{
  return std::min(2 * coarse + HalvingFilter::Reach, this->Dimensions[2] - 1);
}

//------------------------------------------------------------------------------
LevelSlice LevelFilter::MakeRoomFor(int coarse) const
{
  bool isMasked = false;
  for (int z = this->FirstNear(coarse); z <= this->LastNear(coarse); ++z)
  {
    isMasked = isMasked || !this->Reduced.Get(z).Hidden.empty();
  }
  return MakeRoom(this->Shape.Dimensions[0], this->Shape.Dimensions[1], isMasked);
}

//------------------------------------------------------------------------------
LevelFilter::Bytes LevelFilter::FindHiddenCells(int coarse) const
{
  const int width = this->Shape.Dimensions[0], height = this->Shape.Dimensions[1];
  const int first = this->StepAlong(2) * coarse;
  const int last = std::min(first + this->StepAlong(2), this->Dimensions[2] - 1);
  bool isMasked = false;
  for (int z = first; z <= last; ++z)
  {
    const LevelSlice& slice = this->Fine.Get(z);
    isMasked = isMasked || !slice.Hidden.empty() || (z < last && !slice.HiddenCells.empty());
  }
  if (!isMasked || first >= last)
  {
    return {};
  }
  Bytes cells(static_cast<std::size_t>(width) * height);
#pragma omp parallel for num_threads(this->Threads) schedule(static)
  for (int y = 0; y < height - 1; ++y)
  {
    for (int x = 0; x < width - 1; ++x)
    {
      cells[static_cast<std::size_t>(y) * width + x] = this->HidesMostCells(x, y, coarse);
    }
  }
  ClearUnlessAny(cells);
  return cells;
}

//------------------------------------------------------------------------------
bool LevelFilter::HidesMostCells(int x, int y, int z) const
{
  const int coarse[3] = { x, y, z };
  int first[3], last[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    first[axis] = this->StepAlong(axis) * coarse[axis];
    last[axis] = std::min(first[axis] + this->StepAlong(axis), this->Dimensions[axis] - 1);
  }
  int all = 0, hidden = 0;
  for (int k = first[2]; k < last[2]; ++k)
  {
    for (int j = first[1]; j < last[1]; ++j)
    {
      for (int i = first[0]; i < last[0]; ++i)
      {
        ++all;
        hidden += this->HidesCell(i, j, k);
      }
    }
  }
  return 2 * hidden > all;
}

//------------------------------------------------------------------------------
bool LevelFilter::HidesCell(int x, int y, int z) const
{
  const std::size_t width = this->Dimensions[0];
  const std::size_t at = y * width + x;
  const LevelSlice& own = this->Fine.Get(z);
  if (!own.HiddenCells.empty() && own.HiddenCells[at])
  {
    return true;
  }
  for (int side = 0; side <= 1; ++side)
  {
    const Bytes& hidden = this->Fine.Get(z + side).Hidden;
    if (!hidden.empty() &&
      (hidden[at] || hidden[at + 1] || hidden[at + width] || hidden[at + width + 1]))
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
// Compares the fine slices from behind the last coarse one on with the interpolant.
void LevelFilter::Compare(const std::vector<LevelSlice>& made)
{
  std::vector<Comparison> comparisons;
  const LevelSlice* before = &this->Last;
  for (std::size_t i = 0; i < made.size(); ++i)
  {
    const int coarse = this->Made + static_cast<int>(i), at = this->StepAlong(2) * coarse;
    if (this->Shape.Halves[2] && coarse > 0)
    {
      comparisons.push_back({ at - 1, before, &made[i] });
    }
    if (at < this->Dimensions[2])
    {
      comparisons.push_back({ at, &made[i], nullptr });
    }
    before = &made[i];
  }
  const int height = this->Dimensions[1];
  const vtkTypeInt64 number = static_cast<vtkTypeInt64>(comparisons.size()) * height;
  float most = this->LargestDistance;
#pragma omp parallel for num_threads(this->Threads) schedule(dynamic, RowsPerTurn)                 \
  reduction(max                                                                                    \
            : most) if (IsWorthThreads(number, this->Dimensions[0]))
  for (vtkTypeInt64 row = 0; row < number; ++row)
  {
    const int y = static_cast<int>(row % height);
    most = std::max(most, this->CompareRow(comparisons[row / height], y));
  }
  this->LargestDistance = most;
}

//------------------------------------------------------------------------------
float LevelFilter::CompareRow(const Comparison& slices, int y) const
{
  const int width = this->Shape.Dimensions[0], step = this->StepAlong(1);
  const int low = y / step, high = (y + step - 1) / step;
  LevelRow rows[4];
  int number = 0;
  for (const LevelSlice* slice : { slices.Before, slices.After })
  {
    if (slice)
    {
      rows[number++] = RowOf(*slice, low, width);
    }
    if (slice && high != low)
    {
      rows[number++] = RowOf(*slice, high, width);
    }
  }
  thread_local MeanRow mean;
  mean.Make(rows, number, width);
  return DistanceOfRows(RowOf(this->Fine.Get(slices.Fine), y, this->Dimensions[0]),
    this->Dimensions[0], mean, this->Shape.Halves[0]);
}
