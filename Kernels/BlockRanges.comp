// Macrocell grid construction (section 3.1), once a volume: a work group decodes the blocks of a coarse
// cell and those its dual grids reach into, and keeps the exact value range of every block's 5^3 dual
// grid, quantised outwards to 8 + 8 bits within the range of the coarse cell.
// In: Payload. Out: BlockRanges, CoarseRanges.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockStore.glsl"
#include "ZFPDecode.glsl"

layout(local_size_x = 32) in;

#define GRID 17 // samples of a coarse cell's dual grid on an axis

shared float samples[GRID * GRID * GRID];
shared vec2 localRanges[64];

// Decodes 5^3 blocks from the coarse cell's first one on, 32 at a time, into `samples`.
void LoadSamples(ivec3 firstBlock)
{
  uint lane = gl_LocalInvocationIndex;
  for (uint batch = 0u; batch < 125u; batch += ZFP_LANES)
  {
    uint i = batch + lane;
    ivec3 local = ivec3(i % 5u, (i / 5u) % 5u, i / 25u);
    ivec3 block = firstBlock + local;
    if (i < 125u && all(lessThan(block, scene.Blocks.xyz)))
    {
      DecodeBlock(BlockIndex(block), lane);
      ivec3 count = min(ivec3(4), ivec3(GRID) - 4 * local);
      for (int z = 0; z < count.z; ++z)
      {
        for (int y = 0; y < count.y; ++y)
        {
          for (int x = 0; x < count.x; ++x)
          {
            ivec3 at = 4 * local + ivec3(x, y, z);
            samples[at.x + GRID * (at.y + GRID * at.z)] =
              uintBitsToFloat(zfpColumns[ColumnIndex(uint(x + 4 * y + 16 * z), lane)]);
          }
        }
      }
    }
    barrier();
  }
}

// Range of a block's dual grid; empty (low > high) where the block has no cells.
vec2 DualGridRange(ivec3 firstBlock, ivec3 local)
{
  vec2 range = vec2(uintBitsToFloat(0x7F800000u), -uintBitsToFloat(0x7F800000u));
  ivec3 first = 4 * (firstBlock + local);
  ivec3 last = min(first + 4, scene.Samples.xyz - 1);
  if (any(greaterThanEqual(first, last)))
  {
    return range;
  }
  ivec3 count = last - first + 1;
  for (int z = 0; z < count.z; ++z)
  {
    for (int y = 0; y < count.y; ++y)
    {
      for (int x = 0; x < count.x; ++x)
      {
        ivec3 at = 4 * local + ivec3(x, y, z);
        float value = samples[at.x + GRID * (at.y + GRID * at.z)];
        range = vec2(min(range.x, value), max(range.y, value));
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
  if (unit > 0.0)
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
  blockRanges[cell * 32u + lane] =
    Quantize(localRanges[2u * lane], coarse) | (Quantize(localRanges[2u * lane + 1u], coarse) << 16);
  if (lane == 0u)
  {
    coarseRanges[cell] = coarse;
  }
}

void main()
{
  uint lane = gl_LocalInvocationIndex;
  uint cells = uint(scene.CoarseCells.w);
  for (uint cell = gl_WorkGroupID.x; cell < cells; cell += gl_NumWorkGroups.x)
  {
    ivec3 coarse = ivec3(cell % uint(scene.CoarseCells.x),
      (cell / uint(scene.CoarseCells.x)) % uint(scene.CoarseCells.y),
      cell / (uint(scene.CoarseCells.x) * uint(scene.CoarseCells.y)));
    LoadSamples(4 * coarse);
    for (uint i = lane; i < 64u; i += 32u)
    {
      localRanges[i] = DualGridRange(4 * coarse, ivec3(i & 3u, (i >> 2) & 3u, i >> 4));
    }
    barrier();
    StoreRanges(cell);
    barrier();
  }
}
