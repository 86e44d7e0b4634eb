// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Measures wall-clock time.
#ifndef Stopwatch_h
#define Stopwatch_h

#include <chrono>

class Stopwatch
{
public:
  /// Milliseconds since it was made.
  double GetMilliseconds() const
  {
    return std::chrono::duration<double, std::milli>(Clock::now() - this->Start).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
};

#endif
