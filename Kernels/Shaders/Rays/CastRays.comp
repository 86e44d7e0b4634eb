// Casts the rays of a pass. Each walks the macrocell grid to the blocks whose range of values holds
// an isovalue, in their order along the ray, and is intersected with those that are in the cache.
// At the first that is not it waits for the next pass. So a ray tests no block behind its hit, and
// the first hit that it finds is the nearest.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Shared/GroupAppend.glsl"
#include "Rays/LevelStretches.glsl"
#include "Rays/RayQueues.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/VisitBlock.glsl"
#include "Rays/WorkCounters.glsl"
#include "Surface/Hits.glsl"

// What becomes of a ray in this pass.
#define DONE 0u  // it has left the volume, or needs nothing more
#define WAITS 1u // for blocks
#define HIT 2u

// Walks on from a place to the first hit. Returns true if the ray has to wait for the block that it
// has come to.
bool FindHit(inout Ray ray, inout GridPlace place, out Hit hit)
{
  hit = MISS;
  bool waits = false;
  bool leaves = false;
  GridCursor at = OutsideGrid();
  while (!waits && hit.Key == NO_HIT && FindNextBlock(ray, leaves, place, at))
  {
    BlockVisit visit = PlanVisit(ray, place);
    waits = LacksBlocks(place.Block, visit);
    if (!waits)
    {
      VisitBlock(ray, place, visit, hit);
    }
    leaves = true;
  }
  return waits;
}

uint CastRay(uint pixel, bool isNew)
{
  Ray ray = CameraRay(pixel);
  if (Misses(ray))
  {
    return DONE;
  }
  atomicAdd(groupActiveRays, 1u);
  GridPlace place;
  if (isNew)
  {
    place = BeginRay(ray);
  }
  else
  {
    place = ResumeRay(ray, BlockOfRay(pixel));
  }
  PassLastHit(pixel);
#ifdef LEVELS
  ray.Doubted = IsMissFlagged(pixel);
#endif
  Hit hit;
  bool waits = FindHit(ray, place, hit);
  bool isHit = hit.Key != NO_HIT;
  if (isHit)
  {
    StoreHit(pixel, hit, FlaggedDepth(ray, hit));
  }
#ifdef LEVELS
  else if (IsFlagged(ray))
  {
    FlagMiss(pixel);
  }
#endif
  if (waits || (isHit && RAYS_CONTINUE))
  {
    StoreBlockOfRay(pixel, BlockIndex(place.Block));
  }
  return waits ? WAITS : isHit ? HIT : DONE;
}

#ifdef HAS_RAYS
shared uint groupFirstLive; // least tile order of the rays that wait

// By one invocation: takes places in the queues for what the work group has for them.
void ReservePlaces()
{
  if (ReservesFor(NEXT_RAYS))
  {
    SetGroupListBegin(NEXT_RAYS, ReserveNextRays(GroupListCount(NEXT_RAYS), groupFirstLive));
  }
#ifdef HAS_PENDING_HITS
  if (ReservesFor(HITS))
  {
    SetGroupListBegin(HITS, ReservePendingHits(GroupListCount(HITS)));
  }
#endif
}

// Queues the work group's rays that wait for the next pass, and its hits to be finished.
void QueueRays(uint state, uint pixel, uint order)
{
  OpenGroupList(NEXT_RAYS);
  OpenGroupList(HITS);
  if (gl_LocalInvocationIndex == 0u)
  {
    groupFirstLive = NONE;
  }
  barrier();
  uint place = 0u;
  if (state == WAITS)
  {
    place = AddToGroupList(NEXT_RAYS);
    atomicMin(groupFirstLive, order);
  }
#ifdef HAS_PENDING_HITS
  place = state == HIT ? AddToGroupList(HITS) : place;
#endif
  barrier();
  ReservePlaces();
  barrier();
  if (state == WAITS)
  {
    StoreNextRay(GroupListBegin(NEXT_RAYS) + place, pixel);
  }
#ifdef HAS_PENDING_HITS
  if (state == HIT)
  {
    StorePendingHit(GroupListBegin(HITS) + place, pixel);
  }
#endif
}
#endif

void main()
{
  OpenWorkCounters();
  barrier();
  uint index = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = NONE;
  uint order = NONE;
  uint state = DONE;
  if (index < control.Rays)
  {
    bool isNew = index >= BegunRays();
    if (isNew)
    {
      order = control.FirstNewRay + index - BegunRays();
      pixel = PixelInTileOrder(order);
    }
    else
    {
      pixel = BegunRay(index);
      order = TileOrderOf(pixel); // of no use where there is no pixel
    }
    bool waits = !isNew && pixel != NONE && IsOrderBehindFrontier(order);
    state = waits ? WAITS : pixel != NONE ? CastRay(pixel, isNew) : DONE;
  }
  CloseWorkCounters();
#ifdef HAS_RAYS
  QueueRays(state, pixel, order);
#endif
}
