// Macrocell grid traversal (sections 3.3 and 4.1): every live ray walks on from the block where it
// stopped and asks for the next N_spec blocks whose range holds the isovalue.
// In: LiveRays, RayBlock, RayHit, BlockRanges, CoarseRanges. Out: PairBlock, RayBlock.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"

layout(local_size_x = 64) in;

void Traverse(uint index)
{
  uint pixel = liveRays[index];
  Ray ray = CameraRay(pixel);
  if (rayHit[pixel] != NO_HIT)
  {
    // a farther block was hit while a nearer one was deferred: nothing behind the hit matters
    ray.Leave = min(ray.Leave, HitT(ray, rayHit[pixel]));
  }
  uint limit = control.Speculation;
  uint first = index * limit;
  uint found = 0u;
  ivec3 block = BlockCoordinates(rayBlock[pixel]);
  bool inside = true;
  ivec3 coarse = ivec3(-1);
  uint coarseIndex = 0u;
  vec2 coarseRange = vec2(0.0);
  while (inside && found < limit)
  {
    if ((block >> 2) != coarse)
    {
      coarse = block >> 2;
      coarseIndex = CoarseIndex(coarse);
      coarseRange = coarseRanges[coarseIndex];
      if (!Straddles(coarseRange.x, coarseRange.y))
      {
        inside = SkipCoarseCell(ray, block);
        continue;
      }
    }
    if (BlockStraddles(coarseRange, coarseIndex, block))
    {
      pairBlock[first + found] = BlockIndex(block);
      ++found;
    }
    inside = NextBlock(ray, block);
  }
  rayBlock[pixel] = inside ? BlockIndex(block) : EXITED;
  for (uint i = found; i < limit; ++i)
  {
    pairBlock[first + i] = NONE;
  }
}

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  for (uint i = gl_GlobalInvocationID.x; i < control.LiveRays; i += stride)
  {
    Traverse(i);
  }
}
