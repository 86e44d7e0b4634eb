// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A slice of a level's samples, in the stream's units (internal).
#ifndef LevelSlice_h
#define LevelSlice_h

#include <algorithm>
#include <vector>

struct LevelSlice
{
  std::vector<float> Values; ///< x fastest; undefined where hidden

  ///@{
  /// Not 0 where a sample, or the cell between it and the next ones along x, y and z, is hidden;
  /// empty if none is. There are as many cells along x and y as samples: the last ones are none.
  std::vector<unsigned char> Hidden;
  std::vector<unsigned char> HiddenCells;
  ///@}
};

/// Empties flags that hide nothing, so that nobody looks at them.
inline void ClearUnlessAny(std::vector<unsigned char>& flags)
{
  if (std::all_of(flags.begin(), flags.end(), [](unsigned char flag) { return flag == 0; }))
  {
    flags = std::vector<unsigned char>();
  }
}

/// Some samples in a row, or nothing.
struct LevelRow
{
  const float* Values = nullptr;
  const unsigned char* Hidden = nullptr; ///< null if none is
};

#endif
