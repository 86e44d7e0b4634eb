// The normals of the hits that have come in (part of section 3.7), once a pixel. Central differences reach a voxel beyond
// the cell, also to the -x, -y and -z sides, where no ray may have asked for a block yet: such a hit asks, and waits.
// In: Hits, Rays, CacheMap, CacheValues. Out: Normals, Rays, CacheRequests, CacheMap, Macrocells, Control.

#define GROUP 64u

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#ifdef HAS_CACHE_MAP
#include "Requests.glsl"
#endif
#include "LiveRays.glsl"
#include "Normals.glsl"
#include "PackedNormal.glsl"

layout(local_size_x = 64) in; // GROUP

// True where the normal has to wait for blocks.
bool FindNormal(uint pixel)
{
  Ray ray = CameraRay(pixel);
  HitPoint hit = HitOf(ray, hits[pixel]);
  ivec3 first = FirstStencilBlock(hit.Cell);
  ivec3 reach = LastStencilBlock(hit.Cell) - first;
  uint missing = FindSlots(first, reach);
#ifdef HAS_CACHE_MAP
  for (uint bits = missing; bits != 0u; bits &= bits - 1u)
  {
    RequestBlock(first + SideOffset(findLSB(bits)));
  }
#endif
  if (missing != 0u)
  {
    return true;
  }
  UseBlocks(first, reach);
  normals[pixel] = PackNormal(ViewNormal(Gradient(hit), -normalize(EyeRayDirection(pixel))));
  return false;
}

#ifdef HAS_RAYS
shared uint groupUnlit;
shared uint groupBegin;

// The work group's hits that have to wait go to the list of the pass after, which is this pass's own until then.
void KeepUnlit(bool unlit, uint pixel)
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupUnlit = 0u;
  }
  barrier();
  uint at = 0u;
  if (unlit)
  {
    at = atomicAdd(groupUnlit, 1u);
    NoteLive(TileOrderOf(pixel));
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupUnlit > 0u)
  {
    groupBegin = atomicAdd(control.NextUnlit, groupUnlit);
  }
  barrier();
  if (unlit)
  {
    rays[ThisList(FromEnd(groupBegin + at))] = pixel;
  }
}

void main()
{
  OpenRequests();
  barrier();
  for (uint first = GROUP * gl_WorkGroupID.x; first < control.Unlit; first += GROUP * gl_NumWorkGroups.x)
  {
    uint index = first + gl_LocalInvocationIndex;
    uint pixel = NONE;
    bool unlit = false;
    if (index < control.Unlit)
    {
      pixel = rays[NextList(FromEnd(index))];
      unlit = BehindFrontier(pixel) || FindNormal(pixel);
    }
    KeepUnlit(unlit, pixel);
  }
  CloseRequests();
}
#else
void main()
{
  uint order = GROUP * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = order < PixelsInTiles() ? PixelInTileOrder(order) : NONE;
  if (pixel != NONE && hits[pixel] != NO_HIT)
  {
    FindNormal(pixel);
  }
}
#endif
