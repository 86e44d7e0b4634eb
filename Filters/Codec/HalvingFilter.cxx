// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HalvingFilter.h"

#include "Codec/LevelShape.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace
{
using HalvingFilter::Reach;
using HalvingFilter::Taps;

//------------------------------------------------------------------------------
// Products come before sums: so the largest floats do not overflow to what is no number.
inline float HalfBand(float before3, float before, float at, float after, float after3)
{
  const float value =
    0.5f * at + 0.28125f * before + 0.28125f * after - 0.03125f * before3 - 0.03125f * after3;
  const float low = std::min(std::min(before, after), at);
  const float high = std::max(std::max(before, after), at);
  return std::min(std::max(value, low), high);
}

//------------------------------------------------------------------------------
inline float Mirror(float border, float inside)
{
  constexpr float most = std::numeric_limits<float>::max();
  return std::min(std::max(border + (border - inside), -most), most);
}

//------------------------------------------------------------------------------
// The fine samples around one coarse sample, at distances from -Reach to Reach.
class Neighbourhood
{
public:
  void Add(int distance, float value, bool isHidden)
  {
    this->Values[Reach + distance] = value;
    this->Present |= this->BitOf(distance);
    this->AnyHidden = this->AnyHidden || isHidden;
    this->Visible |= isHidden ? 0 : this->BitOf(distance);
  }

  /// Returns the coarse sample, and whether it is hidden.
  float Filter(bool& isHidden) const
  {
    isHidden = false;
    if (!this->Has(0))
    {
      return this->FirstVisible(-1, -1, isHidden);
    }
    if (!this->Has(-1) || !this->Has(1))
    {
      return this->FirstVisible(0, this->Has(1) ? 1 : -1, isHidden);
    }
    return this->AnyHidden
      ? this->MeanOfVisible(isHidden)
      : HalfBand(this->Far(-1), this->At(-1), this->At(0), this->At(1), this->Far(1));
  }

private:
  static unsigned BitOf(int distance) { return 1u << (Reach + distance); }
  bool Has(int distance) const { return this->Present & BitOf(distance); }
  bool Sees(int distance) const { return this->Visible & BitOf(distance); }
  float At(int distance) const { return this->Values[Reach + distance]; }

  float FirstVisible(int distance, int other, bool& isHidden) const
  {
    isHidden = !this->Sees(distance) && !this->Sees(other);
    return this->At(this->Sees(distance) ? distance : other);
  }

  float MeanOfVisible(bool& isHidden) const
  {
    double sum = 0.0, weights = 0.0;
    for (int distance = -1; distance <= 1; ++distance)
    {
      const double weight = this->Sees(distance) ? 2.0 - std::abs(distance) : 0.0;
      sum += weight > 0.0 ? weight * this->At(distance) : 0.0;
      weights += weight;
    }
    isHidden = weights == 0.0;
    return isHidden ? 0.0f : static_cast<float>(sum / weights);
  }

  // The sample at the full reach, below (-1) or above (1).
  float Far(int side) const
  {
    const int border = this->Has(2 * side) ? 2 * side : side;
    return this->Has(Reach * side) ? this->At(Reach * side)
                                   : Mirror(this->At(border), this->At(2 * border - Reach * side));
  }

  float Values[Taps] = {};
  unsigned Present = 0;
  unsigned Visible = 0;
  bool AnyHidden = false;
};

//------------------------------------------------------------------------------
// Makes one coarse sample of a row.
void FilterAt(const LevelRow& row, int count, int coarse, float* values, unsigned char* hidden)
{
  Neighbourhood near;
  const int at = 2 * coarse;
  for (int i = std::max(at - Reach, 0); i <= std::min(at + Reach, count - 1); ++i)
  {
    near.Add(i - at, row.Values[i], row.Hidden && row.Hidden[i]);
  }
  bool isHidden = false;
  values[coarse] = near.Filter(isHidden);
  if (hidden)
  {
    hidden[coarse] = isHidden;
  }
}

//------------------------------------------------------------------------------
void FilterHiding(const LevelRow rows[Taps], int count, float* values, unsigned char* hidden)
{
  for (int x = 0; x < count; ++x)
  {
    Neighbourhood near;
    for (int i = 0; i < Taps; ++i)
    {
      if (rows[i].Values)
      {
        near.Add(i - Reach, rows[i].Values[x], rows[i].Hidden && rows[i].Hidden[x]);
      }
    }
    bool isHidden = false;
    values[x] = near.Filter(isHidden);
    hidden[x] = isHidden;
  }
}

//------------------------------------------------------------------------------
// Returns the row at the full reach below (-1) or above (1), which `mirrored` may have to hold.
const float* FarRow(const LevelRow rows[Taps], int side, int count, std::vector<float>& mirrored)
{
  const LevelRow* const middle = rows + Reach;
  if (middle[Reach * side].Values)
  {
    return middle[Reach * side].Values;
  }
  const int at = middle[2 * side].Values ? 2 * side : side;
  const float* const border = middle[at].Values;
  const float* const inside = middle[2 * at - Reach * side].Values;
  mirrored.resize(count);
  std::transform(border, border + count, inside, mirrored.begin(), Mirror);
  return mirrored.data();
}
}

//------------------------------------------------------------------------------
void HalvingFilter::FilterAcross(
  const LevelRow rows[Taps], int count, float* values, unsigned char* hidden)
{
  const LevelRow* const middle = rows + Reach;
  if (std::any_of(rows, rows + Taps, [](const LevelRow& row) { return row.Hidden; }))
  {
    FilterHiding(rows, count, values, hidden);
    return;
  }
  if (hidden)
  {
    std::fill_n(hidden, count, static_cast<unsigned char>(0));
  }
  if (!middle[-1].Values || !middle[1].Values)
  {
    std::copy_n((middle[0].Values ? middle : middle - 1)->Values, count, values);
    return;
  }
  thread_local std::vector<float> mirrored[2];
  const float* const before3 = FarRow(rows, -1, count, mirrored[0]);
  const float* const after3 = FarRow(rows, 1, count, mirrored[1]);
  const float* const before = middle[-1].Values;
  const float* const at = middle[0].Values;
  const float* const after = middle[1].Values;
  for (int x = 0; x < count; ++x)
  {
    values[x] = HalfBand(before3[x], before[x], at[x], after[x], after3[x]);
  }
}

//------------------------------------------------------------------------------
void HalvingFilter::FilterAlong(
  const LevelRow& row, int count, float* values, unsigned char* hidden)
{
  const int coarse = HalvedCount(count);
  // the coarse samples whose neighbourhoods lie within the row
  const int first = row.Hidden ? coarse : std::min((Reach + 1) / 2, coarse);
  const int last = row.Hidden ? coarse : std::max((count - 1 - Reach) / 2 + 1, first);
  for (int i = 0; i < first; ++i)
  {
    FilterAt(row, count, i, values, hidden);
  }
  for (int i = first; i < last; ++i)
  {
    const float* const at = row.Values + 2 * i;
    values[i] = HalfBand(at[-3], at[-1], at[0], at[1], at[3]);
  }
  if (hidden)
  {
    std::fill(hidden + first, hidden + last, static_cast<unsigned char>(0));
  }
  for (int i = last; i < coarse; ++i)
  {
    FilterAt(row, count, i, values, hidden);
  }
}
