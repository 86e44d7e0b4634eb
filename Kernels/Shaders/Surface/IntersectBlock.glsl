// Walks a ray through the cells of one block, after Amanatides and Woo, to its first hit.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/SlotLayout.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/LevelStretches.glsl"
#include "Store/HiddenCells.glsl"
#include "Surface/Excess.glsl"
#include "Surface/Hits.glsl"
#include "Surface/Intersection.glsl"
#include BLOCK_ACCESS

vec4 LoadSamples(uvec4 at)
{
  uvec4 bits = uvec4(cacheValues[at.x], cacheValues[at.y], cacheValues[at.z], cacheValues[at.w]);
  return uintBitsToFloat(bits);
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

// What is known of a block's cells, a bit each: where all is decoded, which the surface crosses;
// else which are hidden.
uvec2 KnownCells(ivec3 block)
{
#ifdef HAS_CELL_MARKS
  return cellMarks[BlockIndex(block)];
#elif defined(HAS_HIDDEN_CELLS)
  return HiddenInSlot(FoundSlot(block, block)); // of the slots that were found last
#else
  return uvec2(0u);
#endif
}

#ifdef LEVELS
// Of the next level, where it blends in: its slots are aside.
void TakeNextLevel()
{
  ++level;
  ExchangeSlots();
}

void TakeBackLevel()
{
  ExchangeSlots();
  --level;
}

uvec2 HiddenCellsOf(ivec3 block)
{
#ifdef HAS_HIDDEN_CELLS
  return HiddenInSlot(FoundSlot(block, block));
#else
  return uvec2(0u);
#endif
}

// Where two levels blend: the hidden cells of a block, and of the coarse block that holds it.
struct BlendedCells
{
  ivec3 Halved;
  uvec2 Hidden;
  uvec2 CoarseHidden;
};

BlendedCells FindBlendedCells(ivec3 block)
{
  BlendedCells cells;
  cells.Halved = HalvedByNext();
  cells.Hidden = HiddenCellsOf(block);
  TakeNextLevel();
  cells.CoarseHidden = HiddenCellsOf(block >> cells.Halved);
  TakeBackLevel();
  return cells;
}

Corners LoadCoarseCorners(ivec3 coarseCell)
{
  TakeNextLevel();
  Corners values = LoadCorners(coarseCell);
  TakeBackLevel();
  return values;
}

bool AreOnBothSides(Corners w, Corners v)
{
  return StraddlesZero(w) || StraddlesZero(v) || Inside(w.Low.x) != Inside(v.Low.x);
}

// Does a surface of the blend cross the cell?
bool BlendHoldsSurface(Corners w, Corners v)
{
#ifdef SEVERAL_ISOVALUES
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (AreOnBothSides(Excess(w, i), Excess(v, i)))
    {
      return true;
    }
  }
  return false;
#else
  return AreOnBothSides(w, v);
#endif
}

bool BlendMayHit(BlendedCells cells, ivec3 cell, inout Corners w, inout Corners v)
{
  ivec3 coarse = cell >> cells.Halved;
  w = LoadCorners(cell);
  v = LoadCoarseCorners(coarse);
  return BlendHoldsSurface(w, v) && !HoldsCell(cells.Hidden, cell) &&
    !HoldsCell(cells.CoarseHidden, coarse);
}
#endif

// May a ray hit a surface in the cell? Samples that are loaded to find out are kept in `w`.
bool MayHit(uvec2 known, ivec3 cell, inout Corners w)
{
#ifdef HAS_CELL_MARKS
  return HoldsCell(known, cell);
#else
  w = LoadCorners(cell);
  return HoldsSurface(w) && !HoldsCell(known, cell);
#endif
}

// Of the cell that was found last.
Corners CornersOf(ivec3 cell, Corners w)
{
#ifdef HAS_CELL_MARKS
  return LoadCorners(cell);
#else
  return w;
#endif
}

// Where a ray is among the cells: the cell, and parameters of the planes through which it leaves
// that.
struct CellPlace
{
  ivec3 Cell;
  Wide3 Exits;
};

