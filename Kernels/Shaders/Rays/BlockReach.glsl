#include "Shared/Scene.glsl"
#include "Rays/Rays.glsl"

// Finds the neighbours whose samples a ray needs to pass through a block: the last cells on an axis
// have their far corners in the next block. Returns 1 on each axis on which the ray passes through
// such cells between parameters t0 and t1, else 0.
ivec3 DualGridReach(Ray ray, ivec3 block, double t0, double t1)
{
  dvec3 lastCells = PlanesT(ray, BLOCK_SIDE * block + (BLOCK_SIDE - 1));
  bvec3 forward = greaterThan(ray.Step, ivec3(0));
  ivec3 reached = ivec3(lessThanEqual(lastCells, dvec3(t1))) * ivec3(forward) +
    ivec3(greaterThan(lastCells, dvec3(t0))) * ivec3(not(forward));
  return min(reached, volume.Blocks - 1 - block);
}
