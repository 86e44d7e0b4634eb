#include "Shared/Scene.glsl"
#include "Rays/Rays.glsl"

// Finds the neighbours whose samples a ray needs to pass through a block: the last cells on an axis
// have their far corners in the next block. Returns 1 on each axis on which the ray passes through
// such cells between parameters t0 and t1, else 0.
ivec3 DualGridReach(Ray ray, ivec3 block, Wide t0, Wide t1)
{
  Wide3 lastCells = PlanesT(ray, BLOCK_SIDE * block + (BLOCK_SIDE - 1));
  ivec3 backwards = ray.Step >> 31;
  ivec3 reached = Choose(NotGreater(lastCells, t1), 1 - NotGreater(lastCells, t0), backwards);
  return min(reached, volume.Blocks - 1 - block);
}
