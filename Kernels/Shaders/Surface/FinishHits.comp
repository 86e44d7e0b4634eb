// Finishes the hits that have come in, once each: finds their normals, and if another volume gives
// the colours its value there. Hits of a translucent image are lit at once and blended with what
// lies before them, and their rays go on. Central differences reach a voxel beyond the cell, also
// to the -x, -y and -z sides, where no ray may have asked for a block yet: such a hit asks, and
// waits.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Shared/GroupAppend.glsl"
#include "Cache/UseBlocks.glsl"
#include "Rays/LevelSpans.glsl"
#include "Rays/RayQueues.glsl"
#include "Rays/Rays.glsl"
#include "Surface/Hits.glsl"
#include "Surface/Normals.glsl"
#ifdef TRANSLUCENT
#include "Light/Layers.glsl"
#include "Light/Shading.glsl"
#else
#include "Surface/PackedNormal.glsl"
#endif

// What becomes of a hit in this pass.
#define DONE 0u      // it needs nothing more
#define WAITS 1u     // for blocks
#define CONTINUES 2u // its ray does, behind it

#if defined(LIT) || defined(COLORED)
// What the surface is like at a hit.
struct Surface
{
  vec3 Gradient;
  float ColorValue;
};

// Of this level. Returns true if it has to wait for blocks.
bool SampleSurface(RayLine line, uint key, out Surface surface)
{
  SurfacePoint hit = PointOf(line, key);
  ivec3 first = BlockOf(FirstStencilSample(hit.Cell));
  ivec3 reach = BlockOf(LastStencilSample(hit.Cell)) - first;
  FindSlots(first, reach);
  if (LacksSlots())
  {
    for (uint bits = MissingSlots(); bits != 0u; bits &= bits - 1u)
    {
      RequestBlock(first + SideOffset(findLSB(bits)));
    }
    return true;
  }
  UseBlocks(first, reach);
#ifdef COLORED
  surface.ColorValue = ColorValue(hit);
#endif
#ifdef LIT
  surface.Gradient = Gradient(hit);
#endif
  return false;
}

#ifdef LEVELS
#ifdef COLORED
// The first where one has no value: infinity stands for it.
float BlendColors(float a, float b, float weight)
{
  return isinf(a) || isinf(b) ? a : mix(a, b, weight);
}
#endif

// Of the level of a pixel's hit, or the two that blend there.
bool SampleLevels(uint pixel, out Surface surface)
{
  RayLine line = LineOf(pixel);
  uint key = HitKeyOf(pixel);
  bool waits = false;
  float weight = EnterLevelAt(HitT(key));
#ifdef CONSERVATIVE
  if (HasLevelFlag(pixel))
  {
    level = 0;
    weight = 0.0;
  }
#endif
  int first = level;
  int last = level + (weight > 0.0 ? 1 : 0);
  for (; level <= last; ++level)
  {
    Surface other;
    waits = SampleSurface(line, key, other) || waits;
#ifdef LIT
    surface.Gradient =
      level == first ? other.Gradient : mix(surface.Gradient, other.Gradient, weight);
#endif
#ifdef COLORED
    surface.ColorValue = level == first ? other.ColorValue
                                        : BlendColors(surface.ColorValue, other.ColorValue, weight);
#endif
  }
  return waits;
}
#endif

// Finds the normal, and the colour's value. Returns true if they have to wait for blocks.
bool FindNormal(uint pixel, out vec3 normal)
{
  Surface surface;
#ifdef LEVELS
  bool waits = SampleLevels(pixel, surface);
#else
  bool waits = SampleSurface(LineOf(pixel), HitKeyOf(pixel), surface);
#endif
  if (waits)
  {
    return true;
  }
#ifdef COLORED
  StoreColorValue(pixel, surface.ColorValue);
#endif
#ifdef LIT
  normal = ViewNormal(surface.Gradient, -normalize(EyeRayDirection(pixel)));
#endif
  return false;
}
#endif

#ifdef TRANSLUCENT
uint FinishHit(uint pixel)
{
  vec3 normal = vec3(0.0);
#if defined(LIT) || defined(COLORED)
  if (FindNormal(pixel, normal))
  {
    return WAITS;
  }
#endif
  Hit hit = HitOf(pixel);
  vec4 color = Shade(pixel, DepthAt(HitT(hit.Key)), normal, hit.Isovalue);
  return AddLayer(pixel, color.xyz, color.w) ? CONTINUES : DONE;
}
#else
uint FinishHit(uint pixel)
{
  vec3 normal;
  bool waits = FindNormal(pixel, normal);
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
// Queues those of the work group's hits that have to wait, for the next pass.
void PostponeHits(bool waits, uint pixel)
{
  OpenGroupList(HITS);
  barrier();
  uint place = 0u;
  if (waits)
  {
    place = AddToGroupList(HITS);
    RecordFirstLive(TileOrderOf(pixel));
  }
  barrier();
  if (ReservesFor(HITS))
  {
    SetGroupListBegin(HITS, atomicAdd(control.PostponedHits, GroupListCount(HITS)));
  }
  barrier();
  if (waits)
  {
    StorePostponedHit(GroupListBegin(HITS) + place, pixel);
  }
}

#ifdef TRANSLUCENT
// Leaves only those in the queue of hits whose rays go on: the next pass takes them from there.
void ContinueRay(uint index, uint pixel, bool continues)
{
  if (continues)
  {
    atomicAdd(control.NextContinuingRays, 1u);
    RecordFirstLive(TileOrderOf(pixel));
  }
  else if (pixel != NONE)
  {
    StorePendingHit(index, NONE);
  }
}
#endif

void main()
{
  OpenRequests();
  barrier();
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x;
  for (uint first = GROUP_SIZE * gl_WorkGroupID.x; first < control.PendingHits; first += stride)
  {
    uint index = first + gl_LocalInvocationIndex;
    uint pixel = NONE;
    uint state = DONE;
    if (index < control.PendingHits)
    {
      pixel = PendingHit(index);
      state = BehindFrontier(pixel) ? WAITS : FinishHit(pixel);
    }
    PostponeHits(state == WAITS, pixel);
#ifdef TRANSLUCENT
    ContinueRay(index, pixel, state == CONTINUES);
#endif
  }
  CloseRequests();
}
#else
void main()
{
  uint order = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint pixel = order < PixelsInTiles() ? PixelInTileOrder(order) : NONE;
  if (pixel != NONE && HitKeyOf(pixel) != NO_HIT)
  {
    FinishHit(pixel);
  }
}
#endif
