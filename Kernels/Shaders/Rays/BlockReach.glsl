#include "Shared/Scene.glsl"
#include "Rays/Rays.glsl"

// Finds the neighbours whose samples a ray needs to pass through a block: the last cells on an axis
// have their far corners in the next block. Returns 1 on each axis on which the ray passes through
// such cells between parameters t0 and t1, else 0. `exits`: parameters of the planes through which
// it leaves the block.
ivec3 DualGridReach(Ray ray, ivec3 block, Wide t0, Wide t1, Wide3 exits)
{
  // the planes of the last cells: the ones before those exits, or those behind the entries
  ivec3 backwards = IsBackwards(ray);
  Wide3 before = Choose(ray.Spacing, Sum(ray.Spacing, Doubled(ray.Spacing, 1)), backwards);
  Wide3 lastCells = Difference(exits, before);
  ivec3 reached = Choose(NotGreater(lastCells, t1), 1 - NotGreater(lastCells, t0), backwards);
  return min(reached, volume.Blocks - 1 - block);
}
