// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What a scene needs of the GPU: it decides which buffers and stages there are, and how large.
#ifndef SceneNeeds_h
#define SceneNeeds_h

#include <cstdint>

/// Numbers that the sizes of buffers follow from.
struct BufferSizes
{
  std::int64_t Macrocells = 0;
  std::int64_t Pixels = 0;           ///< that there is room for: an image may have fewer
  std::int64_t Blocks = 0;           ///< of the volume
  std::int64_t Slots = 0;            ///< blocks that the cache holds, or all blocks of the volume
  std::int64_t MapPages = 0;         ///< of the block map; 0 without a cache
  std::int64_t HiddenWords = 0;      ///< that tell which cells are hidden
  std::int64_t HiddenColorWords = 0; ///< and which samples of the colours
  ///@{ Slots and map pages that the cache's buffers have addresses for, where these are reserved
  /// and
  /// memory is committed as the cache grows, in multiples of so many bytes. 0: no more than it has.
  std::int64_t SlotCapacity = 0;
  std::int64_t MapPageCapacity = 0;
  std::int64_t CommitBytes = 1;
  ///@}
};

/// What the scene has. Each combination has its own variants of the stages.
struct SceneFeatures
{
  bool Cached = true;    ///< false: the whole volume is decoded, once
  bool Lit = false;      ///< hits need normals
  bool Detailed = false; ///< distinct blocks are counted
  bool SeveralIsovalues = false;
  bool Translucent = false;  ///< rays go on behind a hit
  bool Obstructed = false;   ///< by opaque geometry, where translucent rays end
  bool Clipped = false;      ///< by planes
  bool Cropped = false;      ///< to regions
  bool Colored = false;      ///< another volume gives the colours
  bool HiddenCells = false;  ///< some cells have no surface
  bool HiddenColors = false; ///< and some samples no colour
  bool Categories = false;   ///< colours are those of the nearest sample
  bool StoredRanges = false; ///< the ranges of blocks come with the volume
  bool Levels = false;       ///< of detail: there are coarser ones
  bool Conservative = false; ///< where these show nothing that the volume may have, it is looked at

  /// The features, a bit each.
  std::uint32_t GetBits() const
  {
    return this->Cached | this->Lit << 1 | this->Detailed << 2 | this->SeveralIsovalues << 3 |
      this->Translucent << 4 | this->Obstructed << 5 | this->Clipped << 6 | this->Cropped << 7 |
      this->Colored << 8 | this->HiddenCells << 9 | this->HiddenColors << 10 |
      this->Categories << 11 | this->StoredRanges << 12 | this->Levels << 13 |
      this->Conservative << 14;
  }
  /// Do rays begin and end in one pass?
  bool IsSinglePass() const { return !this->Cached && !this->Translucent; }
};

struct SceneNeeds
  : BufferSizes
  , SceneFeatures
{
};

#endif
