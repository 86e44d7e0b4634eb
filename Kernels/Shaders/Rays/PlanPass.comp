// Between two passes, by a single invocation: closes the record of the one that has ended and plans the next. The
// CPU decides none of it.
// In: Control. Out: Control, PassStatistics.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"

#define PASS_RECORDS 64u
#define LEAST_WINDOW 64u // pixels; the smallest cache has room for all that their rays can need at once

uint Pixels()
{
  return uint(view.ImageSize.x * view.ImageSize.y);
}

void OpenImage()
{
  control.NewImage = 0u;
  control.PassIndex = 0u;
  control.ImageSerial = control.PassSerial + 1u;
  control.Carried = 0u;
  control.NextCarried = 0u;
  control.NextUnlit = 0u;
  control.Again = 0u;
  control.GoingOn = 0u;
  control.Fresh = 0u;
  control.FirstLive = 0u;
  control.Window = PixelsInTiles();
  control.Requests = 0u;
  control.Refused = 0u;
  control.RefusedBefore = 0u;
  control.TouchedSlots = 0u;
}

#ifdef HAS_CACHE_MAP
// Slots and map pages that were taken leave their rings; slots that were not needed after all came back.
void CloseCache(inout PassRecord record)
{
  control.RefusedBefore = control.Refused;
  uint taken = min(min(control.Requests, cache.Slots), control.FreeSlots);
  uint decoded = taken - control.ReturnedSlots;
  control.Refused = control.Requests - decoded;
  control.FreeSlotsBegin = (control.FreeSlotsBegin + taken) % (2u * cache.Slots);
  control.FreeSlots -= decoded;
  control.TouchedSlots += decoded;
  uint pages = min(control.TakenPages, control.FreePages);
  control.FreePagesBegin = (control.FreePagesBegin + pages) % cache.MapPages;
  control.FreePages -= pages;
  record.DecodedBlocks = decoded;
  record.RefusedBlocks = control.Refused;
  record.CachedBlocks = cache.Slots - control.FreeSlots;
  record.TouchedSlots = control.TouchedSlots;
}
#endif

void ClosePass()
{
  control.Fresh += control.Rays - control.Carried - control.Again;
  PassRecord record;
  record.ActiveRays = control.ActiveRays;
  record.Speculation = Speculation(control.NextCarried);
  record.Pairs = control.Pairs;
  record.VisibleBlocks = control.VisibleBlocks;
  record.ActiveBlocks = control.ActiveBlocks;
  record.DecodedBlocks = 0u;
  record.CachedBlocks = volume.NumberOfBlocks;
  record.RemainingRays = control.NextCarried + control.GoingOn + control.NextUnlit + min(PixelsInTiles() - control.Fresh, Pixels());
  record.RefusedBlocks = 0u;
  record.TouchedSlots = 0u;
#ifdef HAS_CACHE_MAP
  CloseCache(record);
#endif
  if (control.Rays + control.Unlit > 0u)
  {
    passRecords[control.PassIndex % PASS_RECORDS] = record;
    ++control.PassIndex;
  }
}

#ifdef HAS_CACHE_MAP
// Where the cache could not serve a pass and cannot grow, and what was evicted then was not enough either, fewer rays
// take part in the next: a window of pixels, in tile order, from the first that has a live ray on. It opens again as
// passes succeed.
void PlanWindow()
{
  uint all = PixelsInTiles();
  uint first = control.Window < all ? min(control.FirstLive, control.Fresh) : 0u;
  bool again = control.Refused > 0u && control.RefusedBefore > 0u && cache.CannotGrow != 0u;
  control.Window = again ? max(control.Window / 4u, LEAST_WINDOW) : min(2u * control.Window, all);
  control.Frontier = control.Window < all ? min(first + control.Window, all) : all;
  control.FirstLive = all; // the pass finds it anew
}

