// Eviction, second step: the pages that were not used for longest lose their blocks. Those of age 0 stay: the last
// pass used them, and what it decoded is for the next.
// In: Control (Ages, EvictWanted). Out: CacheMap, Macrocells, CacheFreeSlots, Control.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

shared uint oldestKept;   // pages older than this go,
shared uint goneAtOldest; // and that many units of this very age

void FindThreshold()
{
  uint wanted = control.EvictWanted;
  uint age = 255u;
  for (; age > 0u && control.Ages[age] < wanted; --age)
  {
    wanted -= control.Ages[age];
  }
  oldestKept = age;
  goneAtOldest = age > 0u ? wanted : 0u;
}

bool Goes(uint page)
{
  if (mapPages[page].Cell == NONE)
  {
    return false;
  }
  uint age = min(control.PassSerial - 1u - mapPages[page].Stamp, 255u);
  uint units = control.EvictByPages != 0u ? 1u : mapPages[page].Used;
  return age > oldestKept || (age == oldestKept && goneAtOldest > 0u && atomicAdd(control.Evicted, units) < goneAtOldest);
}

void Evict(uint page)
{
  uint to = control.FreeSlotsBegin + atomicAdd(control.FreeSlots, mapPages[page].Used);
  for (uint i = 0u; i < 64u; ++i)
  {
    uint slot = mapPages[page].Slots[i];
    if (slot != NONE)
    {
      cacheFreeSlots[to % (2u * cache.Slots)] = slot;
      mapPages[page].Slots[i] = NONE;
      ++to;
    }
  }
  macrocells[mapPages[page].Cell].Page = NONE;
  mapPages[page].Cell = NONE;
  mapPages[(control.FreePagesBegin + atomicAdd(control.FreePages, 1u)) % cache.MapPages].Free = page;
}

// One lane a page.
void main()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    FindThreshold();
  }
  barrier();
  uint first = GROUP_SIZE * gl_WorkGroupID.x + gl_LocalInvocationIndex;
  for (uint page = first; page < cache.MapPages; page += GROUP_SIZE * gl_NumWorkGroups.x)
  {
    if (Goes(page))
    {
      Evict(page);
    }
  }
}
