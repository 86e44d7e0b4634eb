// Decodes the volume that gives the colours: the blocks that DecodeBlocks.comp has just decoded of
// the volume that is drawn, into the same slots; without a cache, all blocks.

#define CACHE_BY_ROWS
#define DECODES_COLORS

#include "Shared/Grid.glsl"
#include "Cache/SlotLayout.glsl"
#include "Store/DecodeListed.glsl"
#include BLOCK_ACCESS

// NONE if the request was denied.
uint SlotFor(uint i, uint block)
{
  EnterLevelOf(block);
  return SlotOf(BlockCoordinates(block));
}

// The colours' slots follow all those of the volume that is drawn.
uint FirstSlot()
{
  return ColorSlot(0u);
}
