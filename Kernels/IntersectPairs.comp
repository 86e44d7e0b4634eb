// Ray tracing blocks that only a few rays visit: a work group a block would leave most of its lanes idle, so
// here an invocation takes one ray through one block and reads the values from the cache itself. Pairs that
// stand side by side belong to neighbouring pixels, hence share most of what they read.
// In: LiveRays, PairBlock, PairEntry, CacheMap, CacheValues. Out: RayHit.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "Intersection.glsl"
#include "BlockWalk.glsl"

layout(local_size_x = 64) in;

uint cornerSlots[8]; // of the block and its + neighbours

void FindSlots(ivec3 block)
{
  for (int i = 0; i < 8; ++i)
  {
    ivec3 other = block + (ivec3(i) >> ivec3(0, 1, 2) & 1);
    uint entry = InGrid(other) ? FindEntry(BlockIndex(other)) : NONE;
    cornerSlots[i] = entry == NONE ? 0u : cacheMap[entry].Slot; // no cell reaches beyond the grid
  }
}

void LoadCorners(uvec3 local, out float w[8])
{
  for (uint i = 0u; i < 8u; ++i)
  {
    uvec3 voxel = local + (uvec3(i) >> uvec3(0u, 1u, 2u) & 1u);
    uvec3 beyond = voxel >> 2;
    uint slot = cornerSlots[beyond.x + 2u * beyond.y + 4u * beyond.z];
    voxel &= 3u;
    uint bits = cacheValues[slot * 64u + voxel.x + 4u * voxel.y + 16u * voxel.z];
    precise float value = (uintBitsToFloat(bits) - scene.Isovalue.x) - scene.Isovalue.y;
    w[i] = value;
  }
}

bool CellCrossed(uvec3 local)
{
  float w[8];
  LoadCorners(local, w);
  return Straddle(w);
}

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  uint pairs = control.LiveRays * control.Speculation;
  for (uint i = gl_GlobalInvocationID.x; i < pairs; i += stride)
  {
    uint entry = pairEntry[i];
    if (entry != NONE && cacheMap[entry].Offset == UNGROUPED)
    {
      ivec3 block = BlockCoordinates(pairBlock[i]);
      FindSlots(block);
      TraceRay(liveRays[i / control.Speculation], block);
    }
  }
}
