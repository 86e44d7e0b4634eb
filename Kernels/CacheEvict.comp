// Eviction, second step: the pages that were not used for longest lose their blocks. Those of age 0 stay: the last
// pass used them, and what it decoded is for the next.
// In: Control (Ages, EvictWanted). Out: CacheMap, Macrocells, CacheFreeSlots, Control.

#include "Scene.glsl"
#include "Buffers.glsl"

layout(local_size_x = 64) in;

shared uint oldestKept;   // pages older than this go,
shared uint goneAtOldest; // and that many units of this very age
shared bool goes;
shared uint freed;
shared uint begin;

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

// One lane a slot.
void Evict(uint page)
{
  uint lane = gl_LocalInvocationIndex;
  uint slot = mapPages[page].Slots[lane];
  uint at = slot == NONE ? 0u : atomicAdd(freed, 1u);
  barrier();
  if (lane == 0u)
  {
    begin = control.FreeSlotsBegin + atomicAdd(control.FreeSlots, freed);
    macrocells[mapPages[page].Cell].Page = NONE;
    mapPages[page].Cell = NONE;
    mapPages[(control.FreePagesBegin + atomicAdd(control.FreePages, 1u)) % scene.Cache.y].Free = page;
  }
  barrier();
  if (slot != NONE)
  {
    cacheFreeSlots[(begin + at) % (2u * scene.Cache.x)] = slot;
    mapPages[page].Slots[lane] = NONE;
  }
}

void main()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    FindThreshold();
  }
  for (uint page = gl_WorkGroupID.x; page < scene.Cache.y; page += gl_NumWorkGroups.x)
  {
    barrier();
    if (gl_LocalInvocationIndex == 0u)
    {
      goes = Goes(page);
      freed = 0u;
    }
    barrier();
    if (goes)
    {
      Evict(page);
    }
  }
}
