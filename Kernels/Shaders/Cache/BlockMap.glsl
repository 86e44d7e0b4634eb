// Where a block's values are (sections 3.4 and 3.5). With a cache: the slots stand on map pages, one for every
// macrocell that has blocks in it. Without, the whole volume is decoded and a block's slot is its number.

// Statistics of this invocation.
uint touchedSlots = 0u;
uint visibleBlocks = 0u;
uint activeBlocks = 0u;

ivec3 SideOffset(int i)
{
  return ivec3(i) >> ivec3(0, 1, 2) & 1;
}

uint SlotOf(ivec3 block)
{
#ifdef HAS_CACHE_MAP
  uint page = macrocells[MacrocellIndex(block >> 2)].Page;
  return page >= CLAIMED ? NONE : mapPages[page].Slots[LocalIndex(block)];
#else
  return BlockIndex(block);
#endif
}

#ifdef HAS_CACHE_MAP
// Slots of a block and those beside it, x fastest, in the lower and the upper layer. No stage indexes them: what is
// indexed by a variable does not stay in registers.
uvec4 lowSlots, highSlots;

uint SlotBeside(ivec3 first, ivec3 reach, ivec3 side)
{
  return all(lessThanEqual(side, reach)) ? SlotOf(first + side) : 0u;
}

// Finds the slots of the blocks from `first` to first + reach, a component 0 or 1; returns those that are missing, a
// bit each.
uint FindSlots(ivec3 first, ivec3 reach)
{
  lowSlots.x = SlotBeside(first, reach, ivec3(0, 0, 0));
  lowSlots.y = SlotBeside(first, reach, ivec3(1, 0, 0));
  lowSlots.z = SlotBeside(first, reach, ivec3(0, 1, 0));
  lowSlots.w = SlotBeside(first, reach, ivec3(1, 1, 0));
  highSlots.x = SlotBeside(first, reach, ivec3(0, 0, 1));
  highSlots.y = SlotBeside(first, reach, ivec3(1, 0, 1));
  highSlots.z = SlotBeside(first, reach, ivec3(0, 1, 1));
  highSlots.w = SlotBeside(first, reach, ivec3(1, 1, 1));
  uvec4 low = uvec4(equal(lowSlots, uvec4(NONE))) << uvec4(0u, 1u, 2u, 3u);
  uvec4 high = uvec4(equal(highSlots, uvec4(NONE))) << uvec4(4u, 5u, 6u, 7u);
  return low.x | low.y | low.z | low.w | high.x | high.y | high.z | high.w;
}

// Of those found last.
uint SlotAt(bvec3 side)
{
  uvec4 layer = side.z ? highSlots : lowSlots;
  uvec2 row = side.y ? layer.zw : layer.xy;
  return side.x ? row.y : row.x;
}
#else
uint FindSlots(ivec3 first, ivec3 reach)
{
  return 0u;
}
#endif

// What planes of samples on x, y and z add to the index of a sample: within its block, or where the whole volume is
// decoded, altogether.
const uvec3 WITHIN = uvec3(1u, 4u, 16u);

uvec3 BlockOffsets()
{
#ifdef HAS_CACHE_MAP
  return uvec3(0u);
#else
  return 64u * uvec3(1, volume.Blocks.x, volume.Blocks.x * volume.Blocks.y);
#endif
}

uvec3 SampleOffsets(ivec3 planes)
{
  return (uvec3(planes) & 3u) * WITHIN + uvec3(planes >> 2) * BlockOffsets();
}

// From those of planes to those of the next ones.
uvec3 NextOffsets(ivec3 planes, uvec3 offsets)
{
  return offsets + WITHIN + uvec3(equal(planes & 3, ivec3(3))) * (BlockOffsets() - 4u * WITHIN);
}

#ifdef BUFFER_CACHE_SEEN
void CountBlocks(ivec3 first, ivec3 reach)
{
  if (atomicExchange(cacheSeen[2u * SlotOf(first)], control.PassSerial) != control.PassSerial)
  {
    ++visibleBlocks;
  }
  for (int i = 0; i < 8; ++i)
  {
    ivec3 side = SideOffset(i);
    if (all(lessThanEqual(side, reach)) &&
      atomicExchange(cacheSeen[2u * SlotOf(first + side) + 1u], control.PassSerial) != control.PassSerial)
    {
      ++activeBlocks;
    }
  }
}
#endif

#ifdef WRITES_CACHE_MAP
// The least recently used pages are the first to be evicted.
void UsePage(ivec3 coarse)
{
  uint page = macrocells[MacrocellIndex(coarse)].Page;
  if (mapPages[page].Stamp != control.PassSerial)
  {
    uint before = atomicExchange(mapPages[page].Stamp, control.PassSerial);
    touchedSlots += before < control.ImageSerial ? mapPages[page].Used : 0u;
  }
}
#endif

#if defined(WRITES_CACHE_MAP) || !defined(HAS_CACHE_MAP)
// The blocks found last are about to be used.
void UseBlocks(ivec3 first, ivec3 reach)
{
#ifdef BUFFER_CACHE_SEEN
  CountBlocks(first, reach);
#endif
#ifdef HAS_CACHE_MAP
  ivec3 across = ((first + reach) >> 2) - (first >> 2);
  UsePage(first >> 2);
  for (int i = 1; i < 8 && across != ivec3(0); ++i)
  {
    if (all(lessThanEqual(SideOffset(i), across)))
    {
      UsePage((first >> 2) + SideOffset(i));
    }
  }
#endif
}
#endif
