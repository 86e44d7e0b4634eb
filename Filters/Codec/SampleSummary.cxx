// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SampleSummary.h"

#include <algorithm>
#include <cmath>

//------------------------------------------------------------------------------
void SampleSummary::Add(float value)
{
  if (std::isfinite(value))
  {
    this->Minimum = std::min(this->Minimum, value);
    this->Maximum = std::max(this->Maximum, value);
  }
  else if (std::isnan(value))
  {
    ++this->NaNs;
  }
  else
  {
    ++this->Infinities;
  }
}

//------------------------------------------------------------------------------
// Adds four samples at a time, because for many samples this is all the work beside zfp's own.
void SampleSummary::AddBlock(const float samples[BlockSamples])
{
  float low[4], high[4], notFinite[4]; // the latter 0, or NaN if any sample was not finite
  for (int lane = 0; lane < 4; ++lane)
  {
    low[lane] = high[lane] = samples[lane];
    notFinite[lane] = 0.0f * samples[lane];
  }
  for (int i = 4; i < BlockSamples; i += 4)
  {
    for (int lane = 0; lane < 4; ++lane)
    {
      const float value = samples[i + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
      notFinite[lane] += 0.0f * value;
    }
  }
  if (notFinite[0] + notFinite[1] + notFinite[2] + notFinite[3] == 0.0f)
  {
    this->Minimum = std::min(this->Minimum, *std::min_element(low, low + 4));
    this->Maximum = std::max(this->Maximum, *std::max_element(high, high + 4));
    return;
  }
  for (int i = 0; i < BlockSamples; ++i)
  {
    this->Add(samples[i]);
  }
}

//------------------------------------------------------------------------------
void SampleSummary::Add(const SampleSummary& other)
{
  this->Minimum = std::min(this->Minimum, other.Minimum);
  this->Maximum = std::max(this->Maximum, other.Maximum);
  this->NaNs += other.NaNs;
  this->Infinities += other.Infinities;
  this->TinyBlocks += other.TinyBlocks;
  this->AddError(other.LargestError, other.ErrorSum, other.ErrorCount);
}

//------------------------------------------------------------------------------
void SampleSummary::AddError(double largest, double sum, vtkTypeInt64 count)
{
  this->LargestError = std::max(this->LargestError, largest);
  this->ErrorSum += sum;
  this->ErrorCount += count;
}

//------------------------------------------------------------------------------
double SampleSummary::GetMeanError() const
{
  const double mean = this->ErrorCount > 0 ? this->ErrorSum / this->ErrorCount : 0.0;
  if (!(mean > 0.0) || !std::isfinite(mean))
  {
    return mean;
  }
  int exponent = 0;
  const double fraction = std::frexp(mean, &exponent);
  const double steps = 4096.0;
  return std::ldexp(std::round(fraction * steps) / steps, exponent);
}

//------------------------------------------------------------------------------
SampleSummary SampleSummary::BeginWithCounts() const
{
  SampleSummary summary = *this;
  summary.LargestError = summary.ErrorSum = 0.0;
  summary.ErrorCount = 0;
  return summary;
}

//------------------------------------------------------------------------------
void SampleSummary::SubtractCounts(const SampleSummary& other)
{
  this->NaNs -= other.NaNs;
  this->Infinities -= other.Infinities;
  this->TinyBlocks -= other.TinyBlocks;
}

//------------------------------------------------------------------------------
std::array<double, 2> SampleSummary::GetRange() const
{
  const bool any = this->Minimum <= this->Maximum;
  return { { any ? this->Minimum : 0.0, any ? this->Maximum : 0.0 } };
}

//------------------------------------------------------------------------------
float SampleSummary::GetMagnitude() const
{
  return std::max(std::abs(this->Minimum), std::abs(this->Maximum));
}

//------------------------------------------------------------------------------
bool SampleSummary::ShowsTinyBlocks() const
{
  return this->IsFinite() && this->TinyBlocks > 0 && this->GetMagnitude() < SafeMagnitude;
}

//------------------------------------------------------------------------------
Status SampleSummary::CheckValues() const
{
  if (!this->IsFinite())
  {
    return Status::Error(this->NaNs, " NaN and ", this->Infinities,
      " infinite values (as float32), which ZFP cannot compress: replace them, or have them hidden "
      "again: Mask NaN on (MaskNonFiniteOn; in Python mask_nan=True, in commands --mask-nan).");
  }
  if (this->ShowsTinyBlocks())
  {
    return Status::Error("values too small for ZFP: the largest is ", this->GetMagnitude(),
      ", and all are below 3.16e-30 in ", this->TinyBlocks,
      " blocks of 4x4x4. Scale them up first.");
  }
  return {};
}
