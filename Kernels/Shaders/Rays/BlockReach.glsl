#include "Shared/Scene.glsl"
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

#ifdef LEVELS
// The same for the block of the next level that holds this one: to the next blocks if its own last
// cells are there. (On an axis that is halved, whether or not the ray meets them.)
ivec3 ReachInNextLevel(ivec3 block, ivec3 reach)
{
  if (level + 1 >= volume.NumberOfLevels)
  {
    return ivec3(0);
  }
  ivec3 halved = HalvedByNext();
  ivec3 coarse = Choose(reach, block & 1, -halved);
  return min(coarse, volume.Levels[level + 1].Blocks - 1 - (block >> halved));
}
#endif
