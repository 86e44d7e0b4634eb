// Group rays by block (section 3.6): the scatter of the counting sort. Pairs of deferred blocks lose
// their entry, which tells NearestHit.comp to send the ray back to them.
// In: LiveRays, PairEntry, CacheMap. Out: GroupedRays, PairEntry.

#include "Scene.glsl"
#include "Buffers.glsl"

layout(local_size_x = 64) in;

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  uint pairs = control.LiveRays * control.Speculation;
  for (uint i = gl_GlobalInvocationID.x; i < pairs; i += stride)
  {
    uint entry = pairEntry[i];
    if (entry == NONE)
    {
      continue;
    }
    uint offset = cacheMap[entry].Offset;
    if (offset == NONE)
    {
      pairEntry[i] = NONE;
    }
    if (offset >= UNGROUPED)
    {
      continue;
    }
    uint at = atomicAdd(cacheMap[entry].Offset, 1u);
    groupedRays[at] = liveRays[i / control.Speculation];
  }
}
