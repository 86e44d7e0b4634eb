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

void StoreColors(uint slot, DecodedBlock decoded)
{
#define STORE_COLORS(r) cacheRows[16u * (NumberOfSlots() + slot) + uint(r)] = decoded.Row[r];
  FOR_ROWS(STORE_COLORS)
}

void main()
{
  uint lane = gl_LocalInvocationIndex;
#ifdef HAS_CACHE_MAP
  uint number = min(control.Requests, scene.Cache.x);
#else
  uint number = uint(scene.Blocks.w);
#endif
  uint stride = gl_NumWorkGroups.x * gl_NumWorkGroups.y * ZFP_LANES;
  for (uint i = FoldedGroup() * ZFP_LANES + lane; i < number; i += stride)
  {
#ifdef HAS_CACHE_MAP
    uint block = cacheRequests[i];
#else
    uint block = i;
#endif
    uint slot = InSegment(block) ? SlotOf(BlockCoordinates(block)) : NONE; // none where the request was refused
    if (slot != NONE)
    {
      StoreColors(slot, DecodeBlock(block, lane));
    }
  }
}
