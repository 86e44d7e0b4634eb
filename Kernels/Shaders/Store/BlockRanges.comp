// Builds the macrocell grid, once for a volume, from decoded blocks: a box of them, which is all of
// the volume where it is decoded whole. A work group takes the blocks of a macrocell and their
// neighbours, because a block's cells need 5^3 samples (its dual grid). It stores the range of
// values of each block's cells in 8 + 8 bits: steps within the macrocell's exact range, rounded
// outwards. Samples of hidden cells do not count. What compression stores of the same blocks
// (RangeSteps.cxx, BlockRangeFinder.cxx) has the same bits, whatever the GPU does with subnormal
// numbers and signs of zero: samples are compared as integers, in the order of floats.

// Its loops are too short to be worth the seconds that NVIDIA's compiler takes to unroll them.
#pragma optionNV(unroll none)

#define CACHE_BY_ROWS

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Store/BlockBox.glsl"
#include "Store/HiddenCells.glsl"
#include "Store/VolumeSlice.glsl"

const int GRID = BLOCK_SIDE * MACROCELL_SIDE + 1; // samples of a macrocell's cells on an axis
const uint LOADED_SIDE = uint(MACROCELL_SIDE) + 1u; // blocks on an axis that hold them

// Keys of infinity and minus infinity: no sample is beyond.
const int KEY_OF_INFINITY = 0x7F800000;
const ivec2 EMPTY_RANGE = ivec2(KEY_OF_INFINITY, -KEY_OF_INFINITY - 1);

// Steps are no shorter than this: the numbers between them are exact in floats that are not
// subnormal.
const uint LEAST_UNIT = (127u - 100u) << 23; // the float 2^-100

shared int samples[GRID * GRID * GRID]; // keys, and so are ranges
shared ivec2 localRanges[BLOCKS_PER_MACROCELL];

// Integers in the order of the floats with these bits; the same function takes them back.
ivec4 KeysOf(ivec4 bits)
{
  return bits ^ (bits >> 31 & 0x7FFFFFFF);
}

int KeyOf(float value)
{
  return KeysOf(ivec4(floatBitsToInt(value))).x;
}

float ValueOf(int key)
{
  return intBitsToFloat(KeysOf(ivec4(key)).x);
}

// Stores those samples of a block's row y + 4 z that the macrocell's cells need.
void StoreRow(ivec3 local, int row, uvec4 bits)
{
  ivec3 at = BLOCK_SIDE * local + ivec3(0, row % BLOCK_SIDE, row / BLOCK_SIDE);
  if (at.y < GRID && at.z < GRID)
  {
    ivec4 keys = KeysOf(ivec4(bits));
    uint first = at.x + GRID * (at.y + GRID * at.z);
    samples[first] = keys.x;
    if (at.x + 3 < GRID)
    {
      samples[first + 1u] = keys.y;
      samples[first + 2u] = keys.z;
      samples[first + 3u] = keys.w;
    }
  }
}

// Loads the macrocell's blocks and their neighbours, from its first one on. Lanes take rows, those
// of a block one after the other.
void LoadSamples(ivec3 firstBlock)
{
  const uint rows = uint(ROWS_PER_BLOCK);
  const uint count = LOADED_SIDE * LOADED_SIDE * LOADED_SIDE;
  for (uint i = gl_LocalInvocationIndex; i < count * rows; i += GROUP_SIZE)
  {
    uint n = i / rows;
    uint row = i % rows;
    uvec3 place = uvec3(n, n / LOADED_SIDE, n / (LOADED_SIDE * LOADED_SIDE)) % LOADED_SIDE;
    ivec3 local = ivec3(place);
    ivec3 block = firstBlock + local;
    if (all(lessThan(block, volume.Blocks)))
    {
      StoreRow(local, int(row), cacheRows[rows * PlaceInBox(block) + row]);
    }
  }
  barrier();
}

