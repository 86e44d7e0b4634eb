// First step of the cache's growth: unwinds the ring of free slots, which is about to have room for
// more. What lies at its end moves behind what has wrapped around to its beginning. The ring is at
// most half full, so that the move overlaps nothing that is still to move.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

void main()
{
  uint first = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint ring = 2u * cache.FirstNewSlot;
  uint wrapped = max(control.FreeSlotsBegin + control.FreeSlots, ring) - ring;
  uint atEnd = wrapped > 0u ? control.FreeSlots - wrapped : 0u;
  for (uint i = first; i < atEnd; i += stride)
  {
    cacheFreeSlots[wrapped + i] = cacheFreeSlots[control.FreeSlotsBegin + i];
  }
  if (first == 0u)
  {
    control.KeptSlotsBegin = wrapped > 0u ? 0u : control.FreeSlotsBegin;
    control.KeptFreeSlots = control.FreeSlots;
    control.FreePagesBegin = 0u; // the next step fills this ring anew
    control.FreePages = 0u;
  }
}