// Slots or map pages may run out: those pages go that were not used for longest, but none of the last pass. Units
// are counted while pages are evicted: slots, or where pages are short, pages.
void PlanEviction()
{
  uint slots = cache.Slots;
  uint pages = cache.MapPages;
  // there is a slot for every block, a page for every macrocell
  bool allSlots = slots >= volume.NumberOfBlocks;
  bool allPages = pages >= volume.NumberOfMacrocells;
  uint enoughSlots = control.Refused > 0u ? slots / 2u : max(slots / 8u, min(control.Requests, slots / 2u));
  uint enoughPages = control.Refused > 0u ? pages / 2u : max(pages / 8u, min(control.TakenPages, pages / 2u));
  bool fewSlots = !allSlots && control.FreeSlots < enoughSlots;
  bool fewPages = !allPages && control.FreePages < enoughPages;
  control.EvictByPages = fewPages ? 1u : 0u;
  // more than is wanted now, so that not every pass evicts
  control.EvictWanted =
    fewPages ? min(2u * enoughPages, pages) - control.FreePages : min(2u * enoughSlots, slots) - control.FreeSlots;
  control.EvictGroups.X = fewSlots || fewPages ? clamp((pages + CACHE_EVICT_GROUP_SIZE - 1u) / CACHE_EVICT_GROUP_SIZE, 1u, 4096u) : 0u;
  control.Evicted = 0u;
  for (uint i = 0u; (fewSlots || fewPages) && i < 256u; ++i)
  {
    control.Ages[i] = 0u;
  }
}
#endif

void PlanRays()
{
  control.Carried = control.NextCarried;
  control.NextCarried = 0u;
#ifdef TRANSLUCENT
  control.Again = control.GoingOn > 0u ? control.Unlit : 0u;
  control.GoingOn = 0u;
#endif
  control.Unlit = control.NextUnlit;
  control.NextUnlit = 0u;
  control.List ^= 1u;
  uint fresh = control.Frontier > control.Fresh ? control.Frontier - control.Fresh : 0u;
  control.Rays = control.Carried + control.Again + fresh;
}

uvec2 Folded(uint groups)
{
  return uvec2(min(groups, MAX_GROUPS), (groups + MAX_GROUPS - 1u) / MAX_GROUPS);
}

// Where there are so few rays that each can have a work group, it gets one.
void PlanDispatches()
{
  bool carried = control.Rays == control.Carried + control.Again;
  bool few = carried && cache.PixelsPerStraggler > 0u && control.Rays <= Pixels() / cache.PixelsPerStraggler;
  uvec2 groups = few ? Folded(control.Rays) : Folded((control.Rays + CAST_RAYS_GROUP_SIZE - 1u) / CAST_RAYS_GROUP_SIZE);
  control.CastGroups.X = few ? 0u : groups.x;
  control.CastGroups.Y = groups.y;
  control.FewGroups.X = few ? groups.x : 0u;
  control.FewGroups.Y = groups.y;
#ifdef HAS_RAYS
  control.NormalGroups.X = min((control.Unlit + FINISH_HITS_GROUP_SIZE - 1u) / FINISH_HITS_GROUP_SIZE, MAX_GROUPS); // hits add to it
#else
  groups = Folded((PixelsInTiles() + FINISH_HITS_GROUP_SIZE - 1u) / FINISH_HITS_GROUP_SIZE);
  control.NormalGroups.X = control.Rays == 0u ? 0u : groups.x;
  control.NormalGroups.Y = groups.y;
#endif
  control.RequestGroups.X = 0u;
  control.DecodeGroups.X = 0u;
}

void ResetCounters()
{
  ++control.PassSerial;
  control.ActiveRays = 0u;
  control.Pairs = 0u;
  control.Requests = 0u;
  control.VisibleBlocks = 0u;
  control.ActiveBlocks = 0u;
  control.ReturnedSlots = 0u;
  control.TakenPages = 0u;
}

void main()
{
  if (control.NewImage != 0u)
  {
    OpenImage();
  }
  else
  {
    ClosePass();
  }
#ifdef HAS_CACHE_MAP
  PlanWindow();
  PlanEviction();
#else
  control.Frontier = PixelsInTiles();
#endif
  PlanRays();
  PlanDispatches();
  ResetCounters();
}
