// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SampleSummary
 * @brief   range and defects of the samples of some blocks, in the stream's units (internal)
 */
#ifndef SampleSummary_h
#define SampleSummary_h

#include "Codec/BlockGeometry.h"
#include "Status.h"

#include "vtkType.h"

#include <array>
#include <limits>

struct SampleSummary
{
  /// zfp's encoder overflows in blocks whose values are all smaller: it scales by 2^(30-exponent)
  /// in float32.
  static constexpr float TinyMagnitude = 3.1554436e-30f; // 2^-98

  /// Beside a value that is 2^24 times larger, float32 may not tell a tiny value from zero.
  static constexpr float SafeMagnitude = TinyMagnitude * 16777216.0f; // 2^-74

  float Minimum = std::numeric_limits<float>::infinity();
  float Maximum = -std::numeric_limits<float>::infinity();
  vtkTypeInt64 NaNs = 0;
  vtkTypeInt64 Infinities = 0;
  vtkTypeInt64 TinyBlocks = 0; ///< encoded as zero, see SampleEncoder
  double LargestError = 0.0;   ///< of encoding, in the samples' own units
  double ErrorSum = 0.0;
  vtkTypeInt64 ErrorCount = 0; ///< samples in the sum

  /// Returns minimum and maximum, or zeros if no finite sample was added.
  std::array<double, 2> GetRange() const;

  /// Returns the largest absolute value.
  float GetMagnitude() const;

  bool IsFinite() const { return this->NaNs == 0 && this->Infinities == 0; }

  /// Whether it shows, beside the largest value, that blocks were encoded as zero.
  bool ShowsTinyBlocks() const;

  void Add(float value);
  void AddBlock(const float samples[BlockSamples]);
  void Add(const SampleSummary& other);

  /// Adds what encoding did to some samples.
  void AddError(double largest, double sum, vtkTypeInt64 count);

  /// Returns the mean error, to three digits: sums depend on the order of threads.
  double GetMeanError() const;

  /// Returns a summary that begins with this one's counts, without its errors.
  SampleSummary BeginWithCounts() const;

  /// Takes back another summary's counts, which this one began with.
  void SubtractCounts(const SampleSummary& other);

  /// Says what zfp cannot represent among the values. The message is the end of a sentence that
  /// begins with "NAME has ".
  Status CheckValues() const;
};

#endif
