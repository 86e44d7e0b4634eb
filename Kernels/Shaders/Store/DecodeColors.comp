// Decodes the volume that gives the colours: the blocks that DecodeBlocks.comp has just decoded of
// the volume that is drawn, into the same slots; without a cache, all blocks.
// In: CacheRequests, CacheMap, Macrocells, Stream. Out: CacheValues.

#define CACHE_BY_ROWS
#define DECODES_COLORS

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Cache/BlockMap.glsl"
#include "Store/BlockStore.glsl"
#include "Store/ZFPDecode.glsl"

// NONE if the request was denied.
uint SlotFor(uint i, uint block)
{
  return SlotOf(BlockCoordinates(block));
}

// The colours' slots follow all those of the volume that is drawn.
uint FirstSlot()
{
  return NumberOfSlots();
}

#include "Store/DecodeListed.glsl"
