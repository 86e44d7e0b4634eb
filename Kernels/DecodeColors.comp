// Decompression of the volume that gives the colours: the blocks that DecodeBlocks.comp has just decoded of the other,
// into the same slots; or, where there is no cache, all blocks.
// In: CacheRequests, CacheMap, Macrocells, Payload. Out: CacheValues.

#define CACHE_BY_ROWS
#define DECODES_COLORS

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "BlockStore.glsl"
#include "ZFPDecode.glsl"

layout(local_size_x = 32) in;

// None where the request was refused.
uint SlotFor(uint i, uint block)
{
  return SlotOf(BlockCoordinates(block));
}

// Behind all slots of the volume that is drawn.
uint FirstSlot()
{
  return NumberOfSlots();
}

#include "DecodeListed.glsl"
