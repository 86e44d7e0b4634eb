// Macrocell grid construction (section 3.1), once a volume: a work group takes the blocks of a macrocell and those
// that its dual grids reach into, decodes them unless the whole volume is decoded already, and keeps the exact value
// range of every block's 5^3 dual grid, quantised outwards to 8 + 8 bits within the range of the macrocell. Samples of
// hidden cells alone do not count.
// In: Stream or CacheValues, HiddenCells. Out: Macrocells.

#define CACHE_BY_ROWS

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Shared/Grid.glsl"
#ifdef BUFFER_STREAM
#include "Store/BlockStore.glsl"
#include "Store/ZFPDecode.glsl"
#endif
#ifdef HAS_HIDDEN_CELLS
#include "Store/HiddenCells.glsl"
#endif

#define GRID 17 // samples of a macrocell's dual grids on an axis

shared float samples[GRID * GRID * GRID];
shared vec2 localRanges[64];

// Keeps those samples of row y + 4 z of a block that the macrocell's dual grids reach.
void KeepRow(ivec3 local, int row, uvec4 bits)
{
  ivec3 at = 4 * local + ivec3(0, row & 3, row >> 2);
  if (at.y < GRID && at.z < GRID)
  {
    vec4 values = uintBitsToFloat(bits);
    uint first = at.x + GRID * (at.y + GRID * at.z);
    samples[first] = values.x;
    if (at.x + 3 < GRID)
    {
      samples[first + 1u] = values.y;
      samples[first + 2u] = values.z;
      samples[first + 3u] = values.w;
    }
  }
}

void LoadBlock(ivec3 local, uint block)
{
#ifdef BUFFER_STREAM
  DecodedBlock decoded = DecodeBlock(block, gl_LocalInvocationIndex);
#define KEEP_ROW(r) KeepRow(local, r, decoded.Row[r]);
  FOR_ROWS(KEEP_ROW)
#else
  for (int row = 0; row < 16; ++row)
  {
    KeepRow(local, row, cacheRows[16u * block + uint(row)]);
  }
#endif
}

// Loads the samples of 5^3 blocks from the macrocell's first one on, a block a lane.
void LoadSamples(ivec3 firstBlock)
{
  for (uint i = gl_LocalInvocationIndex; i < 125u; i += GROUP_SIZE)
  {
    ivec3 local = ivec3(i % 5u, (i / 5u) % 5u, i / 25u);
    ivec3 block = firstBlock + local;
    if (all(lessThan(block, volume.Blocks)))
    {
      LoadBlock(local, BlockIndex(block));
    }
  }
  barrier();
}

void Extend(inout vec2 range, ivec3 at)
{
  float value = samples[at.x + GRID * (at.y + GRID * at.z)];
  range = vec2(min(range.x, value), max(range.y, value));
}

#ifdef HAS_HIDDEN_CELLS
// Where some of a block's cells are hidden: of the corners of the others, of `count` cells per axis.
vec2 VisibleRange(vec2 range, uvec2 hidden, ivec3 local, ivec3 count)
{
  for (int i = 0; i < 64; ++i)
  {
    ivec3 cell = ivec3(i, i >> 2, i >> 4) & 3;
    if (all(lessThan(cell, count)) && !Hides(hidden, cell))
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        Extend(range, 4 * local + cell + (ivec3(corner, corner >> 1, corner >> 2) & 1));
      }
    }
  }
  return range;
}
#endif

// Range of a block's dual grid; empty (low > high) where the block has no cells.
vec2 DualGridRange(ivec3 firstBlock, ivec3 local)
{
  vec2 range = vec2(uintBitsToFloat(0x7F800000u), -uintBitsToFloat(0x7F800000u));
  ivec3 first = 4 * (firstBlock + local);
  ivec3 last = min(first + 4, volume.Samples - 1);
  if (any(greaterThanEqual(first, last)))
  {
    return range;
  }
#ifdef HAS_HIDDEN_CELLS
  uvec2 hidden = FindHiddenCells(BlockIndex(firstBlock + local));
  if (hidden != uvec2(0u))
  {
    return VisibleRange(range, hidden, local, last - first);
  }
#endif
  ivec3 count = last - first + 1;
  for (int z = 0; z < count.z; ++z)
  {
    for (int y = 0; y < count.y; ++y)
    {
      for (int x = 0; x < count.x; ++x)
      {
        Extend(range, 4 * local + ivec3(x, y, z));
      }
    }
  }
  return range;
}

// The range as two 8-bit steps of the coarse range, rounded outwards; empty ranges as 255, 0.
uint Quantize(vec2 range, vec2 coarse)
{
  if (range.x > range.y)
  {
    return 255u;
  }
  float unit = coarse.y / 255.0 - coarse.x / 255.0;
  uint low = 0u;
  uint high = 255u;
  if (unit > 0.0 && !isinf(unit)) // a damaged stream may have infinite values
  {
    low = uint(clamp((range.x / unit - coarse.x / unit), 0.0, 255.0));
    high = min(uint(clamp(ceil(range.y / unit - coarse.x / unit), 0.0, 255.0)), 255u);
  }
  while (low > 0u && RangeLow(coarse, low) > range.x)
  {
    --low;
  }
  while (high < 255u && RangeHigh(coarse, high) < range.y)
  {
    ++high;
  }
  return low | (high << 8);
}

void StoreRanges(uint cell)
{
  uint lane = gl_LocalInvocationIndex;
  vec2 coarse = localRanges[0];
  for (uint i = 1u; i < 64u; ++i)
  {
    coarse = vec2(min(coarse.x, localRanges[i].x), max(coarse.y, localRanges[i].y));
  }
  macrocells[cell].Ranges[lane] =
    Quantize(localRanges[2u * lane], coarse) | (Quantize(localRanges[2u * lane + 1u], coarse) << 16);
  if (lane == 0u)
  {
    macrocells[cell].Low = coarse.x;
    macrocells[cell].High = coarse.y;
  }
}

uvec2 MacrocellsOfDispatch()
{
#ifdef BUFFER_STREAM
  return uvec2(segment[4], segment[4] + segment[5]);
#else
  return uvec2(0u, volume.NumberOfMacrocells);
#endif
}

void main()
{
  uint lane = gl_LocalInvocationIndex;
  uvec2 cells = MacrocellsOfDispatch();
  for (uint cell = cells.x + FoldedGroup(); cell < cells.y; cell += gl_NumWorkGroups.x * gl_NumWorkGroups.y)
  {
    ivec3 coarse = ivec3(cell % uint(volume.Macrocells.x),
      (cell / uint(volume.Macrocells.x)) % uint(volume.Macrocells.y),
      cell / (uint(volume.Macrocells.x) * uint(volume.Macrocells.y)));
    LoadSamples(4 * coarse);
    for (uint i = lane; i < 64u; i += GROUP_SIZE)
    {
      localRanges[i] = DualGridRange(4 * coarse, ivec3(i & 3u, (i >> 2) & 3u, i >> 4));
    }
    barrier();
    StoreRanges(cell);
    barrier();
  }
}
