// Second step of eviction: frees the blocks of the pages that were not used for longest. Those of
// age 0 stay: the last pass used them, and what it decoded is for the next.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/PageAges.glsl"

shared uint oldestKept;       // age beyond which all pages are evicted
shared uint evictedAtOldest;  // units to free among pages of exactly this age

void FindThreshold()
{
  uint wanted = control.EvictWanted;
  uint age = PASS_AGES - 1u;
  for (; age > 0u && control.Ages[age] < wanted; --age)
  {
    wanted -= control.Ages[age];
  }
  oldestKept = age;
  evictedAtOldest = age > 0u ? wanted : 0u;
}

bool ShouldEvict(uint page)
{
  if (mapPages[page].Owner == NONE)
  {
    return false;
  }
  uint age = AgeOf(page);
  return age > oldestKept ||
    (age == oldestKept && evictedAtOldest > 0u &&
      atomicAdd(control.Evicted, UnitsOf(page)) < evictedAtOldest);
}

void Evict(uint page)
{
  uint to = control.FreeSlotsBegin + atomicAdd(control.FreeSlots, mapPages[page].Used);
  for (int i = 0; i < BLOCKS_PER_MACROCELL; ++i)
  {
    uint slot = mapPages[page].Slots[i];
    if (slot != NONE)
    {
      cacheFreeSlots[to % (2u * cache.Slots)] = slot;
      mapPages[page].Slots[i] = NONE;
      ++to;
    }
  }
  macrocells[mapPages[page].Owner].Page = NONE;
  mapPages[page].Owner = NONE;
  uint free = control.FreePagesBegin + atomicAdd(control.FreePages, 1u);
  mapPages[free % cache.MapPages].Free = page;
}

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
    if (ShouldEvict(page))
    {
      Evict(page);
    }
  }
}
