// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The range of a block's values in 8 + 8 bits, as the shader BlockRanges.comp finds it, bit for bit
// (internal). Samples are compared as integers, so that signs of zero and subnormal numbers count
// alike on every GPU.
#ifndef RangeSteps_h
#define RangeSteps_h

#include "vtkType.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace RangeSteps
{
/// An integer in the order of floats; ValueOf() takes it back.
inline vtkTypeInt32 KeyOf(float value)
{
  vtkTypeInt32 bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits ^ (bits >> 31 & 0x7FFFFFFF);
}

inline float ValueOf(vtkTypeInt32 key)
{
  const vtkTypeInt32 bits = key ^ (key >> 31 & 0x7FFFFFFF);
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

constexpr vtkTypeInt32 KeyOfInfinity = 0x7F800000;

/// A range of values by their keys, empty at first.
struct KeyRange
{
  vtkTypeInt32 Low = KeyOfInfinity;
  vtkTypeInt32 High = -KeyOfInfinity - 1; // of minus infinity

  bool IsEmpty() const { return this->Low > this->High; }
  void Add(vtkTypeInt32 key) { this->Add(KeyRange{ key, key }); }
  void Add(const KeyRange& other)
  {
    this->Low = std::min(this->Low, other.Low);
    this->High = std::max(this->High, other.High);
  }
};

/// The steps of a block without values: its lowest is above its highest.
constexpr vtkTypeUInt16 NoSteps = 255;

/// The steps of a block that has all of its macrocell's range.
constexpr vtkTypeUInt16 AllSteps = 255 << 8;

/// Returns the narrowest steps within a macrocell's range that hold a block's: the lowest, from 0
/// to 255, and 256 times the highest.
vtkTypeUInt16 Find(const KeyRange& block, const KeyRange& macrocell);

///@{
/// Returns the value of a step: as the lowest of a range, or as the highest.
float LowOf(float low, float high, int steps);
float HighOf(float low, float high, int steps);
///@}
}

#endif
