// The stretches of a ray: in each it is in one level of detail, or in one that goes over to the
// next. They end at parameters that are the same for all rays. A level's planes are some of the
// volume's own, at the same parameters to the bit, so that at the end of a stretch a ray is, by the
// rule that TraverseGrid.glsl tells, in the same place of both levels. Without levels a ray has one
// stretch.

#include "Shared/Scene.glsl"
#include "Shared/Grid.glsl"
#include "Rays/LevelSpans.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"

#ifdef LEVELS
// The same ray in the grid of the next level. One halving after the other, so that its place in the
// first cell is rounded alike whatever level it comes from.
Ray RayInNext(Ray ray)
{
  ivec3 halved = -HalvedByNext();
  ivec3 ahead = (ray.FirstCell ^ IsBackwards(ray)) & 1; // the half of the coarse cell
  vec3 begin = 0.5 * (vec3(ahead) + ray.Begin);
  ivec3 next = ray.FirstCell + (1 + ray.Step) / 2; // the plane through which it leaves the cell
  Wide3 t = PlanesT(ray, next);
  // of the coarse cell the plane behind, where it begins in the first half
  Wide3 behind = SmallerOf(Sum(t, ray.Spacing), AllOf(NEVER_MET));
  t = Choose(t, behind, halved & (ahead - 1));
  Ray coarse = ray;
  coarse.Begin = mix(ray.Begin, begin, notEqual(halved, ivec3(0)));
  coarse.CellsPerT = ray.CellsPerT * mix(vec3(1.0), vec3(0.5), notEqual(halved, ivec3(0)));
  coarse.Spacing = Choose(
    ray.Spacing, SmallerOf(Doubled(ray.Spacing, 1), AllOf(WIDEST_SPACING)), halved);
  coarse.FirstCell = ray.FirstCell >> -halved;
  next = coarse.FirstCell + (1 + ray.Step) / 2;
  coarse.First =
    Difference(t, Negated(Product(coarse.Spacing, uvec3(next)), IsBackwards(ray)));
  return coarse;
}

// Limits a ray to its stretch.
void TakeStretch(inout Ray ray)
{
  Wide begin = level == 0 ? ray.Enter : LevelEnd(level - 1);
  ray.From = LargerOf(ray.Enter, ray.Blends ? BlendBegin(level) : begin);
  ray.Leave = SmallerOf(ray.End, ray.Blends ? LevelEnd(level) : BlendBegin(level));
}

// Goes on in the next level.
void EnterNextLevel(inout Ray ray)
{
  ray = RayInNext(ray);
  ++level;
}

#ifdef CONSERVATIVE
Ray finest; // the ray in the volume itself
#endif

// A ray as CameraRay makes it, before it has a stretch.
void OpenRay(inout Ray ray)
{
  level = 0;
  ray.End = ray.Leave;
  ray.Blends = false;
  ray.Doubted = false;
  ray.Finest = false;
#ifdef CONSERVATIVE
  finest = ray;
#endif
}

// Goes on, from the volume itself, to the level that is drawn at a parameter.
void EnterStretchAt(Wide t, inout Ray ray)
{
  while (HasLevelEnded(t))
  {
    EnterNextLevel(ray);
  }
  ray.Blends = !IsLess(t, BlendBegin(level));
  TakeStretch(ray);
}

// Where a new ray enters the volume, in the level of that depth.
GridPlace BeginRay(inout Ray ray)
{
  OpenRay(ray);
  EnterStretchAt(ray.Enter, ray);
  GridPlace place = PlaceIn(ray, BlockOf(ray.FirstCell));
  EnterGrid(ray, place);
  return place;
}

Wide EntryOf(Ray ray, GridPlace place)
{
  return LargerOf(ray.Enter, LargestOf(Difference(place.Exits, BlockSpacing(ray))));
}

#ifdef CONSERVATIVE
// Limits a ray in the volume itself to its way through a coarser block.
void LookWithin(BlockCrossing crossing, inout Ray ray)
{
  ray.Finest = true;
  ray.From = crossing.Enter;
  ray.Leave = crossing.Leave;
}

