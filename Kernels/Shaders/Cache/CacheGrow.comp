// Second step of the cache's growth: adds the new slots to the ring of free ones, and fills the
// ring of free map pages. Blocks keep their slots, and rays under way go on.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

void main()
{
  uint first = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint newSlots = cache.Slots - cache.FirstNewSlot;
  uint to = control.KeptSlotsBegin + control.KeptFreeSlots;
  for (uint i = first; i < newSlots; i += stride)
  {
    cacheFreeSlots[(to + i) % (2u * cache.Slots)] = cache.FirstNewSlot + i;
  }
  for (uint page = first; page < cache.MapPages; page += stride)
  {
    bool isNew = page >= cache.FirstNewPage;
    if (isNew || mapPages[page].Owner == NONE)
    {
      mapPages[page].Owner = NONE;
      mapPages[atomicAdd(control.FreePages, 1u)].Free = page;
    }
  }
  const uint places = uint(BLOCKS_PER_MACROCELL);
  for (uint i = places * cache.FirstNewPage + first; i < places * cache.MapPages; i += stride)
  {
    mapPages[i / places].Slots[i % places] = NONE;
  }
  if (first == 0u)
  {
    control.FreeSlotsBegin = control.KeptSlotsBegin;
    control.FreeSlots = control.KeptFreeSlots + newSlots;
    control.EvictGroups.X = 0u; // there is room now
  }
}
