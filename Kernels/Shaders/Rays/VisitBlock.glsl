// A ray's visit to a block that it may hit, the same for whole wavefronts and for stragglers.

#include "Rays/BlockReach.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/WorkCounters.glsl"
#include "Surface/IntersectBlock.glsl"

struct BlockVisit
{
  BlockCrossing Crossing;
  ivec3 Reach; // into the next blocks
};

BlockVisit PlanVisit(Ray ray, GridPlace place)
{
  BlockCrossing crossing = CrossBlock(ray, place);
  return BlockVisit(crossing, DualGridReach(ray, place, crossing));
}

// Is a block of this visit not in the cache? Finds their slots.
bool LacksBlocks(ivec3 block, BlockVisit visit)
{
  FindSlots(block, visit.Reach);
  return LacksSlots();
}

// Intersects the ray with the block, whose slots were found last. False if there is no hit.
bool VisitBlock(Ray ray, GridPlace place, BlockVisit visit, out Hit hit)
{
  UseBlocks(place.Block, visit.Reach);
  ++pairs;
  return IntersectBlock(ray, place, visit.Crossing, hit);
}
