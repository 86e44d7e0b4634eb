// Mark visible blocks (section 3.4) and count their rays, the histogram of the counting sort that
// groups rays by block (section 3.6). The first ray to ask for a block lists it.
// In: PairBlock. Out: PairEntry, CacheMap, CacheVisible, Control.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "BlockMap.glsl"
#include "Marking.glsl"

layout(local_size_x = 64) in;

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  uint pairs = control.LiveRays * control.Speculation;
  for (uint i = gl_GlobalInvocationID.x; i < pairs; i += stride)
  {
    uint block = pairBlock[i];
    pairEntry[i] = block == NONE ? NONE : MarkBlock(block, DUAL_GRID_NEEDS);
  }
}
