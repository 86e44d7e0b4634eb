// The blocks that the normals of the new hits need: central differences reach a voxel beyond the cell,
// also to the -x, -y and -z sides, which the intersection did not ask for.
// In: RayHit, RayBlock, PixelColor. Out: PairEntry, CacheMap, CacheVisible, Control.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "Marking.glsl"
#include "Hits.glsl"

layout(local_size_x = 64) in;

void main()
{
  uint pixels = uint(scene.Image.x * scene.Image.y);
  uint stride = gl_NumWorkGroups.x * 64u;
  for (uint pixel = gl_GlobalInvocationID.x; pixel < pixels; pixel += stride)
  {
    if (!AwaitsShading(pixel))
    {
      continue;
    }
    ivec3 cell = HitOf(pixel).Cell;
    ivec3 block = cell >> 2;
    ivec3 low = max((cell - 1) >> 2, ivec3(0)) - block;
    ivec3 high = min((cell + 2) >> 2, scene.Blocks.xyz - 1) - block;
    uint needs = 0u;
    for (uint i = 0u; i < 8u; ++i)
    {
      bvec3 side = notEqual(uvec3(i) & uvec3(1u, 2u, 4u), uvec3(0u));
      needs |= NeighbourBit(ivec3(side.x ? high.x : low.x, side.y ? high.y : low.y, side.z ? high.z : low.z));
    }
    pairEntry[pixel] = MarkBlock(BlockIndex(block), needs);
  }
}
