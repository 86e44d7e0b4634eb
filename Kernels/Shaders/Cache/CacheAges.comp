// Eviction, first step: how much of the cache has not been used for how many passes?
// In: CacheMap. Out: Control (Ages).

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

shared uint groupAges[256];

void main()
{
  uint lane = gl_LocalInvocationIndex;
  groupAges[lane] = 0u;
  barrier();
  for (uint page = GROUP_SIZE * gl_WorkGroupID.x + lane; page < cache.MapPages; page += GROUP_SIZE * gl_NumWorkGroups.x)
  {
    if (mapPages[page].Cell != NONE)
    {
      uint units = control.EvictByPages != 0u ? 1u : mapPages[page].Used;
      atomicAdd(groupAges[min(control.PassSerial - 1u - mapPages[page].Stamp, 255u)], units);
    }
  }
  barrier();
  if (groupAges[lane] > 0u)
  {
    atomicAdd(control.Ages[lane], groupAges[lane]);
  }
}
