// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The parallel loop over the rows of a level's slices (internal).
#ifndef SliceLoop_h
#define SliceLoop_h

#include "Codec/LevelSlice.h"

#include "vtkType.h"

#include <omp.h>

#include <vector>

/// Rows that a thread takes at a time: none waits long for another at the end.
constexpr int RowsPerTurn = 32;

/// Whether so many rows take longer than threads may wait for one another, when other programs keep
/// the cores busy.
inline bool IsWorthThreads(vtkTypeInt64 rows, int width)
{
  return rows * width > vtkTypeInt64(1) << 18;
}

/// Calls body(slice's number, y, values, flags or null) for all rows of some slices, in parallel.
template <typename Body>
void ForEachRow(int threads, std::vector<LevelSlice>& slices, int width, const Body& body)
{
  const std::size_t height = slices.empty() ? 0 : slices.front().Values.size() / width;
  const vtkTypeInt64 number = static_cast<vtkTypeInt64>(slices.size() * height);
#pragma omp parallel for num_threads(threads)                                                      \
  schedule(dynamic, RowsPerTurn) if (IsWorthThreads(number, width))
  for (vtkTypeInt64 row = 0; row < number; ++row)
  {
    LevelSlice& slice = slices[row / height];
    const std::size_t at = row % height * width;
    body(row / height, static_cast<int>(row % height), &slice.Values[at],
      slice.Hidden.empty() ? nullptr : &slice.Hidden[at]);
  }
}

#endif
