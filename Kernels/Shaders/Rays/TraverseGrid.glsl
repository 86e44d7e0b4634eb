// Walks a ray over macrocells and their blocks, after Amanatides and Woo, to the next block that is
// marked as active: its range of values holds an isovalue. At parameter t a ray has crossed every
// plane whose parameter is not greater. Stepping to the next block, skipping a macrocell and
// starting inside the volume all obey this one rule and therefore agree.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/Rays.glsl"

// The last block on each axis that holds cells: a block of a single sample holds none.
ivec3 LastCellBlock()
{
  return (LEVEL_GRID.Samples - 2) / BLOCK_SIDE;
}

// Planes through which a ray leaves an element of a grid whose elements have `side` cells.
ivec3 ExitPlanes(Ray ray, ivec3 element, int side)
{
  return (element + 1 + IsBackwards(ray)) * side;
}

// Where a ray is in the grid: the block, and parameters of the planes through which it leaves it.
struct GridPlace
{
  ivec3 Block;
  Wide3 Exits;
};

GridPlace PlaceIn(Ray ray, ivec3 block)
{
  return GridPlace(block, PlanesT(ray, ExitPlanes(ray, block, BLOCK_SIDE)));
}

// Moves an element by a step on the axes that `crossed`, a component -1 or 0, tells; `exits` are
// parameters of the planes through which the ray leaves it, and gain `spacing`.
void CrossPlanes(
  ivec3 step, Wide3 spacing, ivec3 crossed, inout ivec3 element, inout Wide3 exits)
{
  element += step & crossed;
  exits = Sum(exits, Masked(spacing, crossed));
}

// Moves an element over those of the next three planes on each axis that the ray meets up to
// parameter t: two steps, of two planes and of one.
void CrossThreePlanes(Ray ray, Wide3 spacing, Wide t, inout ivec3 element, inout Wide3 exits)
{
  ivec3 two = AreReached(Sum(exits, spacing), t);
  CrossPlanes(2 * ray.Step, Doubled(spacing, 1), two, element, exits);
  CrossPlanes(ray.Step, spacing, AreReached(exits, t), element, exits);
}

Wide3 BlockSpacing(Ray ray)
{
  return Doubled(ray.Spacing, BLOCK_SIDE_LOG2);
}

// Parameters between which a ray is in a block.
struct BlockCrossing
{
  Wide Enter, Leave;
};

// Where the walk in the grid begins.
Wide BeginOf(Ray ray)
{
#ifdef LEVELS
  return ray.From;
#else
  return ray.Enter;
#endif
}

BlockCrossing CrossBlock(Ray ray, GridPlace place)
{
  Wide3 entries = Difference(place.Exits, BlockSpacing(ray));
  return BlockCrossing(LargerOf(BeginOf(ray), LargestOf(entries)),
    SmallerOf(ray.Leave, SmallestOf(place.Exits)));
}

// Where a ray enters the volume: it may enter its first cell's block where it leaves it.
void EnterGrid(Ray ray, inout GridPlace place)
{
  ivec3 next = place.Block + ray.Step;
  ivec3 within = ivec3(lessThanEqual(uvec3(next), uvec3(LastCellBlock())));
  CrossPlanes(ray.Step, BlockSpacing(ray), AreReached(place.Exits, ray.Enter) & -within,
    place.Block, place.Exits);
}

