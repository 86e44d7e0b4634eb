// Walks a ray through the cells of one block, after Amanatides and Woo, to its first hit.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/SlotLayout.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Store/HiddenCells.glsl"
#include "Surface/Hits.glsl"
#include "Surface/Intersection.glsl"
#include BLOCK_ACCESS

// Cell of the block in which the ray is at parameter t: it has crossed all planes up to t.
ivec3 CellAt(Ray ray, ivec3 block, double t)
{
  ivec3 entry = EntryPlanes(ray, block, BLOCK_SIDE);
  ivec3 crossed = ivec3(0);
  for (int i = 1; i < BLOCK_SIDE; ++i)
  {
    crossed += ivec3(lessThanEqual(PlanesT(ray, entry + i * ray.Step), dvec3(t)));
  }
  return entry - (1 - ray.Step) / 2 + crossed * ray.Step;
}

vec4 LoadSamples(uvec4 at)
{
  uvec4 bits = uvec4(cacheValues[at.x], cacheValues[at.y], cacheValues[at.z], cacheValues[at.w]);
  return uintBitsToFloat(bits);
}

// The values' excess over an isovalue, in sixteenths: a power of two changes no other bit, and
// nothing overflows that a root is found by.
vec4 Excess(vec4 values, int isovalue)
{
  vec2 level = 0.0625 * vec2(view.Isovalues[isovalue].High, view.Isovalues[isovalue].Low);
  precise vec4 excess = (0.0625 * values - level.x) - level.y;
  return excess;
}

Corners Excess(Corners values, int isovalue)
{
  return Corners(Excess(values.Low, isovalue), Excess(values.High, isovalue));
}

// With several isovalues the samples themselves, else what they are above the isovalue.
Corners LoadCorners(ivec3 cell)
{
  uvec4 low, high;
  FindCorners(cell, low, high);
  Corners values = Corners(LoadSamples(low), LoadSamples(high));
#ifdef SEVERAL_ISOVALUES
  return values;
#else
  return Excess(values, 0);
#endif
}

// Does an isosurface cross the cell?
bool HoldsSurface(Corners w)
{
#ifdef SEVERAL_ISOVALUES
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (StraddlesZero(Excess(w, i)))
    {
      return true;
    }
  }
  return false;
#else
  return StraddlesZero(w);
#endif
}

// Which cells of a block are hidden. Its slot is the first of those that were found last.
uvec2 HiddenCellsOf(ivec3 block)
{
#ifdef HAS_HIDDEN_CELLS
  return HiddenInSlot(FoundSlot(block, block));
#else
  return uvec2(0u);
#endif
}

bool IsVisible(uvec2 hidden, ivec3 cell)
{
#ifdef HAS_HIDDEN_CELLS
  return !Hides(hidden, cell);
#else
  return true;
#endif
}

// Coordinates in the cell's unit cube at parameter t; exact on the faces that the ray is crossing.
vec3 LocalCoordinates(Ray ray, ivec3 cell, double t, bvec3 onFace, bool leaving)
{
  precise dvec3 p = ray.Origin + t * ray.Direction - dvec3(cell);
  vec3 u = clamp(vec3(p), vec3(0.0), vec3(1.0));
  vec3 face = vec3((leaving ? 1 + ray.Step : 1 - ray.Step) / 2);
  return mix(u, face, onFace);
}

double HitBetween(double t0, double t1, float s)
{
  precise double t = t0 + double(s) * (t1 - t0);
  return t;
}

// Hits have an order along the ray: by their keys, and of one key by their isovalues.
bool Before(Hit a, Hit b)
{
  return a.Key < b.Key || (a.Key == b.Key && a.Isovalue < b.Isovalue);
}

#ifdef TRANSLUCENT
Hit lastHit = MISS; // that the ray has left behind
#endif

// Makes a ray go on behind the last hit of its pixel. Call before any IntersectBlock.
void PassLastHit(uint pixel)
{
#ifdef TRANSLUCENT
  lastHit = HitOf(pixel);
#endif
}