// Extends a range (low, high) by a sample.
void Extend(inout ivec2 range, ivec3 at)
{
  int key = samples[at.x + GRID * (at.y + GRID * at.z)];
  range = ivec2(min(range.x, key), max(range.y, key));
}

#ifdef HAS_HIDDEN_CELLS
// The range of the corners of a block's cells that are not hidden; it has `count` cells per axis.
ivec2 VisibleRange(ivec2 range, uvec2 hidden, ivec3 local, ivec3 count)
{
  for (int i = 0; i < SAMPLES_PER_BLOCK; ++i)
  {
    ivec3 cell = ivec3(i, i / BLOCK_SIDE, i / ROWS_PER_BLOCK) % BLOCK_SIDE;
    if (all(lessThan(cell, count)) && !HoldsCell(hidden, cell))
    {
      for (int corner = 0; corner < 8; ++corner)
      {
        ivec3 side = ivec3(corner, corner >> 1, corner >> 2) & 1;
        Extend(range, BLOCK_SIDE * local + cell + side);
      }
    }
  }
  return range;
}
#endif

// The range of a block's dual grid; empty (low > high) if the block has no visible cells.
ivec2 DualGridRange(ivec3 firstBlock, ivec3 local)
{
  ivec2 range = EMPTY_RANGE;
  ivec3 first = BLOCK_SIDE * (firstBlock + local);
  ivec3 last = min(first + BLOCK_SIDE, volume.Samples - 1);
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
        Extend(range, BLOCK_SIDE * local + ivec3(x, y, z));
      }
    }
  }
  return range;
}

// Encodes a range in 8 + 8 bits: the narrowest steps within the macrocell's range that hold it. An
// empty one becomes low 255, high 0.
uint Quantize(ivec2 range, vec2 whole)
{
  if (range.x > range.y)
  {
    return 255u;
  }
  float unit = RangeUnit(whole);
  uint low = 0u;
  uint high = 255u;
  if (unit >= uintBitsToFloat(LEAST_UNIT) && !isinf(unit)) // a damaged stream has infinite values
  {
    for (uint steps = 128u; steps > 0u; steps >>= 1)
    {
      low += KeyOf(RangeLow(whole, low + steps)) <= range.x ? steps : 0u;
      high -= KeyOf(RangeHigh(whole, high - steps)) >= range.y ? steps : 0u;
    }
  }
  return low | (high << 8);
}

// Each lane encodes two blocks, which share a word.
void StoreRanges(uint macrocell)
{
  uint lane = gl_LocalInvocationIndex;
  ivec2 keys = EMPTY_RANGE;
  for (uint i = 0u; i < uint(BLOCKS_PER_MACROCELL); ++i)
  {
    keys = ivec2(min(keys.x, localRanges[i].x), max(keys.y, localRanges[i].y));
  }
  vec2 whole = vec2(ValueOf(keys.x), ValueOf(keys.y));
  uint even = Quantize(localRanges[2u * lane], whole);
  uint odd = Quantize(localRanges[2u * lane + 1u], whole);
  macrocells[macrocell].Ranges[lane] = even | odd << 16;
  if (lane == 0u)
  {
    macrocells[macrocell].Low = whole.x;
    macrocells[macrocell].High = whole.y;
  }
}

void main()
{
  uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  for (uint macrocell = slice.x + FoldedGroup(); macrocell < slice.y; macrocell += stride)
  {
    ivec3 firstBlock = MACROCELL_SIDE * MacrocellCoordinates(macrocell);
    LoadSamples(firstBlock);
    for (int i = int(gl_LocalInvocationIndex); i < BLOCKS_PER_MACROCELL; i += int(GROUP_SIZE))
    {
      localRanges[i] = DualGridRange(firstBlock, BlockInMacrocell(uint(i)));
    }
    barrier();
    StoreRanges(macrocell);
    barrier();
  }
}