// Parameters of the planes through which a ray leaves the next larger element: up to `mask`, three,
// blocks further; or the block itself, if `mask` is 0.
Wide3 ExitsBehind(Ray ray, GridPlace place, int mask)
{
  ivec3 ahead = (place.Block ^ ~IsBackwards(ray)) & mask;
  Wide3 one = BlockSpacing(ray);
  Wide3 exits = Choose(place.Exits, Sum(place.Exits, one), -(ahead & 1));
  return Choose(exits, Sum(exits, Doubled(one, 1)), -(ahead >> 1));
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

// Of a place in a cell of this level.
int RegionOf(ivec3 cell, vec3 place)
{
#ifdef LEVELS
  vec3 finest = place * vec3(ivec3(1) << Halvings()); // a power of 2: exact
  vec3 whole = floor(finest);
  return CroppingRegion((cell << Halvings()) + ivec3(whole), finest - whole);
#else
  return CroppingRegion(cell, place);
#endif
}

// Tells whether one region that is not drawn holds the whole block.
bool IsCroppedAway(ivec3 block)
{
  ivec3 first = BLOCK_SIDE * block;
  int region = RegionOf(first, vec3(0.0));
  return region == RegionOf(first + BLOCK_SIDE, vec3(0.0)) && !IsRegionDrawn(region);
}
#endif

// The macrocell that a ray is in, so that its marks are read once: a bit for each of its blocks.
struct GridCursor
{
  ivec3 Macrocell;
  uvec2 Marks;
#ifdef LEVELS
  uvec2 Original; // likewise of the volume's own samples, where a coarser level is drawn
#endif
};

GridCursor OutsideGrid()
{
  GridCursor at;
  at.Macrocell = ivec3(-1);
  at.Marks = uvec2(0u);
#ifdef LEVELS
  at.Original = uvec2(0u);
#endif
  return at;
}

GridCursor CursorAt(Ray ray, ivec3 macrocell)
{
  GridCursor at;
  at.Macrocell = macrocell;
  uint index = MacrocellIndex(macrocell);
#ifdef LEVELS
  at.Marks = blockMarks[MarksIndex(index, ray.Blends ? BLEND_MARKS : LEVEL_MARKS)];
  at.Original = level > 0 || ray.Blends ? blockMarks[MarksIndex(index, ORIGINAL_MARKS)] : uvec2(0u);
#else
  at.Marks = blockMarks[MarksIndex(index, LEVEL_MARKS)];
#endif
  return at;
}

bool IsMarked(uvec2 marks, ivec3 block)
{
  uint local = LocalIndex(block);
  return ((local < 32u ? marks.x : marks.y) >> (local & 31u) & 1u) != 0u;
}

// Tells whether a block may hold a surface that is drawn, by marks of its macrocell.
bool IsBlockActive(uvec2 marks, ivec3 block)
{
#ifdef CROPPED
  if (IsCroppedAway(block))
  {
    return false;
  }
#endif
  return IsMarked(marks, block);
}

// Tells whether rays skip all of the macrocell.
bool IsSkipped(GridCursor at)
{
#ifdef LEVELS
  return (at.Marks | at.Original) == uvec2(0u);
#else
  return at.Marks == uvec2(0u);
#endif
}

// Walks to the next active block. `leaves`: the one where the ray is does not count. False if the
// ray leaves the volume, or its stretch in a level of detail ends, before; or if it passes a block
// where the volume itself may have a surface, and is to look at that. Lanes that skip a macrocell
// and those that go to the next block make the last step together.
bool FindActiveBlock(inout Ray ray, bool leaves, inout GridPlace place, inout GridCursor at)
{
  bool inside = true;
  while (inside)
  {
    ivec3 macrocell = MacrocellOf(place.Block);
    if (macrocell != at.Macrocell)
    {
      at = CursorAt(ray, macrocell);
    }
    bool skips = IsSkipped(at);
    if (!skips && !leaves && IsBlockActive(at.Marks, place.Block))
    {
      return true;
    }
#ifdef LEVELS
    if (!skips && IsBlockActive(at.Original, place.Block))
    {
      ray.Doubted = true;
#ifdef CONSERVATIVE
      return false;
#endif
    }
#endif
    leaves = false;
    Wide t = SmallestOf(ExitsBehind(ray, place, skips ? MACROCELL_SIDE - 1 : 0));
#ifdef LEVELS
    t = SmallerOf(t, ray.Leave); // there the next stretch begins
#endif
    if (skips)
    {
      CrossThreePlanes(ray, BlockSpacing(ray), t, place.Block, place.Exits);
    }
    inside = IsLess(t, ray.Leave);
    CrossPlanes(ray.Step, BlockSpacing(ray), AreReached(place.Exits, t), place.Block, place.Exits);
    inside = inside && InGrid(place.Block);
  }
  return false;
}