#ifdef MANY_CROSSINGS
// A crossing is no hit if it lies in a region that is not drawn, or not behind the last hit.
Hit Crossing(Ray ray, double t0, double t1, float s, int isovalue)
{
  double t = HitBetween(t0, t1, s);
  Hit hit = Hit(HitKey(ray, t), isovalue);
  bool counts = s >= 0.0;
#ifdef TRANSLUCENT
  counts = counts && (lastHit.Key == NO_HIT || Before(lastHit, hit));
#endif
#ifdef CROPPED
  counts = counts && IsRegionDrawn(CroppingRegion(ray.Origin + t * ray.Direction));
#endif
  return counts ? hit : MISS;
}
#endif

// First hit of a surface between parameters t0 and t1, along which the interpolant is this cubic.
Hit FirstHit(Ray ray, vec4 cubic, double t0, double t1, int isovalue)
{
#ifdef MANY_CROSSINGS
  vec3 s = Transitions(cubic);
  Hit hit = Crossing(ray, t0, t1, s.x, isovalue);
  hit = hit.Key == NO_HIT ? Crossing(ray, t0, t1, s.y, isovalue) : hit;
  return hit.Key == NO_HIT ? Crossing(ray, t0, t1, s.z, isovalue) : hit;
#else
  float s = FirstTransition(cubic);
  return s >= 0.0 ? Hit(HitKey(ray, HitBetween(t0, t1, s)), isovalue) : MISS;
#endif
}

// First hit of the ray in the cell between parameters t0 and t1; false if there is none.
bool IntersectCell(Ray ray, ivec3 cell, Corners w, double t0, double t1, dvec3 exits, out Hit hit)
{
  bvec3 entering = equal(PlanesT(ray, EntryPlanes(ray, cell, 1)), dvec3(t0));
  bvec3 leaving = equal(exits, dvec3(t1));
  vec3 u0 = LocalCoordinates(ray, cell, t0, entering, false);
  vec3 u1 = LocalCoordinates(ray, cell, t1, leaving, true);
#ifdef SEVERAL_ISOVALUES
  hit = MISS;
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    Hit other = FirstHit(ray, CubicAlong(Excess(w, i), u0, u1), t0, t1, i);
    hit = Before(other, hit) ? other : hit;
  }
#else
  hit = FirstHit(ray, CubicAlong(w, u0, u1), t0, t1, 0);
#endif
  return hit.Key != NO_HIT;
}

// First hit of the ray in the block between parameters t0 and end; false if there is none. The walk
// to the next cell that the surface crosses is a loop of its own, so that the lanes of a group meet
// again for the costly part.
bool IntersectBlock(Ray ray, ivec3 block, double t0, double end, out Hit hit)
{
  hit = MISS;
  ivec3 cell = CellAt(ray, block, t0);
  uvec2 hidden = HiddenCellsOf(block);
  for (int tested = 0; tested < 16; ++tested) // a ray crosses at most 10 cells of 4^3
  {
    Corners w;
    dvec3 exits;
    double t1;
    bool crossed = false;
    for (int walked = 0; walked < 16; ++walked)
    {
      exits = PlanesT(ray, ExitPlanes(ray, cell, 1));
      t1 = min(SmallestOf(exits), end);
      w = LoadCorners(cell);
      crossed = HoldsSurface(w) && IsVisible(hidden, cell);
      if (crossed || t1 >= end)
      {
        break;
      }
      cell += ivec3(lessThanEqual(exits, dvec3(t1))) * ray.Step;
      t0 = t1;
    }
    if (crossed && IntersectCell(ray, cell, w, t0, t1, exits, hit))
    {
      return true;
    }
    if (!crossed || t1 >= end)
    {
      return false;
    }
    cell += ivec3(lessThanEqual(exits, dvec3(t1))) * ray.Step;
    t0 = t1;
  }
  return false;
}
