// CastRays for the last rays of an image: a work group a ray, whose lanes take the next blocks along it, one each. The
// slots of the rays that are done serve those that are left (section 4).
// In: Macrocells, CacheMap, CacheValues, Rays. Out: Hits, Rays, CacheMap (stamps), Control.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Shared/Grid.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Cache/BlockMap.glsl"
#include "Surface/Intersection.glsl"
#include "Rays/BlockReach.glsl"
#include "Surface/IntersectBlock.glsl"
#include "Rays/RayQueues.glsl"

shared uint firstMissing; // lane whose block is not in the cache, the first along the ray; GROUP_SIZE: none
shared uint firstHit;     // likewise, whose block is hit

// Lane i takes the i-th active block from `block` on, if there is one; false for the lanes behind the last. The whole
// group walks together, and `inside` tells whether there is more.
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

// True where the ray has to go on in the next pass.
bool CastRay(uint pixel)
{
  uint lane = gl_LocalInvocationIndex;
  Ray ray = CameraRay(pixel);
  ivec3 next = BlockCoordinates(rays[pixel]);
#ifdef TRANSLUCENT
  passed = HitOf(pixel);
#endif
  GridCursor at = OutsideGrid();
  bool inside = true;
  while (inside)
  {
    ivec3 block;
    bool took = TakeBlock(ray, next, at, inside, block);
    double entry = BlockEntry(ray, block);
    double end = BlockExit(ray, block);
    ivec3 reach = DualGridReach(ray, block, entry, end);
    if (took && FindSlots(block, reach) != 0u)
    {
      atomicMin(firstMissing, lane);
    }
    barrier();
    Hit hit = MISS;
    if (took && lane < firstMissing)
    {
      UseBlocks(block, reach);
      ++pairs;
      if (IntersectBlock(ray, block, entry, end, hit))
      {
        atomicMin(firstHit, lane);
      }
    }
    barrier();
    if (firstHit == lane)
    {
      StoreHit(pixel, hit, float(HitT(ray, hit.Key)));
#ifdef TRANSLUCENT
      rays[pixel] = BlockIndex(block);
#endif
#ifdef HIT_LIST
      rays[NextList(FromEnd(ReserveUnlit(1u)))] = pixel;
#endif
    }
    else if (firstHit == GROUP_SIZE && firstMissing == lane)
    {
      rays[pixel] = BlockIndex(block);
    }
    if (firstHit < GROUP_SIZE || firstMissing < GROUP_SIZE)
    {
      return firstHit == GROUP_SIZE;
    }
  }
  return false;
}

void main()
{
  OpenGroup();
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
  uint pixel = BegunPixel(index);
  if (pixel == NONE)
  {
    return;
  }
  bool behind = BehindFrontier(pixel);
  bool live = behind || CastRay(pixel);
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActive = behind ? 0u : 1u;
    if (live)
    {
      rays[NextList(ReserveRays(1u, TileOrderOf(pixel)))] = pixel;
    }
  }
  barrier();
  CountWork();
}
