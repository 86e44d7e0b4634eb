// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Foretells an image's passes from the last image's: how many there will be, and how long each
// takes. The GPU is given some before the CPU knows whether they are needed, so that it never
// waits for the CPU.
#ifndef PassForecast_h
#define PassForecast_h

#include <cstdint>

class PassForecast
{
public:
  /// How many passes of an image may have been submitted when so many are known: some more, but not
  /// beyond the number that the last image took, and no more than fit into so many milliseconds.
  /// One more at least.
  std::int64_t PassesToSubmit(std::int64_t known, double millisecondsLeft) const;

  /// Records how long it took until the next so many passes were known.
  void RecordTime(std::int64_t passes, double milliseconds);
  /// Records how many passes a complete image took.
  void RecordImage(std::int64_t passes) { this->Passes = passes; }

private:
  std::int64_t Passes = 0;   ///< of the last image; 0: there was none
  double Milliseconds = 0.0; ///< of a pass; 0: not known
};

#endif