// A ray's way through a cell: between parameters, and places in the cell's unit cube.
struct CellPath
{
  ivec3 Cell;
  Wide T0, T1;
  vec3 U0, U1;
#ifdef LEVELS
  bool Blends; // with the next level: places in its coarse cell, and its weights at both ends
  vec3 V0, V1;
  float Weight0, Weight1;
#endif
};

// The place in a cell at parameter t, in the direction of the ray: from the planes through which it
// has entered the cell, or on the axes on which it has not left its first cell from its beginning.
vec3 PlaceAlong(Ray ray, Wide3 entries, Wide t)
{
  vec3 sinceEntry = ToFloat(Difference(AllOf(t), entries)) * ray.CellsPerT;
  vec3 sinceBegin = ray.Begin + ToFloat(Difference(t, ray.Enter)) * ray.CellsPerT;
  bvec3 inFirst = AreLess(entries, AllOf(ray.Enter));
  return clamp(mix(sinceEntry, sinceBegin, inFirst), 0.0, 1.0);
}

// From t0 to t1, which both lie in the cell; exact on the faces that the ray crosses there.
CellPath PathThrough(Ray ray, CellPlace at, Wide t0, Wide t1)
{
  Wide3 entries = Difference(at.Exits, ray.Spacing);
  vec3 u0 = mix(PlaceAlong(ray, entries, t0), vec3(0.0), AreEqual(entries, t0));
  vec3 u1 = mix(PlaceAlong(ray, entries, t1), vec3(1.0), AreEqual(at.Exits, t1));
  bvec3 backwards = lessThan(ray.Step, ivec3(0));
  CellPath path;
  path.Cell = at.Cell;
  path.T0 = t0;
  path.T1 = t1;
  path.U0 = mix(u0, 1.0 - u0, backwards);
  path.U1 = mix(u1, 1.0 - u1, backwards);
#ifdef LEVELS
  path.Blends = false;
#endif
  return path;
}

#ifdef LEVELS
// The same in both levels where they blend. `coarse`: the ray in the next.
CellPath BlendedPath(Ray ray, Ray coarse, CellPlace at, Wide t0, Wide t1)
{
  CellPlace next;
  next.Cell = at.Cell >> HalvedByNext();
  next.Exits = PlanesT(coarse, ExitPlanes(coarse, next.Cell, 1));
  CellPath other = PathThrough(coarse, next, t0, t1);
  CellPath path = PathThrough(ray, at, t0, t1);
  path.Blends = true;
  path.V0 = other.U0;
  path.V1 = other.U1;
  path.Weight0 = WeightAt(t0);
  path.Weight1 = WeightAt(t1);
  return path;
}
#endif

Wide HitBetween(CellPath path, float s)
{
  return Sum(path.T0, ToWide(s * ToFloat(Difference(path.T1, path.T0))));
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
Hit Crossing(CellPath path, float s, int isovalue)
{
  Hit hit = Hit(HitKey(HitBetween(path, s)), isovalue);
  bool counts = s >= 0.0;
#ifdef TRANSLUCENT
  counts = counts && (lastHit.Key == NO_HIT || Before(lastHit, hit));
#endif
#ifdef CROPPED
  counts = counts && IsRegionDrawn(RegionOf(path.Cell, mix(path.U0, path.U1, s)));
#endif
  return counts ? hit : MISS;
}
#endif

// First hit of a surface on the path, along which the interpolant is this cubic.
Hit FirstHit(CellPath path, vec4 cubic, int isovalue)
{
#ifdef MANY_CROSSINGS
  vec3 s = Transitions(cubic);
  Hit hit = Crossing(path, s.x, isovalue);
  hit = hit.Key == NO_HIT ? Crossing(path, s.y, isovalue) : hit;
  return hit.Key == NO_HIT ? Crossing(path, s.z, isovalue) : hit;
#else
  float s = FirstTransition(cubic);
  return s >= 0.0 ? Hit(HitKey(HitBetween(path, s)), isovalue) : MISS;
#endif
}

// The interpolant along the path, from the corners' excess over an isovalue. Where two levels blend
// the coefficients do: exactly those of one level where the other has no weight.
vec4 ProfileOf(CellPath path, Corners w, Corners v)
{
  vec4 cubic = CubicAlong(w, path.U0, path.U1);
#ifdef LEVELS
  if (path.Blends)
  {
    vec4 coarse = CubicAlong(v, path.V0, path.V1);
    const vec4 thirds = vec4(0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0);
    precise vec4 weight = path.Weight0 * (1.0 - thirds) + path.Weight1 * thirds;
    precise vec4 blend = cubic * (1.0 - weight) + coarse * weight;
    return blend;
  }
#endif
  return cubic;
}

// First hit on the path; false if there is none. `v`: samples of the next level, where it blends
// in.
bool IntersectCell(CellPath path, Corners w, Corners v, out Hit hit)
{
#ifdef SEVERAL_ISOVALUES
  hit = MISS;
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    Hit other = FirstHit(path, ProfileOf(path, Excess(w, i), Excess(v, i)), i);
    hit = Before(other, hit) ? other : hit;
  }
#else
  hit = FirstHit(path, ProfileOf(path, w, v), 0);
#endif
  return hit.Key != NO_HIT;
}

