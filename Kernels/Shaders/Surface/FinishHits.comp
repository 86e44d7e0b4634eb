// The normals of the hits that have come in (part of section 3.7), once a hit. Of a translucent image the hit is lit at
// once and blended with what lies before it, and its ray goes on. Where another volume gives the colours, its value at
// the hit is found as well. Central differences reach a voxel beyond the cell, also to the -x, -y and -z sides, where no
// ray may have asked for a block yet: such a hit asks, and waits.
// In: Hits, Rays, CacheMap, CacheValues. Out: Hits, Normals or Layers, Rays, CacheRequests, CacheMap, Macrocells, Control.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Shared/Grid.glsl"
#include "Cache/BlockMap.glsl"
#ifdef HAS_CACHE_MAP
#include "Cache/Requests.glsl"
#endif
#include "Rays/RayQueues.glsl"
#include "Surface/Normals.glsl"
#ifdef TRANSLUCENT
#include "Light/Shading.glsl"
#include "Light/Layers.glsl"
#else
#include "Surface/PackedNormal.glsl"
#endif

#if defined(LIT) || defined(COLORED)
// True where the normal, or the colour, has to wait for blocks.
bool FindNormal(Ray ray, uint pixel, out vec3 normal)
{
  SurfacePoint hit = PointOf(ray, hits[pixel]);
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
#ifdef COLORED
  StoreColorValue(pixel, ColorValue(hit));
#endif
#ifdef LIT
  normal = ViewNormal(Gradient(hit), -normalize(EyeRayDirection(pixel)));
#endif
  return false;
}
#endif

#define DONE 0u    // needs nothing more
#define WAITS 1u   // for blocks
#define GOES_ON 2u // the ray does, behind this hit

#ifdef TRANSLUCENT
uint Finish(uint pixel)
{
  vec3 normal = vec3(0.0);
  Ray ray = CameraRay(pixel);
#if defined(LIT) || defined(COLORED)
  if (FindNormal(ray, pixel, normal))
  {
    return WAITS;
  }
#endif
  Hit hit = HitOf(pixel);
  vec3 color = Shade(pixel, float(HitT(ray, hit.Key)), normal, hit.Isovalue);
  return AddLayer(pixel, color, look.Colors[hit.Isovalue].Opacity) ? GOES_ON : DONE;
}
#else
uint Finish(uint pixel)
{
  vec3 normal;
  bool waits = FindNormal(CameraRay(pixel), pixel, normal);
#ifdef HAS_NORMALS
  if (!waits)
  {
    normals[pixel] = PackNormal(normal);
  }
#endif
  return waits ? WAITS : DONE;
}
#endif

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

#ifdef TRANSLUCENT
// In the list of hits only those stay whose rays go on; the next pass takes them from there.
void KeepGoing(uint index, uint pixel, bool goesOn)
{
  if (goesOn)
  {
    atomicAdd(control.GoingOn, 1u);
    NoteLive(TileOrderOf(pixel));
  }
  else if (pixel != NONE)
  {
    rays[NextList(FromEnd(index))] = NONE;
  }
}
#endif

void main()
{
#ifdef HAS_CACHE_MAP
  OpenRequests();
#endif
  barrier();
  for (uint first = GROUP_SIZE * gl_WorkGroupID.x; first < control.Unlit; first += GROUP_SIZE * gl_NumWorkGroups.x)
  {
    uint index = first + gl_LocalInvocationIndex;
    uint pixel = NONE;
    uint state = DONE;
    if (index < control.Unlit)
    {
      pixel = rays[NextList(FromEnd(index))];
      state = BehindFrontier(pixel) ? WAITS : Finish(pixel);
    }
    KeepUnlit(state == WAITS, pixel);
#ifdef TRANSLUCENT
    KeepGoing(index, pixel, state == GOES_ON);
#endif
  }
#ifdef HAS_CACHE_MAP
  CloseRequests();
#endif
}
#else
void main()
{
  uint order = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = order < PixelsInTiles() ? PixelInTileOrder(order) : NONE;
  if (pixel != NONE && hits[pixel] != NO_HIT)
  {
    Finish(pixel);
  }
}
#endif
