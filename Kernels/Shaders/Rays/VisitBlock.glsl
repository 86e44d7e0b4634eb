// A ray's visit to a block that it may hit, the same for whole wavefronts and for stragglers.

#include "Rays/BlockReach.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/WorkCounters.glsl"
#include "Surface/IntersectBlock.glsl"

struct BlockVisit
{
  Wide Enter, Leave; // parameters
  ivec3 Reach;       // into the next blocks
};

BlockVisit PlanVisit(Ray ray, ivec3 block)
{
  BlockCrossing at = CrossBlock(ray, block);
  return BlockVisit(
    at.Enter, at.Leave, DualGridReach(ray, block, at.Enter, at.Leave, at.Exits));
}

// Is a block of this visit not in the cache? Finds their slots.
bool LacksBlocks(ivec3 block, BlockVisit visit)
{
  return FindSlots(block, visit.Reach) != 0u;
}

// Intersects the ray with the block, whose slots were found last. False if there is no hit.
bool VisitBlock(Ray ray, ivec3 block, BlockVisit visit, out Hit hit)
{
  UseBlocks(block, visit.Reach);
  ++pairs;
  return IntersectBlock(ray, block, visit.Enter, visit.Leave, hit);
}
