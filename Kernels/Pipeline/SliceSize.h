// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Decides how much of the work on a whole volume a dispatch does. Drivers reset a GPU that one
// dispatch keeps busy for seconds, and the desktop waits for it, too. The first slice is small; the
// next ones are as large as the time of the last one allows.
#ifndef SliceSize_h
#define SliceSize_h

#include <cstdint>

class SliceSize
{
public:
  /// Longer than this no slice is meant to take. It may take twice as long.
  static constexpr double Milliseconds = 25.0;

  explicit SliceSize(std::int64_t first)
    : Items(first)
  {
  }

  std::int64_t Get() const { return this->Items; }
  /// Records how long so many items took. Much less than a slice says little.
  void Record(std::int64_t items, double milliseconds);

private:
  std::int64_t Items;
};

#endif
