// A pass over the wavefront of rays (sections 3.2 to 3.7 and 4). Every ray walks the macrocell grid to the blocks
// whose range holds the isovalue, in their order along the ray, and is intersected with them as long as they are in the
// cache. At the first that is not it stops: asks for it, looks ahead for up to N_spec - 1 more to ask for, and goes
// on in the next pass. So a ray tests no block behind its hit, and the first hit it finds is the nearest.
// In: Macrocells, CacheMap, CacheValues, Rays. Out: Hits, Normals, Rays, CacheRequests, Control.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "TraverseGrid.glsl"
#include "BlockMap.glsl"
#include "Intersection.glsl"
#include "BlockWalk.glsl"
#ifdef HAS_NORMALS
#include "Normals.glsl"
#include "PackedNormal.glsl"
#endif

layout(local_size_x = 64) in;

shared uint groupActive;
shared uint groupPairs;
shared uint groupTouched;
shared uint groupVisible;
shared uint groupNeeded;

uint pairs = 0u;

// Walks from `block` to the first hit; true where the ray has to wait for the block that it returns.
bool FindHit(Ray ray, inout ivec3 block, inout uint key)
{
  GridCursor at = OutsideGrid();
  bool waits = false;
#ifdef HAS_CACHE_MAP
  ivec3 stop = block;
  uint asked = 0u;
#endif
  while (FindActiveBlock(ray, block, at))
  {
    double entry = BlockEntry(ray, block);
    double end = BlockExit(ray, block);
    ivec3 reach = DualGridReach(ray, block, entry, end);
    uint missing = FindSlots(block, reach);
    if (!waits && missing == 0u)
    {
      UseBlocks(block, reach, true);
      ++pairs;
      double t;
      if (IntersectBlock(ray, block, entry, end, t))
      {
        key = HitKey(ray, t);
        return false;
      }
    }
#ifdef HAS_CACHE_MAP
    else
    {
      stop = waits ? stop : block;
      waits = true;
      RequestBlocks(block, missing);
      if (++asked >= control.Speculation)
      {
        break;
      }
    }
#endif
    if (!NextBlock(ray, block))
    {
      break;
    }
  }
#ifdef HAS_CACHE_MAP
  block = stop;
#endif
  return waits;
}

#ifdef HAS_NORMALS
// True where the normal has to wait for blocks.
bool FindNormal(Ray ray, uint pixel, uint key)
{
  HitPoint hit = HitOf(ray, key);
  ivec3 first = FirstStencilBlock(hit.Cell);
  ivec3 reach = LastStencilBlock(hit.Cell) - first;
  uint missing = FindSlots(first, reach);
#ifdef HAS_CACHE_MAP
  if (missing != 0u)
  {
    RequestBlocks(first, missing);
    return true;
  }
#endif
  UseBlocks(first, reach, false);
  normals[pixel] = PackNormal(ViewNormal(Gradient(hit), -normalize(EyeRayDirection(pixel))));
  return false;
}
#endif

// True where the ray has to go on in the next pass.
bool CastRay(uint pixel, bool fresh)
{
  Ray ray = CameraRay(pixel);
  if (!(ray.Enter <= ray.Leave))
  {
    return false;
  }
  atomicAdd(groupActive, 1u);
  uint key = fresh ? NO_HIT : hits[pixel];
  if (key == NO_HIT)
  {
#ifdef HAS_RAYS
    ivec3 block = fresh ? FirstBlock(ray) : BlockCoordinates(rays[pixel]);
#else
    ivec3 block = FirstBlock(ray);
#endif
    bool waits = FindHit(ray, block, key);
#ifdef HAS_RAYS
    if (waits)
    {
      rays[pixel] = BlockIndex(block);
      return true;
    }
#endif
    if (key == NO_HIT)
    {
      return false;
    }
    hits[pixel] = key;
  }
#ifdef HAS_NORMALS
  return FindNormal(ray, pixel, key);
#else
  return false;
#endif
}

#ifdef HAS_RAYS
shared uint groupLive;
shared uint groupBegin;
shared uint groupFirst;

// Pixel of a ray of this pass; `fresh`: it begins now.
uint RayAt(uint index, out bool fresh)
{
  fresh = index >= control.Carried;
  uint pixels = uint(scene.Image.x * scene.Image.y);
  return fresh ? PixelInTileOrder(control.Fresh + index - control.Carried)
               : rays[pixels * (1u + control.List) + index];
}

bool BehindFrontier(uint pixel)
{
  return control.Frontier < PixelsInTiles() && TileOrderOf(pixel) >= control.Frontier;
}

// The work group's live rays go to the list for the next pass together.
void KeepRays(bool live, uint pixel)
{
  uint at = live ? atomicAdd(groupLive, 1u) : 0u;
  if (live && control.Window < PixelsInTiles())
  {
    atomicMin(groupFirst, TileOrderOf(pixel));
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupLive > 0u)
  {
    groupBegin = atomicAdd(control.NextCarried, groupLive);
    atomicMin(control.FirstLive, groupFirst);
  }
  barrier();
  if (live)
  {
    uint pixels = uint(scene.Image.x * scene.Image.y);
    rays[pixels * (2u - control.List) + groupBegin + at] = pixel;
  }
}
#endif

void OpenGroup()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActive = 0u;
    groupPairs = 0u;
    groupTouched = 0u;
    groupVisible = 0u;
    groupNeeded = 0u;
#ifdef HAS_RAYS
    groupLive = 0u;
    groupFirst = NONE;
#endif
#ifdef HAS_CACHE_MAP
    stagedCount = 0u;
#endif
  }
  barrier();
}

void CountWork()
{
  atomicAdd(groupPairs, pairs);
#ifdef HAS_CACHE_MAP
  atomicAdd(groupTouched, touchedSlots);
#endif
#ifdef HAS_CACHE_SEEN
  atomicAdd(groupVisible, visibleBlocks);
  atomicAdd(groupNeeded, activeBlocks);
#endif
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupActive > 0u)
  {
    atomicAdd(control.ActiveRays, groupActive);
    atomicAdd(control.Pairs, groupPairs);
#ifdef HAS_CACHE_MAP
    atomicAdd(control.TouchedSlots, groupTouched);
#endif
#ifdef HAS_CACHE_SEEN
    atomicAdd(control.VisibleBlocks, groupVisible);
    atomicAdd(control.ActiveBlocks, groupNeeded);
#endif
  }
}

void main()
{
  OpenGroup();
  uint index = 64u * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = NONE;
  bool live = false;
  if (index < control.Rays)
  {
#ifdef HAS_RAYS
    bool fresh;
    pixel = RayAt(index, fresh);
    live = !fresh && BehindFrontier(pixel) || pixel != NONE && CastRay(pixel, fresh);
#else
    pixel = PixelInTileOrder(index);
    live = pixel != NONE && CastRay(pixel, true);
#endif
  }
  CountWork();
#ifdef HAS_RAYS
  KeepRays(live, pixel);
#endif
#ifdef HAS_CACHE_MAP
  FlushRequests();
#endif
}
