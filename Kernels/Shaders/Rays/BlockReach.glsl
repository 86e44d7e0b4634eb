#include "Shared/Scene.glsl"
#include "Rays/LevelSpans.glsl"
#include "Rays/LevelStretches.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"

// Finds the neighbours whose samples a ray needs to pass through a block: the last cells on an axis
// have their far corners in the next block. Returns 1 on each axis on which the ray passes through
// such cells, else 0.
ivec3 DualGridReach(Ray ray, GridPlace place, BlockCrossing crossing)
{
  // the planes of the last cells: the ones before the block's exits, or those behind its entries
  ivec3 backwards = IsBackwards(ray);
  Wide3 before = Choose(ray.Spacing, Sum(ray.Spacing, Doubled(ray.Spacing, 1)), backwards);
  Wide3 lastCells = Difference(place.Exits, before);
  ivec3 reached = Choose(-AreReached(lastCells, crossing.Leave),
    1 + AreReached(lastCells, crossing.Enter), backwards);
  return min(reached, LEVEL_GRID.Blocks - 1 - place.Block);
}

// The blocks that a ray needs to be intersected with one: itself, the neighbours that it reaches
// into, and where levels of detail blend those of the next.
struct BlockNeeds
{
  ivec3 Reach;
#ifdef LEVELS
  bool NeedsNext;
  ivec3 CoarseReach; // of the next level's block that holds this one
#endif
};

#ifdef LEVELS
// How far a block of the next level reaches for one that it holds: to the next blocks if its own
// last cells are there. (On an axis that is halved, whether or not the ray meets them.)
ivec3 ReachInNextLevel(ivec3 block, ivec3 reach)
{
  ivec3 halved = HalvedByNext();
  ivec3 coarse = Choose(reach, block & 1, -halved);
  return min(coarse, volume.Levels[level + 1].Blocks - 1 - (block >> halved));
}

// A block in which blending begins counts as a whole, from before: a ray that waits in the part
// behind goes on in the part before, and asks for what it needs there. So does any block of the
// volume itself at which rays may look again, in parts, one for each coarser block.
BlockNeeds NeedsOf(Ray ray, GridPlace place, BlockCrossing crossing)
{
  BlockNeeds needs;
  bool cut = !ray.Blends && !ray.Finest && !IsLess(crossing.Leave, BlendBegin(level));
#ifdef CONSERVATIVE
  bool whole = cut || level == 0;
#else
  bool whole = cut;
#endif
  if (whole)
  {
    crossing = BlockCrossing(EntryOf(ray, place), SmallerOf(ray.End, SmallestOf(place.Exits)));
  }
  needs.Reach = DualGridReach(ray, place, crossing);
  needs.NeedsNext = cut || ray.Blends;
  needs.CoarseReach =
    needs.NeedsNext ? ReachInNextLevel(place.Block, needs.Reach) : ivec3(0);
  return needs;
}
#else
BlockNeeds NeedsOf(Ray ray, GridPlace place, BlockCrossing crossing)
{
  return BlockNeeds(DualGridReach(ray, place, crossing));
}
#endif
