// The walk of a ray through the cells of one block (section 3.7), after Amanatides and Woo.

// Cell of the block in which the ray is at parameter t: every plane with a smaller or equal one is crossed.
ivec3 CellAt(Ray ray, ivec3 block, double t)
{
  ivec3 entry = EntryPlanes(ray, block, 4);
  ivec3 crossed = ivec3(0);
  for (int i = 1; i < 4; ++i)
  {
    crossed += ivec3(lessThanEqual(PlanesT(ray, entry + i * ray.Step), dvec3(t)));
  }
  return entry - (1 - ray.Step) / 2 + crossed * ray.Step;
}

#ifdef HAS_HIDDEN_CELLS
#include "Store/HiddenCells.glsl"
#endif

vec4 LoadSamples(uvec4 at)
{
  return uintBitsToFloat(uvec4(cacheValues[at.x], cacheValues[at.y], cacheValues[at.z], cacheValues[at.w]));
}

// In sixteenths: nothing overflows that is made of it on the way to a root, and a power of two changes no other bit.
vec4 Excess(vec4 values, int surface)
{
  vec2 isovalue = 0.0625 * vec2(view.Isovalues[surface].High, view.Isovalues[surface].Low);
  precise vec4 excess = (0.0625 * values - isovalue.x) - isovalue.y;
  return excess;
}

Corners Excess(Corners values, int surface)
{
  return Corners(Excess(values.Low, surface), Excess(values.High, surface));
}

// Where the corners of a cell are, on its lower and its upper z face, x fastest; with a cache, of a cell of the block
// whose slots were found last.
void FindCorners(ivec3 cell, out uvec4 low, out uvec4 high)
{
  uvec3 near = SampleOffsets(cell);
  uvec3 far = NextOffsets(cell, near);
  low = uvec4(near.x, far.x, near.x, far.x) + uvec4(near.y, near.y, far.y, far.y);
  high = low + far.z;
  low += near.z;
#ifdef HAS_CACHE_MAP
  bvec3 last = equal(cell & 3, ivec3(3)); // the far corners lie in the next block
  uvec4 upper = last.z ? highSlots : lowSlots;
  uvec4 lowRows = last.y ? lowSlots : lowSlots.xyxy;
  uvec4 highRows = last.y ? upper : upper.xyxy;
  low += 64u * (last.x ? lowRows : lowRows.xxzz);
  high += 64u * (last.x ? highRows : highRows.xxzz);
#endif
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

// What is hidden of a block, whose slots, with a cache, were found last.
uvec2 HiddenCellsOf(ivec3 block)
{
#ifdef HAS_HIDDEN_CELLS
#ifdef HAS_CACHE_MAP
  return HiddenInSlot(lowSlots.x);
#else
  return HiddenInSlot(BlockIndex(block));
#endif
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

// Hits have an order along the ray: by their keys, and of one key by their surfaces.
bool Before(Hit a, Hit b)
{
  return a.Key < b.Key || (a.Key == b.Key && a.Isovalue < b.Isovalue);
}

#ifdef MANY_CROSSINGS
Hit passed = MISS; // the hit that the ray has left behind

// Not every crossing is a hit: it may lie in a region that is not drawn, or not be behind the last one.
Hit Crossing(Ray ray, double t0, double t1, float s, int surface)
{
  double t = HitBetween(t0, t1, s);
  Hit hit = Hit(HitKey(ray, t), surface);
  bool counts = s >= 0.0;
#ifdef TRANSLUCENT
  counts = counts && (passed.Key == NO_HIT || Before(passed, hit));
#endif
#ifdef CROPPED
  counts = counts && IsRegionDrawn(CroppingRegion(ray.Origin + t * ray.Direction));
#endif
  return counts ? hit : MISS;
}
#endif

// First hit of a surface between parameters t0 and t1, along which the interpolant is this cubic.
Hit FirstHit(Ray ray, vec4 cubic, double t0, double t1, int surface)
{
#ifdef MANY_CROSSINGS
  vec3 s = Transitions(cubic);
  Hit hit = Crossing(ray, t0, t1, s.x, surface);
  hit = hit.Key == NO_HIT ? Crossing(ray, t0, t1, s.y, surface) : hit;
  return hit.Key == NO_HIT ? Crossing(ray, t0, t1, s.z, surface) : hit;
#else
  float s = FirstTransition(cubic);
  return s >= 0.0 ? Hit(HitKey(ray, HitBetween(t0, t1, s)), surface) : MISS;
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

// First hit of the ray in the block between parameters t0 and end; false if there is none. The walk to the next
// cell that the surface crosses is a loop of its own, so that the lanes of a group meet again for the costly part.
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
    for (int passed = 0; passed < 16; ++passed)
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
