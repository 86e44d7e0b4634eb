// The loop of both decoding stages, an invocation for each block: over the blocks that rays have
// requested, or a box of blocks whose ranges are to be found, or without a cache a slice of all.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/SlotLayout.glsl"
#include "Store/BlockStore.glsl"
#include "Store/HiddenCells.glsl"
#include "Store/ZFPDecode.glsl"

// The stage defines these: the slot of block number i; NONE if it gets none.
uint SlotFor(uint i, uint block);
// From which slot on it stores samples.
uint FirstSlot();

#ifdef HAS_CACHE_MAP
#include "Store/BlockBox.glsl"

bool FillsBox()
{
  return box.Size.x > 0;
}

uint NumberOfListedBlocks()
{
  return FillsBox() ? BlocksInBox() : min(control.Requests, cache.Slots);
}

uint ListedBlock(uint i)
{
  return FillsBox() ? BlockInBox(i) : cacheRequests[i];
}
#else
#include "Store/VolumeSlice.glsl"

bool FillsBox()
{
  return false;
}

uint NumberOfListedBlocks()
{
  return slice.y - slice.x;
}

uint ListedBlock(uint i)
{
  return slice.x + i;
}
#endif

#define FOR_ROWS(DO) DO(0) DO(1) DO(2) DO(3)

#ifdef BUFFER_HIDDEN_COLORS
const uint NOT_A_NUMBER = 0x7FC00000u;

// Four samples, of which those whose bits are set have no value.
uvec4 MarkRow(uvec4 row, uint bits)
{
  uvec4 hidden = uvec4(0u) - (uvec4(bits) >> uvec4(0u, 1u, 2u, 3u) & 1u); // all bits, or none
  return (row & ~hidden) | (NOT_A_NUMBER & hidden);
}

void MarkHidden(uint z, uvec2 hidden, inout DecodedSlice slice)
{
  uint bits = (z < 2u ? hidden.x : hidden.y) >> (16u * (z & 1u));
#define MARK_ROW(y) slice.Row[y] = MarkRow(slice.Row[y], bits >> (uint(BLOCK_SIDE) * uint(y)));
  FOR_ROWS(MARK_ROW)
}
#endif

// Decodes a block into a slot, which is one of all that this stage and others fill.
void DecodeInto(uint slot, uint block, uint lane)
{
  int exponent = DecodeBlock(block, lane);
#ifdef BUFFER_HIDDEN_COLORS
  uvec2 hidden = FindHiddenColors(block);
#endif
  for (uint z = 0u; z < uint(BLOCK_SIDE); ++z)
  {
    DecodedSlice slice = SamplesOfSlice(z, exponent, lane);
#ifdef BUFFER_HIDDEN_COLORS
    MarkHidden(z, hidden, slice);
#endif
    uint first = uint(ROWS_PER_BLOCK) * slot + uint(BLOCK_SIDE) * z;
#define STORE_ROW(y) cacheRows[first + uint(y)] = slice.Row[y];
    FOR_ROWS(STORE_ROW)
  }
}

void main()
{
  uint lane = gl_LocalInvocationIndex;
  uint number = NumberOfListedBlocks();
  uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * GROUP_SIZE;
  for (uint i = FoldedGroup() * GROUP_SIZE + lane; i < number; i += stride)
  {
    uint block = ListedBlock(i);
    if (FillsBox() || InSegment(block)) // a segment has the next one's first blocks, too
    {
      uint slot = SlotFor(i, block);
      if (slot != NONE)
      {
        DecodeInto(FirstSlot() + slot, block, lane);
#ifdef BUFFER_HIDDEN_CELLS
        cacheRows[HiddenRow(slot)] = uvec4(FindHiddenCells(block), 0u, 0u);
#endif
      }
    }
  }
}
