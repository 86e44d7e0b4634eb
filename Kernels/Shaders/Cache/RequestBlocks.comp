// Asks for the blocks that rays wait for, and ahead: the fewer rays are left, the more of the next
// blocks along it whose range of values holds an isovalue does each ask for (the speculation). Each
// block is asked for with those neighbours that the ray's way through its dual grid reaches into.
// The lanes first walk a ray each, then look up what the walks have met, a block or neighbour each.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/BlockReach.glsl"
#include "Rays/LevelStretches.glsl"
#include "Rays/RayQueues.glsl"
#include "Rays/Rays.glsl"
#include "Rays/TraverseGrid.glsl"
#include BLOCK_ACCESS

#ifdef LEVELS
const uint MOST_AHEAD = 2u * GROUP_BLOCKS_AHEAD; // where levels blend, a block of each
#else
const uint MOST_AHEAD = GROUP_BLOCKS_AHEAD;
#endif

shared uvec2 ahead[MOST_AHEAD]; // block, and its reach in the lowest three bits
shared uint aheadCount;

void AddAhead(ivec3 block, ivec3 reach)
{
  ahead[atomicAdd(aheadCount, 1u)] =
    uvec2(BlockIndex(block), reach.x + 2 * reach.y + 4 * reach.z);
}

void LookAhead(uint pixel, uint speculation)
{
  Ray ray = CameraRay(pixel);
  GridPlace place = ResumeRay(ray, BlockOfRay(pixel));
  GridCursor at = OutsideGrid();
  for (uint i = 0u; i < speculation && FindNextBlock(ray, i > 0u, place, at); ++i)
  {
    BlockNeeds needs = NeedsOf(ray, place, CrossBlock(ray, place));
    AddAhead(place.Block, needs.Reach);
#ifdef LEVELS
    if (needs.NeedsNext)
    {
      ivec3 coarse = place.Block >> HalvedByNext();
      ++level;
      AddAhead(coarse, needs.CoarseReach);
      --level;
    }
#endif
  }
}

// Every lane takes a neighbour, or the block itself.
void RequestMissing()
{
  for (uint i = gl_LocalInvocationIndex; i < 8u * aheadCount; i += GROUP_SIZE)
  {
    uvec2 met = ahead[i >> 3];
    if ((i & 7u & ~met.y) == 0u)
    {
      EnterLevelOf(met.x);
      ivec3 block = BlockCoordinates(met.x) + SideOffset(int(i & 7u));
      if (SlotOf(block) == NONE)
      {
        RequestBlock(block);
      }
    }
  }
}

// Asks for what so many rays wait for.
void RequestFor(uint first, uint rays, uint speculation)
{
  if (gl_LocalInvocationIndex == 0u)
  {
    aheadCount = 0u;
  }
  OpenRequests();
  barrier();
  uint index = first + gl_LocalInvocationIndex;
  if (gl_LocalInvocationIndex < rays && index < control.NextWaitingRays)
  {
    uint pixel = NextRay(index);
    if (!BehindFrontier(pixel))
    {
      LookAhead(pixel, speculation);
    }
  }
  barrier();
  RequestMissing();
  CloseRequests();
  barrier();
}

void main()
{
  // no looking ahead if there is no room for what is needed now
  uint speculation =
    control.Frontier < PixelsInTiles() ? 1u : Speculation(control.NextWaitingRays);
  uint rays = RaysPerRequestGroup(speculation);
  for (uint first = rays * gl_WorkGroupID.x; first < control.NextWaitingRays;
       first += rays * gl_NumWorkGroups.x)
  {
    RequestFor(first, rays, speculation);
  }
}
