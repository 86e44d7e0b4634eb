// Eviction, first step: how many blocks have not been used for how many passes? And the map is emptied.
// In: CacheSlotBlock, CacheSlotStamp. Out: Control (Ages), CacheMap.

#include "Scene.glsl"
#include "Buffers.glsl"

layout(local_size_x = 256) in;

void main()
{
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint i = gl_GlobalInvocationID.x; i < scene.Cache.y; i += stride)
  {
    cacheMap[i] = MapEntry(NONE, NONE, 0u, NONE, 0u);
    if (i < scene.Cache.x && cacheSlotBlock[i] != NONE)
    {
      atomicAdd(control.Ages[min(control.PassSerial - cacheSlotStamp[i], 255u)], 1u);
    }
  }
}
