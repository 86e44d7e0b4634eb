// A pass over the wavefront of rays (sections 3.2, 3.3 and 3.7): every ray walks the macrocell grid to the blocks whose
// range holds the isovalue, in their order along the ray, and is intersected with them as long as they are in the cache.
// At the first that is not it waits for the next pass. So a ray tests no block behind its hit, and the first hit it
// finds is the nearest.
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

// Walks from `block` to the first hit; true where the ray has to wait for the block that it returns.
bool FindHit(Ray ray, inout ivec3 block, out Hit hit)
{
  hit = MISS;
  GridCursor at = OutsideGrid();
  while (FindActiveBlock(ray, block, at))
  {
    double entry = BlockEntry(ray, block);
    double end = BlockExit(ray, block);
    ivec3 reach = DualGridReach(ray, block, entry, end);
    if (FindSlots(block, reach) != 0u)
    {
      return true;
    }
    UseBlocks(block, reach);
    ++pairs;
    if (IntersectBlock(ray, block, entry, end, hit))
    {
      return false;
    }
    if (!NextBlock(ray, block))
    {
      return false;
    }
  }
  return false;
}

#define DONE 0u  // has left the volume, or needs nothing more
#define WAITS 1u // for blocks
#define HIT 2u   // has hit the surface in this pass

uint CastRay(uint pixel, bool fresh)
{
  Ray ray = CameraRay(pixel);
  if (!(ray.Enter <= ray.Leave))
  {
    return DONE;
  }
  atomicAdd(groupActive, 1u);
#ifdef HAS_RAYS
  ivec3 block = fresh ? FirstBlock(ray) : BlockCoordinates(rays[pixel]);
#else
  ivec3 block = FirstBlock(ray);
#endif
#ifdef TRANSLUCENT
  passed = HitOf(pixel);
#endif
  Hit hit;
  bool waits = FindHit(ray, block, hit);
  bool struck = hit.Key != NO_HIT;
  if (struck)
  {
    StoreHit(pixel, hit, float(HitT(ray, hit.Key)));
  }
#ifdef TRANSLUCENT
  bool goesOn = waits || struck;
#else
  bool goesOn = waits;
#endif
#ifdef HAS_RAYS
  if (goesOn)
  {
    rays[pixel] = BlockIndex(block);
  }
#endif
  return waits ? WAITS : struck ? HIT : DONE;
}

#ifdef HAS_RAYS
shared uint groupLive;
shared uint groupLiveBegin;
shared uint groupFirst;
shared uint groupHits;
shared uint groupHitsBegin;

// The work group's rays that wait go to the list for the next pass together, and so do its hits, for their normals.
void KeepRays(uint state, uint pixel)
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupLive = 0u;
    groupHits = 0u;
    groupFirst = NONE;
  }
  barrier();
  uint at = 0u;
  if (state == WAITS)
  {
    at = atomicAdd(groupLive, 1u);
    atomicMin(groupFirst, TileOrderOf(pixel));
  }
#ifdef HIT_LIST
  at = state == HIT ? atomicAdd(groupHits, 1u) : at;
#endif
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupLive > 0u)
  {
    groupLiveBegin = ReserveRays(groupLive, groupFirst);
  }
#ifdef HIT_LIST
  if (gl_LocalInvocationIndex == 0u && groupHits > 0u)
  {
    groupHitsBegin = ReserveUnlit(groupHits);
  }
#endif
  barrier();
  if (state == WAITS)
  {
    rays[NextList(groupLiveBegin + at)] = pixel;
  }
#ifdef HIT_LIST
  if (state == HIT)
  {
    rays[NextList(FromEnd(groupHitsBegin + at))] = pixel;
  }
#endif
}
#endif

void main()
{
  OpenGroup();
  barrier();
  uint index = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = NONE;
  uint state = DONE;
  if (index < control.Rays)
  {
#ifdef HAS_RAYS
    bool fresh = index >= BegunRays();
    pixel = fresh ? PixelInTileOrder(control.Fresh + index - BegunRays()) : BegunPixel(index);
    bool waits = !fresh && pixel != NONE && BehindFrontier(pixel);
#else
    bool fresh = true;
    pixel = PixelInTileOrder(index);
    bool waits = false;
#endif
    state = waits ? WAITS : pixel != NONE ? CastRay(pixel, fresh) : DONE;
  }
  CountWork();
#ifdef HAS_RAYS
  KeepRays(state, pixel);
#endif
}
