// A ray's visit to a block that it may hit, the same for whole wavefronts and for stragglers.

#include "Rays/BlockReach.glsl"
#include "Rays/LevelStretches.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Rays/WorkCounters.glsl"
#include "Surface/IntersectBlock.glsl"

struct BlockVisit
{
  BlockCrossing Crossing;
  ivec3 Reach; // into the next blocks
#ifdef LEVELS
  ivec3 CoarseReach; // likewise, of the coarse block where the next level blends in
#endif
};

BlockVisit PlanVisit(Ray ray, GridPlace place)
{
  BlockVisit visit;
  visit.Crossing = CrossBlock(ray, place);
  visit.Reach = DualGridReach(ray, place, visit.Crossing);
#ifdef LEVELS
  visit.CoarseReach = ReachInNextLevel(place.Block, visit.Reach);
#endif
  return visit;
}

// Is a block of this visit not in the cache? Finds their slots; those of the next level are aside.
bool LacksBlocks(Ray ray, ivec3 block, BlockVisit visit)
{
  bool lacks = false;
#ifdef LEVELS
  if (ray.Blends)
  {
    ivec3 coarse = block >> HalvedByNext();
    ++level;
    FindSlots(coarse, visit.CoarseReach);
    --level;
    lacks = LacksSlots();
    ExchangeSlots();
  }
#endif
  FindSlots(block, visit.Reach);
  return lacks || LacksSlots();
}

// Intersects the ray with the block, whose slots were found last. False if there is no hit.
bool VisitBlock(Ray ray, GridPlace place, BlockVisit visit, out Hit hit)
{
  UseBlocks(place.Block, visit.Reach);
#ifdef LEVELS
  if (ray.Blends)
  {
    ivec3 coarse = place.Block >> HalvedByNext();
    ++level;
    UseBlocks(coarse, visit.CoarseReach);
    --level;
  }
#endif
  ++pairs;
  return IntersectBlock(ray, place, visit.Crossing, hit);
}
