// First step of eviction: counts how much of the cache has not been used for how many passes.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/PageAges.glsl"

shared uint groupAges[PASS_AGES];

void main()
{
  uint lane = gl_LocalInvocationIndex; // the group has as many lanes as there are ages
  groupAges[lane] = 0u;
  barrier();
  uint first = GROUP_SIZE * gl_WorkGroupID.x + lane;
  for (uint page = first; page < cache.MapPages; page += GROUP_SIZE * gl_NumWorkGroups.x)
  {
    if (mapPages[page].Owner != NONE)
    {
      atomicAdd(groupAges[AgeOf(page)], UnitsOf(page));
    }
  }
  barrier();
  if (groupAges[lane] > 0u)
  {
    atomicAdd(control.Ages[lane], groupAges[lane]);
  }
}
