// The stretches of a ray: in each it is in one level of detail, or in one that goes over to the next.
// They end at parameters that are the same for all rays. A level's planes are some of the volume's
// own, at the same parameters to the bit, so that at the end of a stretch a ray is, by the rule that
// TraverseGrid.glsl tells, in the same place of both levels. Without levels a ray has one stretch.

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

// Where a new ray enters the volume, in the level of that depth.
GridPlace BeginRay(inout Ray ray)
{
  level = 0;
  ray.End = ray.Leave;
  while (!IsLess(ray.Enter, LevelEnd(level)))
  {
    EnterNextLevel(ray);
  }
  ray.Blends = !IsLess(ray.Enter, BlendBegin(level));
  TakeStretch(ray);
  GridPlace place = PlaceIn(ray, BlockOf(ray.FirstCell));
  EnterGrid(ray, place);
  return place;
}

// A ray goes on in a block: where this blends only in part, in the part before.
GridPlace ResumeRay(inout Ray ray, uint block)
{
  EnterLevelOf(block);
  int last = level;
  level = 0;
  ray.End = ray.Leave;
  while (level < last)
  {
    EnterNextLevel(ray);
  }
  GridPlace place = PlaceIn(ray, BlockCoordinates(block));
  Wide entry = LargestOf(Difference(place.Exits, BlockSpacing(ray)));
  ray.Blends = !IsLess(LargerOf(ray.Enter, entry), BlendBegin(level));
  TakeStretch(ray);
  return place;
}

// Begins the next stretch, from the block where the last has ended. False if the ray has ended.
bool EnterNextStretch(inout Ray ray, inout GridPlace place, inout GridCursor at)
{
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
#endif

// Walks to the next active block, as FindActiveBlock does, through all stretches.
#ifdef LEVELS
bool FindNextBlock(inout Ray ray, bool leaves, inout GridPlace place, inout GridCursor at)
{
  bool found;
  do
  {
    found = FindActiveBlock(ray, leaves, place, at);
    leaves = false;
  } while (!found && EnterNextStretch(ray, place, at));
  return found;
}
#else
bool FindNextBlock(Ray ray, bool leaves, inout GridPlace place, inout GridCursor at)
{
  return FindActiveBlock(ray, leaves, place, at);
}
#endif
