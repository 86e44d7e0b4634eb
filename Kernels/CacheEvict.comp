// Eviction, second step: the least recently used blocks lose their slots.
// In: Control (Ages, EvictSlots), CacheSlotStamp. Out: CacheSlotBlock.

#include "Scene.glsl"
#include "Buffers.glsl"

layout(local_size_x = 256) in;

shared uint oldestKept;    // blocks older than this go,
shared uint goneAtOldest;  // and that many of this very age

void FindThreshold()
{
  uint wanted = control.EvictSlots;
  uint age = 255u;
  for (; age > 0u && control.Ages[age] < wanted; --age)
  {
    wanted -= control.Ages[age];
  }
  oldestKept = age;
  goneAtOldest = wanted;
}

void main()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    FindThreshold();
  }
  barrier();
  uint stride = gl_NumWorkGroups.x * 256u;
  for (uint i = gl_GlobalInvocationID.x; i < scene.Cache.x; i += stride)
  {
    if (cacheSlotBlock[i] == NONE)
    {
      continue;
    }
    uint age = min(control.PassSerial - cacheSlotStamp[i], 255u);
    if (age > oldestKept || (age == oldestKept && atomicAdd(control.Evicted, 1u) < goneAtOldest))
    {
      cacheSlotBlock[i] = NONE;
    }
  }
}
