// Eviction, last step, and the start of a new or grown cache: the map and the ring of free slots are
// made anew from what the slots hold.
// In: CacheSlotBlock. Out: CacheMap, CacheFreeSlots, Control.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "BlockMap.glsl"

layout(local_size_x = 256) in;

void main()
{
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint slot = gl_GlobalInvocationID.x; slot < scene.Cache.x; slot += stride)
  {
    uint block = cacheSlotBlock[slot];
    uint entry = block == NONE ? NONE : InsertEntry(block, scene.Cache.y);
    if (entry == NONE)
    {
      cacheSlotBlock[slot] = NONE;
      cacheFreeSlots[atomicAdd(control.FreeSlots, 1u)] = slot;
    }
    else
    {
      cacheMap[entry].Slot = slot;
    }
  }
}
