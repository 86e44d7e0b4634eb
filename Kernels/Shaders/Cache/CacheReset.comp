// Empties the cache.

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
    mapPages[i].Owner = NONE;
    mapPages[i].Free = i;
  }
  const uint places = uint(BLOCKS_PER_MACROCELL);
  for (uint i = first; i < places * cache.MapPages; i += stride)
  {
    mapPages[i / places].Slots[i % places] = NONE;
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
