// Asking for the blocks that rays wait for (section 3.4), and ahead: the fewer rays are left, the more of the next blocks
// along it whose range holds the isovalue does each ask for (N_spec, sections 4 and 4.1). Each of them is asked for with
// those neighbours that the ray's way through its dual grid reaches into. The lanes first walk a ray each, then look up
// what the walks have met, a block or neighbour each.
// In: Rays, Macrocells, CacheMap. Out: CacheRequests, CacheMap, Macrocells, Control.

#define AHEAD 256u // blocks that a work group's rays may meet

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Shared/Grid.glsl"
#include "Rays/TraverseGrid.glsl"
#include "Cache/BlockMap.glsl"
#include "Rays/BlockReach.glsl"
#include "Cache/Requests.glsl"
#include "Rays/RayQueues.glsl"

shared uvec2 ahead[AHEAD]; // block, and its reach in the lowest three bits
shared uint aheadCount;

void LookAhead(uint pixel, uint speculation)
{
  Ray ray = CameraRay(pixel);
  ivec3 block = BlockCoordinates(rays[pixel]);
  GridCursor at = OutsideGrid();
  for (uint i = 0u; i < speculation && FindActiveBlock(ray, block, at); ++i)
  {
    ivec3 reach = DualGridReach(ray, block, BlockEntry(ray, block), BlockExit(ray, block));
    ahead[atomicAdd(aheadCount, 1u)] = uvec2(BlockIndex(block), reach.x + 2 * reach.y + 4 * reach.z);
    if (!NextBlock(ray, block))
    {
      break;
    }
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
      ivec3 block = BlockCoordinates(met.x) + SideOffset(int(i & 7u));
      if (SlotOf(block) == NONE)
      {
        RequestBlock(block);
      }
    }
  }
}

void main()
{
  // no looking ahead where there is no room for what is needed now
  uint speculation = control.Frontier < PixelsInTiles() ? 1u : Speculation(control.NextCarried);
  uint raysPerGroup = min(GROUP_SIZE, AHEAD / speculation);
  uint index = raysPerGroup * gl_WorkGroupID.x + gl_LocalInvocationIndex;
  if (gl_LocalInvocationIndex == 0u)
  {
    aheadCount = 0u;
  }
  OpenRequests();
  barrier();
  if (gl_LocalInvocationIndex < raysPerGroup && index < control.NextCarried)
  {
    uint pixel = rays[NextList(index)];
    if (!BehindFrontier(pixel))
    {
      LookAhead(pixel, speculation);
    }
  }
  barrier();
  RequestMissing();
  CloseRequests();
}