// The block of the volume itself in which the ray is at parameter t. Floats tell it to a plane, at
// worst two, and the planes' own parameters which it is.
GridPlace FinestPlaceAt(Wide t)
{
  Wide3 next = PlanesT(finest, finest.FirstCell + (1 + finest.Step) / 2);
  vec3 planes = floor(ToFloat(Difference(AllOf(t), next)) / ToFloat(finest.Spacing)) + 1.0;
  ivec3 cell = finest.FirstCell + finest.Step * ivec3(max(planes, 0.0));
  GridPlace place = PlaceIn(finest, BlockOf(cell));
  Wide3 spacing = BlockSpacing(finest);
  ivec3 back = ~AreReached(Difference(place.Exits, spacing), t) &
    ~AreReached(Difference(place.Exits, spacing), finest.Enter);
  place.Block -= finest.Step & back;
  place.Exits = Difference(place.Exits, Masked(spacing, back));
  CrossPlanes(finest.Step, spacing, AreReached(place.Exits, t), place.Block, place.Exits);
  return place;
}

// Looks at the volume itself where the ray passes a coarser block without a hit.
void Descend(inout Ray ray, inout GridPlace place, inout GridCursor at)
{
  BlockCrossing crossing = CrossBlock(ray, place);
  ray = finest;
  level = 0;
  LookWithin(crossing, ray);
  place = FinestPlaceAt(ray.From);
  at = OutsideGrid();
}

// Goes back from there, or ends.
bool Ascend(inout Ray ray, inout GridPlace place, inout GridCursor at)
{
  Wide t = ray.Leave;
  if (!IsLess(t, ray.End) || !InGrid(place.Block))
  {
    return false;
  }
  ivec3 block = place.Block;
  ray = finest;
  EnterStretchAt(t, ray);
  place = PlaceIn(ray, block >> Halvings());
  at = OutsideGrid();
  return true;
}

// The way within which a ray looks at a block of the volume itself.
BlockCrossing CoarserCrossing(ivec3 block, Wide entry)
{
  Ray ray = finest;
  EnterStretchAt(entry, ray);
  BlockCrossing crossing = CrossBlock(ray, PlaceIn(ray, block >> Halvings()));
  level = 0;
  return crossing;
}
#endif

// A ray goes on in a block: where this blends only in part, in the part before.
GridPlace ResumeRay(inout Ray ray, uint block)
{
  OpenRay(ray);
  EnterLevelOf(block);
  int last = level;
  level = 0;
  while (level < last)
  {
    EnterNextLevel(ray);
  }
  GridPlace place = PlaceIn(ray, BlockCoordinates(block));
  Wide entry = EntryOf(ray, place);
#ifdef CONSERVATIVE
  if (!IsLess(entry, LevelEnd(level)))
  {
    LookWithin(CoarserCrossing(place.Block, entry), ray);
    return place;
  }
#endif
  ray.Blends = !IsLess(entry, BlendBegin(level));
  TakeStretch(ray);
  return place;
}

// Begins the next stretch, from the block where the last has ended. False if the ray has ended.
bool EnterNextStretch(inout Ray ray, inout GridPlace place, inout GridCursor at)
{
#ifdef CONSERVATIVE
  if (ray.Finest)
  {
    return Ascend(ray, place, at);
  }
#endif
  while (IsLess(ray.Leave, ray.End) && InGrid(place.Block))
  {
    if (ray.Blends)
    {
      ivec3 block = place.Block >> HalvedByNext();
      EnterNextLevel(ray);
      place = PlaceIn(ray, block);
    }
    ray.Blends = !ray.Blends;
    TakeStretch(ray);
    if (IsLess(ray.From, ray.Leave))
    {
      at = OutsideGrid();
      return true;
    }
  }
  return false;
}

// Walks to the next active block, as FindActiveBlock does, through all stretches.
bool FindNextBlock(inout Ray ray, bool leaves, inout GridPlace place, inout GridCursor at)
{
  bool goesOn = true;
  while (goesOn)
  {
#ifdef CONSERVATIVE
    ray.Doubted = false;
#endif
    if (FindActiveBlock(ray, leaves, place, at))
    {
      return true;
    }
    leaves = false;
#ifdef CONSERVATIVE
    if (ray.Doubted)
    {
      Descend(ray, place, at);
      continue;
    }
#endif
    goesOn = EnterNextStretch(ray, place, at);
  }
  return false;
}
#else
GridPlace BeginRay(Ray ray)
{
  GridPlace place = PlaceIn(ray, BlockOf(ray.FirstCell));
  EnterGrid(ray, place);
  return place;
}

GridPlace ResumeRay(Ray ray, uint block)
{
  return PlaceIn(ray, BlockCoordinates(block));
}

bool EnterNextStretch(Ray ray, GridPlace place, GridCursor at)
{
  return false;
}

bool FindNextBlock(inout Ray ray, bool leaves, inout GridPlace place, inout GridCursor at)
{
  return FindActiveBlock(ray, leaves, place, at);
}
#endif
