// The two-level macrocell grid (section 3.1): ZFP's blocks of 4^3 voxels, and macrocells of 4^3 blocks.

ivec3 BlockCoordinates(uint block)
{
  uint slice = uint(volume.Blocks.x) * uint(volume.Blocks.y);
  uint inSlice = block % slice;
  return ivec3(inSlice % uint(volume.Blocks.x), inSlice / uint(volume.Blocks.x), block / slice);
}

uint BlockIndex(ivec3 b)
{
  return uint(b.x) + uint(volume.Blocks.x) * (uint(b.y) + uint(volume.Blocks.y) * uint(b.z));
}

bool InGrid(ivec3 b)
{
  return all(greaterThanEqual(b, ivec3(0))) && all(lessThan(b, volume.Blocks));
}

uint MacrocellIndex(ivec3 c)
{
  return uint(c.x) + uint(volume.Macrocells.x) * (uint(c.y) + uint(volume.Macrocells.y) * uint(c.z));
}

// Number of a block within its macrocell.
uint LocalIndex(ivec3 block)
{
  uvec3 local = uvec3(block) & 3u;
  return local.x + 4u * local.y + 16u * local.z;
}

// Blocks that have room decoded: in the cache, or all of them.
uint NumberOfSlots()
{
#ifdef HAS_CACHE_MAP
  return cache.Slots;
#else
  return volume.NumberOfBlocks;
#endif
}

// A block's range is kept in 8 + 8 bits, as steps within its macrocell's range, rounded outwards.
float RangeLow(vec2 coarse, uint q)
{
  precise float low = coarse.x + float(q) * (coarse.y / 255.0 - coarse.x / 255.0);
  return q == 0u ? coarse.x : low;
}

float RangeHigh(vec2 coarse, uint q)
{
  precise float high = coarse.x + float(q) * (coarse.y / 255.0 - coarse.x / 255.0);
  return q == 255u ? coarse.y : high;
}
