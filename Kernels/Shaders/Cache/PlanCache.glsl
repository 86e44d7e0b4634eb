// What PlanPass decides about the cache: which rays it has room for, and what it evicts.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"

#ifdef HAS_CACHE_MAP
// Slots and map pages that were taken leave their rings; slots that no page was found for are back.
void CloseCache(inout PassRecord record)
{
  control.DeniedRequestsBefore = control.DeniedRequests;
  uint taken = min(min(control.Requests, cache.Slots), control.FreeSlots);
  uint decoded = taken - control.ReturnedSlots;
  control.DeniedRequests = control.Requests - decoded;
  control.FreeSlotsBegin = (control.FreeSlotsBegin + taken) % (2u * cache.Slots);
  control.FreeSlots -= decoded;
  control.TouchedSlots += decoded;
  uint pages = min(control.TakenPages, control.FreePages);
  control.FreePagesBegin = (control.FreePagesBegin + pages) % cache.MapPages;
  control.FreePages -= pages;
  record.DecodedBlocks = decoded;
  record.RefusedBlocks = control.DeniedRequests;
  record.CachedBlocks = cache.Slots - control.FreeSlots;
  record.TouchedSlots = control.TouchedSlots;
}

// Lets fewer rays take part in the next pass if the cache could not serve two in a row, with an
// eviction between them, and cannot grow: those of a window of pixels, in tile order, from the
// first that has a live ray. It opens again as passes succeed.
void PlanWindow()
{
  uint all = PixelsInTiles();
  uint first = control.Window < all ? min(control.FirstLive, control.FirstNewRay) : 0u;
  bool again = control.DeniedRequests > 0u && control.DeniedRequestsBefore > 0u &&
    cache.CannotGrow != 0u;
  control.Window = again ? max(control.Window / 4u, LEAST_WINDOW) : min(2u * control.Window, all);
  control.Frontier = control.Window < all ? min(first + control.Window, all) : all;
  control.FirstLive = all; // the pass finds it anew
}

// Free slots, or pages, that are enough of so many: half after a denial; else an eighth, or as many
// as the last pass took.
uint EnoughFree(uint all, uint taken)
{
  return control.DeniedRequests > 0u ? all / 2u : max(all / 8u, min(taken, all / 2u));
}

// Evicts if slots or map pages may run out: the pages that were not used for longest, but none of
// the last pass. Units are counted as pages are evicted: slots, or pages if those are short.
void PlanEviction()
{
  uint slots = cache.Slots;
  uint pages = cache.MapPages;
  // with a slot for every block, or a page for every macrocell, they cannot run out
  bool allSlots = slots >= volume.NumberOfBlocks;
  bool allPages = pages >= volume.NumberOfMacrocells;
  uint enoughSlots = EnoughFree(slots, control.Requests);
  uint enoughPages = EnoughFree(pages, control.TakenPages);
  bool fewSlots = !allSlots && control.FreeSlots < enoughSlots;
  bool fewPages = !allPages && control.FreePages < enoughPages;
  control.EvictByPages = fewPages ? 1u : 0u;
  // more than is wanted now, so that not every pass evicts
  control.EvictWanted = fewPages ? min(2u * enoughPages, pages) - control.FreePages
                                 : min(2u * enoughSlots, slots) - control.FreeSlots;
  control.EvictGroups.X =
    fewSlots || fewPages ? clamp(GroupsOf(pages, CACHE_EVICT_GROUP_SIZE), 1u, 4096u) : 0u;
  control.Evicted = 0u;
  for (uint i = 0u; (fewSlots || fewPages) && i < PASS_AGES; ++i)
  {
    control.Ages[i] = 0u;
  }
}

void PlanCache()
{
  PlanWindow();
  PlanEviction();
}
#else
void CloseCache(inout PassRecord record) {}

void PlanCache()
{
  control.Frontier = PixelsInTiles();
}
#endif
