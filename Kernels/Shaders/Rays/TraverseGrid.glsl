// Walks a ray over macrocells and their blocks, after Amanatides and Woo, to the next block whose
// range of values holds an isovalue. At parameter t a ray has crossed every plane whose parameter
// is not greater. Stepping to the next block, skipping a macrocell and starting inside the volume
// all obey this one rule and therefore agree.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/Rays.glsl"

// The last block on each axis that holds cells: a block of a single sample holds none.
ivec3 LastCellBlock()
{
  return (volume.Samples - 2) / BLOCK_SIDE;
}

// Planes through which a ray enters an element of a grid whose elements have `side` cells.
ivec3 EntryPlanes(Ray ray, ivec3 element, int side)
{
  return (element + (1 - ray.Step) / 2) * side;
}

ivec3 ExitPlanes(Ray ray, ivec3 element, int side)
{
  return (element + (1 + ray.Step) / 2) * side;
}

// Parameters between which a ray is in a block, and of the planes through which it leaves it.
struct BlockCrossing
{
  Wide Enter, Leave;
  Wide3 Exits;
};

BlockCrossing CrossBlock(Ray ray, ivec3 block)
{
  Wide3 exits = PlanesT(ray, ExitPlanes(ray, block, BLOCK_SIDE));
  Wide3 entries = Difference(exits, Doubled(ray.Spacing, BLOCK_SIDE_LOG2));
  return BlockCrossing(LargerOf(ray.Enter, LargestOf(entries)),
    SmallerOf(ray.Leave, SmallestOf(exits)), exits);
}

// Tells whether a range has a value below the isovalue and one that is not.
bool StraddlesIsovalue(float low, float high, int number)
{
  FloatSum isovalue = view.Isovalues[number];
  precise float below = (low - isovalue.High) - isovalue.Low;
  precise float above = (high - isovalue.High) - isovalue.Low;
  return below < 0.0 && above >= 0.0;
}

bool StraddlesAnyIsovalue(float low, float high)
{
#ifdef SEVERAL_ISOVALUES
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (StraddlesIsovalue(low, high, i))
    {
      return true;
    }
  }
  return false;
#else
  return StraddlesIsovalue(low, high, 0);
#endif
}

// The step to the next block on each axis on which the ray leaves this one by parameter t.
ivec3 StepBy(Ray ray, ivec3 block, Wide t)
{
  return NotGreater(PlanesT(ray, ExitPlanes(ray, block, BLOCK_SIDE)), t) * ray.Step;
}

// The block in which the ray enters the volume.
ivec3 FirstBlock(Ray ray)
{
  ivec3 block = BlockOf(ray.FirstCell);
  return clamp(block + StepBy(ray, block, ray.Enter), ivec3(0), LastCellBlock());
}

// Moves to the next block on the ray; false if the ray leaves the volume.
bool NextBlock(Ray ray, inout ivec3 block)
{
  Wide3 exits = PlanesT(ray, ExitPlanes(ray, block, BLOCK_SIDE));
  Wide t = SmallestOf(exits);
  if (!IsLess(t, ray.Leave))
  {
    return false;
  }
  block += NotGreater(exits, t) * ray.Step;
  return InGrid(block);
}

// Moves to the first block behind the macrocell that holds `block`; false if the ray leaves the
// volume.
bool SkipMacrocell(Ray ray, inout ivec3 block)
{
  ivec3 macrocell = MacrocellOf(block);
  Wide3 exits = PlanesT(ray, ExitPlanes(ray, macrocell, BLOCK_SIDE * MACROCELL_SIDE));
  Wide t = SmallestOf(exits);
  if (!IsLess(t, ray.Leave))
  {
    return false;
  }
  ivec3 within = block;
  Wide3 planes = PlanesT(ray, ExitPlanes(ray, block, BLOCK_SIDE));
  for (int i = 1; i < MACROCELL_SIDE; ++i)
  {
    within += NotGreater(planes, t) * ray.Step;
    planes = Sum(planes, Doubled(ray.Spacing, BLOCK_SIDE_LOG2));
  }
  // on the axes on which the ray leaves the macrocell: the block just behind it
  ivec3 behind = MACROCELL_SIDE * macrocell - 1 + (MACROCELL_SIDE + 1) * (1 + ray.Step) / 2;
  block = within + (behind - within) * NotGreater(exits, t);
  return InGrid(block);
}

#ifdef CROPPED
// 1 on each axis on which a place in a cell lies beyond the plane, else 0.
ivec3 IsBeyond(CellPlanes planes, ivec3 cell, vec3 place)
{
  return ivec3(greaterThan(cell, planes.Cell)) |
    (ivec3(equal(cell, planes.Cell)) & ivec3(greaterThan(place, planes.Place)));
}

// Number of the cropping region that holds a place in a cell, in vtkVolumeMapper's order.
int CroppingRegion(ivec3 cell, vec3 place)
{
  ivec3 side = IsBeyond(view.CroppingLow, cell, place) + IsBeyond(view.CroppingHigh, cell, place);
  return side.x + 3 * side.y + 9 * side.z;
}

bool IsRegionDrawn(int region)
{
  return (view.DrawnRegions >> region & 1) != 0;
}

// Tells whether one region that is not drawn holds the whole block.
bool IsCroppedAway(ivec3 block)
{
  ivec3 first = BLOCK_SIDE * block;
  int region = CroppingRegion(first, vec3(0.0));
  return region == CroppingRegion(first + BLOCK_SIDE, vec3(0.0)) && !IsRegionDrawn(region);
}
#endif

// The macrocell that a ray is in, so that its record is read once.
struct GridCursor
{
  ivec3 Coordinates;
  uint Index;
  vec2 Range;
  bool Active; // the range holds an isovalue
};

GridCursor OutsideGrid()
{
  return GridCursor(ivec3(-1), 0u, vec2(0.0), false);
}

void MoveCursor(inout GridCursor at, ivec3 macrocell)
{
  at.Coordinates = macrocell;
  at.Index = MacrocellIndex(macrocell);
  at.Range = vec2(macrocells[at.Index].Low, macrocells[at.Index].High);
  at.Active = StraddlesAnyIsovalue(at.Range.x, at.Range.y);
}

// Tells whether a block of the cursor's macrocell may hold a surface that is drawn.
bool IsBlockActive(GridCursor at, ivec3 block)
{
#ifdef CROPPED
  if (IsCroppedAway(block))
  {
    return false;
  }
#endif
  uint local = LocalIndex(block);
  uint word = macrocells[at.Index].Ranges[local >> 1];
  uint range = (local & 1u) == 0u ? word & 0xFFFFu : word >> 16;
  uint low = range & 0xFFu;
  uint high = range >> 8;
  return low <= high && StraddlesAnyIsovalue(RangeLow(at.Range, low), RangeHigh(at.Range, high));
}

// Walks from `block`, which counts too, to the next active one; false if the ray leaves the volume
// before.
bool FindActiveBlock(Ray ray, inout ivec3 block, inout GridCursor at)
{
  bool inside = true;
  while (inside)
  {
    if (MacrocellOf(block) != at.Coordinates)
    {
      MoveCursor(at, MacrocellOf(block));
    }
    if (!at.Active)
    {
      inside = SkipMacrocell(ray, block);
      continue;
    }
    if (IsBlockActive(at, block))
    {
      return true;
    }
    inside = NextBlock(ray, block);
  }
  return false;
}