// Moves to the next cell, which the ray enters at parameter t.
void LeaveCell(Ray ray, Wide t, inout CellPlace at)
{
  CrossPlanes(ray.Step, ray.Spacing, AreReached(at.Exits, t), at.Cell, at.Exits);
}

// The cell of a block in which the ray is at parameter t: from the cell in the corner where rays of
// this direction enter the block it has crossed all planes up to t.
CellPlace CellAt(Ray ray, GridPlace place, Wide t)
{
  CellPlace at;
  at.Cell = BLOCK_SIDE * place.Block + ((BLOCK_SIDE - 1) & IsBackwards(ray));
  Wide3 further = Sum(ray.Spacing, Doubled(ray.Spacing, 1));
  at.Exits = Difference(place.Exits, further);
  CrossThreePlanes(ray, ray.Spacing, t, at.Cell, at.Exits);
  return at;
}

// First hit of the ray in the block; false if there is none. The walk to the next cell that the
// surface crosses is a loop of its own, so that the lanes of a group meet again for the costly
// part.
bool IntersectBlock(Ray ray, GridPlace place, BlockCrossing crossing, out Hit hit)
{
  hit = MISS;
  Wide t0 = crossing.Enter;
  Wide end = crossing.Leave;
  CellPlace at = CellAt(ray, place, t0);
  uvec2 known = KnownCells(place.Block);
#ifdef LEVELS
  Ray coarseRay = ray;
  BlendedCells blended = BlendedCells(ivec3(0), uvec2(0u), uvec2(0u));
  if (ray.Blends)
  {
    coarseRay = RayInNext(ray);
    blended = FindBlendedCells(place.Block);
  }
#endif
  for (int tested = 0; tested < 16; ++tested) // a ray crosses at most 10 cells of 4^3
  {
    Corners w = Corners(vec4(0.0), vec4(0.0));
    Corners v = w;
    Wide t1;
    bool last;
    bool crossed = false;
    for (int walked = 0; walked < 16; ++walked)
    {
      t1 = SmallestOf(at.Exits);
      last = !IsLess(t1, end);
#ifdef LEVELS
      crossed = ray.Blends ? BlendMayHit(blended, at.Cell, w, v) : MayHit(known, at.Cell, w);
#else
      crossed = MayHit(known, at.Cell, w);
#endif
      if (crossed || last)
      {
        break;
      }
      LeaveCell(ray, t1, at);
      t0 = t1;
    }
    t1 = SmallerOf(t1, end);
    if (crossed)
    {
      CellPath path = PathThrough(ray, at, t0, t1);
#ifdef LEVELS
      if (ray.Blends)
      {
        path = BlendedPath(ray, coarseRay, at, t0, t1);
      }
#endif
      if (IntersectCell(path, CornersOf(at.Cell, w), v, hit))
      {
        return true;
      }
    }
    if (!crossed || last)
    {
      return false;
    }
    LeaveCell(ray, t1, at);
    t0 = t1;
  }
  return false;
}
