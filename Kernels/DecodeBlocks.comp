// Decompression of the blocks that the cache lacked (section 3.5), one invocation a block.
// In: CacheDecodeList, CacheSlotBlock, Payload. Out: CacheValues.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "BlockStore.glsl"
#include "ZFPDecode.glsl"

layout(local_size_x = 32) in;

shared uint groupSlots[ZFP_LANES];

void main()
{
  uint lane = gl_LocalInvocationIndex;
  uint stride = gl_NumWorkGroups.x * ZFP_LANES;
  for (uint first = gl_WorkGroupID.x * ZFP_LANES; first < control.DecodedBlocks; first += stride)
  {
    uint count = min(ZFP_LANES, control.DecodedBlocks - first);
    if (lane < count)
    {
      uint slot = cacheDecodeList[first + lane];
      groupSlots[lane] = slot;
      DecodeBlock(cacheSlotBlock[slot], lane);
    }
    barrier();
    // the group writes block after block, in consecutive words
    for (uint i = lane; i < count * 64u; i += ZFP_LANES)
    {
      uint column = i >> 6;
      cacheValues[groupSlots[column] * 64u + (i & 63u)] = zfpColumns[ColumnIndex(i & 63u, column)];
    }
    barrier();
  }
}
