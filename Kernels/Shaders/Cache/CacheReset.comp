// A new cache holds nothing.
// Out: Macrocells, CacheMap, CacheFreeSlots, Control.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

void main()
{
  uint first = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  for (uint i = first; i < volume.NumberOfMacrocells; i += stride)
  {
    macrocells[i].Page = NONE;
    macrocells[i].Requested[0] = 0u;
    macrocells[i].Requested[1] = 0u;
  }
  for (uint i = first; i < cache.Slots; i += stride)
  {
    cacheFreeSlots[i] = i;
  }
  for (uint i = first; i < cache.MapPages; i += stride)
  {
    mapPages[i].Cell = NONE;
    mapPages[i].Free = i;
  }
  for (uint i = first; i < 64u * cache.MapPages; i += stride)
  {
    mapPages[i >> 6].Slots[i & 63u] = NONE;
  }
  if (first == 0u)
  {
    control.FreeSlotsBegin = 0u;
    control.FreeSlots = cache.Slots;
    control.FreePagesBegin = 0u;
    control.FreePages = cache.MapPages;
    control.EvictGroups.X = 0u;
  }
}
