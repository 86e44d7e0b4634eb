// Second step of eviction: frees the blocks of the pages that were not used for longest. Those of
// age 0 stay: the last pass used them, and what it decoded is for the next.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/PageAges.glsl"

const uint AGES_PER_LANE = PASS_AGES / GROUP_SIZE;

shared uint oldestKept;       // age beyond which all pages are evicted
shared uint evictedAtOldest;  // units to free among pages of exactly this age
shared uint unitsFrom[GROUP_SIZE]; // of a lane's ages and all beyond

// Each lane adds up its ages, then those of all lanes behind it, in steps of twice the reach.
void AddUpAges()
{
  uint lane = gl_LocalInvocationIndex;
  uint units = 0u;
  for (uint i = 0u; i < AGES_PER_LANE; ++i)
  {
    units += control.Ages[AGES_PER_LANE * lane + i];
  }
  unitsFrom[lane] = units;
  for (uint reach = 1u; reach < GROUP_SIZE; reach *= 2u)
  {
    barrier();
    units = lane + reach < GROUP_SIZE ? unitsFrom[lane + reach] : 0u;
    barrier();
    unitsFrom[lane] += units;
  }
}

// Finds the greatest age from which on there are as many units as are wanted. If there are too few
// at all, only age 0 is kept.
void FindThreshold()
{
  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u)
  {
    oldestKept = 0u;
    evictedAtOldest = 0u;
  }
  AddUpAges();
  barrier();
  uint wanted = control.EvictWanted;
  uint beyond = lane + 1u < GROUP_SIZE ? unitsFrom[lane + 1u] : 0u;
  for (uint age = AGES_PER_LANE * (lane + 1u) - 1u;
       age > 0u && age >= AGES_PER_LANE * lane && beyond < wanted; --age)
  {
    uint units = beyond + control.Ages[age];
    if (units >= wanted)
    {
      oldestKept = age;
      evictedAtOldest = wanted - beyond;
    }
    beyond = units;
  }
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
  FindThreshold();
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
