// Casts the last rays of an image, like CastRays but a ray a work group: its lanes take the next
// blocks along the ray, one each, so that they need not wait for each other's blocks.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/LevelStretches.glsl"
#include "Rays/RayQueues.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/VisitBlock.glsl"
#include "Rays/WorkCounters.glsl"
#include "Surface/Hits.glsl"

// The first lanes, in the order along the ray, whose block is not in the cache, and whose block is
// hit; GROUP_SIZE if there is none.
shared uint firstMissing;
shared uint firstHit;

// Gives lane i the i-th active block from a place on, if there is one; false for the lanes behind
// the last. The whole group walks together, and `inside` tells whether there may be more. `leaves`:
// the first place has been taken.
bool TakeBlock(inout Ray ray, inout bool leaves, inout GridPlace place, inout GridCursor at,
  inout bool inside, out Ray taker, out GridPlace taken)
{
  bool took = false;
  taken = place;
  taker = ray;
  for (uint i = 0u; i < GROUP_SIZE && inside; ++i)
  {
    inside = FindActiveBlock(ray, leaves, place, at);
    leaves = true;
    if (inside && i == gl_LocalInvocationIndex)
    {
      taken = place;
      taker = ray;
      took = true;
    }
  }
  return took;
}

// By the lane that has the hit.
void KeepHit(Ray ray, uint pixel, ivec3 block, Hit hit)
{
  StoreHit(pixel, hit, FlaggedDepth(ray, hit));
  if (RAYS_CONTINUE)
  {
    StoreBlockOfRay(pixel, BlockIndex(block));
  }
#ifdef HAS_PENDING_HITS
  StorePendingHit(ReservePendingHits(1u), pixel);
#endif
}

// By one lane, for a ray that has no hit.
void KeepFlag(Ray ray, uint pixel)
{
#ifdef LEVELS
  if (IsFlagged(ray))
  {
    FlagMiss(pixel);
  }
#endif
}

// True if the ray has to go on in the next pass.
bool CastRay(uint pixel)
{
  uint lane = gl_LocalInvocationIndex;
  Ray ray = CameraRay(pixel);
  GridPlace next = ResumeRay(ray, BlockOfRay(pixel));
#ifdef LEVELS
  ray.Doubted = IsMissFlagged(pixel);
#endif
  PassLastHit(pixel);
  GridCursor at = OutsideGrid();
  bool leaves = false;
  bool inside = true;
  while (inside)
  {
    Ray taker; // as it was at the block: what it has passed since does not count
    GridPlace place;
    bool took = TakeBlock(ray, leaves, next, at, inside, taker, place);
    BlockVisit visit = PlanVisit(taker, place);
    if (took && LacksBlocks(place.Block, visit))
    {
      atomicMin(firstMissing, lane);
    }
    barrier();
    Hit hit = MISS;
    if (took && lane < firstMissing && VisitBlock(taker, place, visit, hit))
    {
      atomicMin(firstHit, lane);
    }
    barrier();
    if (firstHit == lane)
    {
      KeepHit(taker, pixel, place.Block, hit);
    }
    else if (firstHit == GROUP_SIZE && firstMissing == lane)
    {
      StoreBlockOfRay(pixel, BlockIndex(place.Block));
      KeepFlag(taker, pixel);
    }
    if (firstHit < GROUP_SIZE || firstMissing < GROUP_SIZE)
    {
      return firstHit == GROUP_SIZE;
    }
    barrier(); // all have read the first lanes before any finds others
    if (!inside)
    {
      inside = EnterNextStretch(ray, next, at);
      leaves = false;
    }
  }
  if (lane == 0u)
  {
    KeepFlag(ray, pixel);
  }
  return false;
}

void main()
{
  OpenWorkCounters();
  if (gl_LocalInvocationIndex == 0u)
  {
    firstMissing = GROUP_SIZE;
    firstHit = GROUP_SIZE;
  }
  barrier();
  uint index = FoldedGroup();
  if (index >= control.Rays)
  {
    return;
  }
  uint pixel = BegunRay(index);
  if (pixel == NONE)
  {
    return;
  }
  uint order = TileOrderOf(pixel);
  bool behind = IsOrderBehindFrontier(order);
  bool live = behind || CastRay(pixel);
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActiveRays = behind ? 0u : 1u;
    if (live)
    {
      StoreNextRay(ReserveNextRays(1u, order), pixel);
    }
  }
  barrier();
  CloseWorkCounters();
}
