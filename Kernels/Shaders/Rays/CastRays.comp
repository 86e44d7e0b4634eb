// Casts the rays of a pass. Each walks the macrocell grid to the blocks whose range of values holds
// an isovalue, in their order along the ray, and is intersected with those that are in the cache.
// At the first that is not it waits for the next pass. So a ray tests no block behind its hit, and
// the first hit that it finds is the nearest.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Shared/GroupAppend.glsl"
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

// Walks from `block` to the first hit. Returns true if the ray has to wait for the block that it
// has come to.
bool FindHit(Ray ray, inout ivec3 block, out Hit hit)
{
  hit = MISS;
  GridCursor at = OutsideGrid();
  while (FindActiveBlock(ray, block, at))
  {
    BlockVisit visit = PlanVisit(ray, block);
    if (LacksBlocks(block, visit))
    {
      return true;
    }
    if (VisitBlock(ray, block, visit, hit) || !NextBlock(ray, block))
    {
      return false;
    }
  }
  return false;
}

uint CastRay(uint pixel, bool isNew)
{
  Ray ray = CameraRay(pixel);
  if (Misses(ray))
  {
    return DONE;
  }
  atomicAdd(groupActiveRays, 1u);
  ivec3 block = isNew ? FirstBlock(ray) : BlockCoordinates(BlockOfRay(pixel));
  PassLastHit(pixel);
  Hit hit;
  bool waits = FindHit(ray, block, hit);
  bool isHit = hit.Key != NO_HIT;
  if (isHit)
  {
    StoreHit(pixel, hit, DepthAt(HitT(hit.Key)));
  }
  if (waits || (isHit && RAYS_CONTINUE))
  {
    StoreBlockOfRay(pixel, BlockIndex(block));
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
void QueueRays(uint state, uint pixel)
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
    atomicMin(groupFirstLive, TileOrderOf(pixel));
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
  uint state = DONE;
  if (index < control.Rays)
  {
    bool isNew = index >= BegunRays();
    pixel = isNew ? PixelInTileOrder(control.FirstNewRay + index - BegunRays()) : BegunRay(index);
    bool waits = !isNew && pixel != NONE && BehindFrontier(pixel);
    state = waits ? WAITS : pixel != NONE ? CastRay(pixel, isNew) : DONE;
  }
  CloseWorkCounters();
#ifdef HAS_RAYS
  QueueRays(state, pixel);
#endif
}
