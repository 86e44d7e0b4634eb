// The loop of both decoding stages, an invocation for each block: over the blocks that rays have
// requested, or all of them without a cache. The stage defines SlotFor(i, block), NONE for a block
// that gets no slot, and FirstSlot(), where its slots begin in the buffer of values.

uint NumberOfBlocks()
{
#ifdef HAS_CACHE_MAP
  return min(control.Requests, cache.Slots);
#else
  return volume.NumberOfBlocks;
#endif
}

uint BlockAt(uint i)
{
#ifdef HAS_CACHE_MAP
  return cacheRequests[i];
#else
  return i;
#endif
}

#ifdef BUFFER_HIDDEN_CELLS
#include "Store/HiddenCells.glsl"
#endif

void StoreBlock(uint slot, DecodedBlock decoded)
{
#define STORE_ROW(r) cacheRows[uint(ROWS_PER_BLOCK) * slot + uint(r)] = decoded.Row[r];
  FOR_ROWS(STORE_ROW)
}

void main()
{
  uint lane = gl_LocalInvocationIndex;
  uint number = NumberOfBlocks();
  uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * GROUP_SIZE;
  for (uint i = FoldedGroup() * GROUP_SIZE + lane; i < number; i += stride)
  {
    uint block = BlockAt(i);
    if (InSegment(block))
    {
      uint slot = SlotFor(i, block);
      if (slot != NONE)
      {
        StoreBlock(FirstSlot() + slot, DecodeBlock(block, lane));
#ifdef BUFFER_HIDDEN_CELLS
        cacheRows[HiddenRow(slot)] = uvec4(FindHiddenCells(block), 0u, 0u);
#endif
      }
    }
  }
}
