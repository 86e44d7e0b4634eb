// Between two passes, by a single invocation: closes the record of the one that has ended and plans
// the next. The CPU decides none of it.

#include "Cache/PlanCache.glsl"
#include "Rays/Rays.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Scene.glsl"

void OpenImage()
{
  control.NewImage = 0u;
  control.PassIndex = 0u;
  control.ImageSerial = control.PassSerial + 1u;
  control.WaitingRays = 0u;
  control.NextWaitingRays = 0u;
  control.PostponedHits = 0u;
  control.ContinuingRays = 0u;
  control.NextContinuingRays = 0u;
  control.FirstNewRay = 0u;
  control.FirstLive = 0u;
  control.Window = PixelsInTiles();
  control.Requests = 0u;
  control.DeniedRequests = 0u;
  control.DeniedRequestsBefore = 0u;
  control.TouchedSlots = 0u;
}

void ClosePass()
{
  control.FirstNewRay += control.Rays - control.WaitingRays - control.ContinuingRays;
  PassRecord record;
  record.ActiveRays = control.ActiveRays;
  record.Speculation = Speculation(control.NextWaitingRays);
  record.Pairs = control.Pairs;
  record.VisibleBlocks = control.VisibleBlocks;
  record.ActiveBlocks = control.ActiveBlocks;
  record.DecodedBlocks = 0u;
  record.CachedBlocks = volume.NumberOfBlocks;
  record.RemainingRays = control.NextWaitingRays + control.NextContinuingRays +
    control.PostponedHits + min(PixelsInTiles() - control.FirstNewRay, ImagePixels());
  record.RefusedBlocks = 0u;
  record.TouchedSlots = 0u;
  CloseCache(record);
  if (control.Rays + control.PendingHits > 0u)
  {
    passRecords[control.PassIndex % PASS_RECORDS] = record;
    ++control.PassIndex;
  }
}

void PlanRays()
{
  control.WaitingRays = control.NextWaitingRays;
  control.NextWaitingRays = 0u;
#ifdef TRANSLUCENT
  control.ContinuingRays = control.NextContinuingRays > 0u ? control.PendingHits : 0u;
  control.NextContinuingRays = 0u;
#endif
  control.PendingHits = control.PostponedHits;
  control.PostponedHits = 0u;
  control.Queue ^= 1u;
  uint newRays = max(control.Frontier, control.FirstNewRay) - control.FirstNewRay;
  control.Rays = control.WaitingRays + control.ContinuingRays + newRays;
}

uvec2 Folded(uint groups)
{
  return uvec2(min(groups, MAX_GROUPS), GroupsOf(groups, MAX_GROUPS));
}

// Casts every ray by a work group of its own if there are so few that each can have one.
void PlanCasting()
{
  bool noneIsNew = control.Rays == control.WaitingRays + control.ContinuingRays;
  bool stragglers = noneIsNew && cache.PixelsPerStraggler > 0u &&
    control.Rays <= ViewportPixels() / cache.PixelsPerStraggler;
  uvec2 groups =
    Folded(stragglers ? control.Rays : GroupsOf(control.Rays, CAST_RAYS_GROUP_SIZE));
  control.CastGroups.X = stragglers ? 0u : groups.x;
  control.CastGroups.Y = groups.y;
  control.StragglerGroups.X = stragglers ? groups.x : 0u;
  control.StragglerGroups.Y = groups.y;
}

void PlanDispatches()
{
  PlanCasting();
#ifdef HAS_RAYS
  uint groups = GroupsOf(control.PendingHits, FINISH_HITS_GROUP_SIZE);
  control.FinishGroups.X = min(groups, MAX_GROUPS); // the pass's hits add to it
#else
  uvec2 groups = Folded(GroupsOf(PixelsInTiles(), FINISH_HITS_GROUP_SIZE));
  control.FinishGroups.X = control.Rays == 0u ? 0u : groups.x;
  control.FinishGroups.Y = groups.y;
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
  PlanCache();
  PlanRays();
  PlanDispatches();
  ResetCounters();
}
