// Marks blocks as used: for eviction, and for the statistics of distinct blocks.

#include BLOCK_ACCESS

uint visibleBlocks = 0u; // that this invocation is the first of the pass to intersect,
uint activeBlocks = 0u;  // and to need

#ifdef BUFFER_CACHE_SEEN
bool IsFirstUse(uint counter)
{
  return atomicExchange(cacheSeen[counter], control.PassSerial) != control.PassSerial;
}

void CountBlocks(ivec3 first, ivec3 reach)
{
  visibleBlocks += IsFirstUse(2u * SlotOf(first)) ? 1u : 0u;
  for (int i = 0; i < 8; ++i)
  {
    ivec3 side = SideOffset(i);
    if (all(lessThanEqual(side, reach)))
    {
      activeBlocks += IsFirstUse(2u * SlotOf(first + side) + 1u) ? 1u : 0u;
    }
  }
}
#endif

// Marks the blocks from `first` to first + reach, whose slots were found last.
void UseBlocks(ivec3 first, ivec3 reach)
{
#ifdef BUFFER_CACHE_SEEN
  CountBlocks(first, reach);
#endif
  UsePages(first, reach);
}
