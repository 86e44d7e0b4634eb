// Casts the last rays of an image, like CastRays but a ray a work group: its lanes take the next
// blocks along the ray, one each, so that they need not wait for each other's blocks.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
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

// Gives lane i the i-th active block from `block` on, if there is one; false for the lanes behind
// the last. The whole group walks together, and `inside` tells whether there is more.
bool TakeBlock(Ray ray, inout ivec3 block, inout GridCursor at, inout bool inside, out ivec3 taken)
{
  bool took = false;
  taken = block;
  for (uint i = 0u; i < GROUP_SIZE && inside; ++i)
  {
    inside = FindActiveBlock(ray, block, at);
    if (inside && i == gl_LocalInvocationIndex)
    {
      taken = block;
      took = true;
    }
    inside = inside && NextBlock(ray, block);
  }
  return took;
}

// By the lane that has the hit.
void KeepHit(Ray ray, uint pixel, ivec3 block, Hit hit)
{
  StoreHit(pixel, hit, DepthAt(HitT(hit.Key)));
  if (RAYS_CONTINUE)
  {
    StoreBlockOfRay(pixel, BlockIndex(block));
  }
#ifdef HAS_PENDING_HITS
  StorePendingHit(ReservePendingHits(1u), pixel);
#endif
}

// True if the ray has to go on in the next pass.
bool CastRay(uint pixel)
{
  uint lane = gl_LocalInvocationIndex;
  Ray ray = CameraRay(pixel);
  ivec3 next = BlockCoordinates(BlockOfRay(pixel));
  PassLastHit(pixel);
  GridCursor at = OutsideGrid();
  bool inside = true;
  while (inside)
  {
    ivec3 block;
    bool took = TakeBlock(ray, next, at, inside, block);
    BlockVisit visit = PlanVisit(ray, block);
    if (took && LacksBlocks(block, visit))
    {
      atomicMin(firstMissing, lane);
    }
    barrier();
    Hit hit = MISS;
    if (took && lane < firstMissing && VisitBlock(ray, block, visit, hit))
    {
      atomicMin(firstHit, lane);
    }
    barrier();
    if (firstHit == lane)
    {
      KeepHit(ray, pixel, block, hit);
    }
    else if (firstHit == GROUP_SIZE && firstMissing == lane)
    {
      StoreBlockOfRay(pixel, BlockIndex(block));
    }
    if (firstHit < GROUP_SIZE || firstMissing < GROUP_SIZE)
    {
      return firstHit == GROUP_SIZE;
    }
    barrier(); // all have read the first lanes before any finds others
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
  bool behind = BehindFrontier(pixel);
  bool live = behind || CastRay(pixel);
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActiveRays = behind ? 0u : 1u;
    if (live)
    {
      StoreNextRay(ReserveNextRays(1u, TileOrderOf(pixel)), pixel);
    }
  }
  barrier();
  CloseWorkCounters();
}
