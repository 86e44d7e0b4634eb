// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a dispatch does of the work on a whole volume.
#ifndef VolumeSlice_h
#define VolumeSlice_h

#include <cstdint>

/// Macrocells or blocks: see VolumeSlice.glsl.
struct VolumeSlice
{
  std::int64_t First = 0;
  std::int64_t End = 0; ///< behind the last

  std::int64_t GetItems() const { return this->End - this->First; }
};

#endif
