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
  BlockNeeds Needs;
};

BlockVisit PlanVisit(Ray ray, GridPlace place)
{
  BlockCrossing crossing = CrossBlock(ray, place);
  return BlockVisit(crossing, NeedsOf(ray, place, crossing));
}

// Is a block of this visit not in the cache? Finds their slots; those of the next level are aside.
bool LacksBlocks(ivec3 block, BlockVisit visit)
{
  bool lacks = false;
#ifdef LEVELS
  if (visit.Needs.NeedsNext)
  {
    ivec3 coarse = block >> HalvedByNext();
    ++level;
    FindSlots(coarse, visit.Needs.CoarseReach);
    --level;
    lacks = LacksSlots();
    ExchangeSlots();
  }
#endif
  FindSlots(block, visit.Needs.Reach);
  return lacks || LacksSlots();
}

// Intersects the ray with the block, whose slots were found last. False if there is no hit.
bool VisitBlock(Ray ray, GridPlace place, BlockVisit visit, out Hit hit)
{
  UseBlocks(place.Block, visit.Needs.Reach);
#ifdef LEVELS
  if (visit.Needs.NeedsNext)
  {
    ivec3 coarse = place.Block >> HalvedByNext();
    ++level;
    UseBlocks(coarse, visit.Needs.CoarseReach);
    --level;
  }
#endif
  ++pairs;
  return IntersectBlock(ray, place, visit.Crossing, hit);
}

#ifdef LEVELS
// See LEVEL_FLAG in Hits.glsl.
bool IsFlagged(Ray ray)
{
#ifdef CONSERVATIVE
  return ray.Finest;
#else
  return ray.Doubted;
#endif
}
#endif

// The depth of a hit, with the flag of levels.
float FlaggedDepth(Ray ray, Hit hit)
{
  float depth = DepthAt(HitT(hit.Key));
#ifdef LEVELS
  depth = IsFlagged(ray) ? -depth : depth;
#endif
  return depth;
}
