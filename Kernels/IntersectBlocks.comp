// Ray tracing the visible blocks (section 3.7): a work group loads the 5^3 values of a block's dual grid
// and walks its rays through the cells; the nearest hit of a ray is kept by an atomic minimum on its key.
// In: CacheWorkItems, GroupedRays, CacheMap, CacheValues. Out: RayHit.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "Intersection.glsl"
#include "BlockWalk.glsl"

layout(local_size_x = 64) in;

#define DUAL_GRID 125u

shared uint cornerSlots[8];     // of the block and its + neighbours
shared float dualGrid[DUAL_GRID]; // value - isovalue
shared uint activeCells[2];     // cells whose corners lie on both sides, a bit each

void LoadDualGrid(ivec3 block)
{
  uint lane = gl_LocalInvocationIndex;
  if (lane < 8u)
  {
    ivec3 other = block + ivec3(lane & 1u, (lane >> 1) & 1u, lane >> 2);
    uint entry = InGrid(other) ? FindEntry(BlockIndex(other)) : NONE;
    cornerSlots[lane] = entry == NONE ? NONE : cacheMap[entry].Slot;
  }
  if (lane < 2u)
  {
    activeCells[lane] = 0u;
  }
  barrier();
  for (uint i = lane; i < DUAL_GRID; i += 64u)
  {
    uvec3 voxel = uvec3(i % 5u, (i / 5u) % 5u, i / 25u);
    uvec3 beyond = voxel >> 2;
    uint slot = cornerSlots[beyond.x + 2u * beyond.y + 4u * beyond.z];
    uvec3 local = voxel & 3u;
    // beyond the volume's last sample there are no cells, so the value does not matter
    uint bits = slot == NONE ? 0u : cacheValues[slot * 64u + local.x + 4u * local.y + 16u * local.z];
    precise float value = (uintBitsToFloat(bits) - scene.Isovalue.x) - scene.Isovalue.y;
    dualGrid[i] = value;
  }
  barrier();
}

void LoadCorners(uvec3 local, out float w[8])
{
  uint first = local.x + 5u * local.y + 25u * local.z;
  for (uint i = 0u; i < 8u; ++i)
  {
    w[i] = dualGrid[first + (i & 1u) + 5u * ((i >> 1) & 1u) + 25u * (i >> 2)];
  }
}

bool CellCrossed(uvec3 local)
{
  uint bit = local.x + 4u * local.y + 16u * local.z;
  return (activeCells[bit >> 5] & (1u << (bit & 31u))) != 0u;
}

// One lane a cell.
void FindActiveCells()
{
  uint lane = gl_LocalInvocationIndex;
  float w[8];
  LoadCorners(uvec3(lane & 3u, (lane >> 2) & 3u, lane >> 4), w);
  if (Straddle(w))
  {
    atomicOr(activeCells[lane >> 5], 1u << (lane & 31u));
  }
  barrier();
}

void main()
{
  for (uint item = gl_WorkGroupID.x; item < control.WorkItems; item += gl_NumWorkGroups.x)
  {
    WorkItem work = cacheWorkItems[item];
    ivec3 block = BlockCoordinates(work.Block);
    LoadDualGrid(block);
    FindActiveCells();
    if ((activeCells[0] | activeCells[1]) != 0u)
    {
      for (uint i = gl_LocalInvocationIndex; i < work.RayCount; i += 64u)
      {
        TraceRay(groupedRays[work.FirstRay + i], block);
      }
    }
    barrier();
  }
}
