// Every storage buffer of the pipeline, as the GPU sees it. Who writes and who reads each of them,
// and its size, stands in Buffers.h; a stage gets BINDING_* only for the buffers it is given there.

#ifdef BINDING_CONTROL
// A dispatch whose size the GPU decides: three group counts and a pad.
struct Dispatch
{
  uint X, Y, Z, Pad;
};
layout(std430, binding = BINDING_CONTROL) buffer Control
{
  uint LiveRays;     // rays that take part in this pass
  uint NextLiveRays; // rays that go on to the next one
  uint Speculation;  // ray-block pairs a ray may ask for in this pass (N_spec, section 4)
  uint PassSerial;   // counts passes over the cache's whole life: the clock of the LRU
  uint PassIndex;    // passes of this image
  uint Pairs;        // ray-block pairs to be intersected in this pass
  uint VisibleBlocks;
  uint ActiveBlocks;  // visible blocks and those their dual grids reach into
  uint DecodedBlocks; // blocks that were not in the cache
  uint WorkItems;
  uint ReservedSlots; // bound on the slots this pass takes
  uint DeferredBlocks; // visible blocks for which the cache had no room: the next pass retries
  uint FreeHead;      // ring of free slots: first one, and how many
  uint FreeSlots;
  uint MapUsed;       // occupied entries of the block map
  uint EvictSlots;    // slots still to be freed
  uint UnshadedHits;  // hits left unshaded for want of cache
  uint AdmittedBlocks; // visible blocks that are intersected in this pass
  uint Evicted;        // blocks of the threshold age evicted so far
  uint ControlPad;
  Dispatch TraverseGroups;
  Dispatch PairGroups;
  Dispatch AdmitGroups;
  Dispatch DecodeGroups;
  Dispatch IntersectGroups;
  Dispatch EvictGroups;
  uint Ages[256]; // histogram of the cached blocks' ages, in passes
}
control;
#endif

#ifdef BINDING_PASS_STATISTICS
struct PassRecord
{
  uint ActiveRays, Speculation, Pairs, VisibleBlocks;
  uint ActiveBlocks, DecodedBlocks, CachedBlocks, RemainingRays;
  uint DeferredBlocks, Pad0, Pad1, Pad2;
};
layout(std430, binding = BINDING_PASS_STATISTICS) buffer PassStatistics { PassRecord passRecords[]; };
#endif

// ---- the volume
#ifdef BINDING_PAYLOAD
layout(std430, binding = BINDING_PAYLOAD) readonly buffer PayloadBuffer { uint payload[]; };
#endif
#ifdef BINDING_COARSE_RANGES
layout(std430, binding = BINDING_COARSE_RANGES) buffer CoarseRanges { vec2 coarseRanges[]; };
#endif
#ifdef BINDING_BLOCK_RANGES
// Two blocks a word; each 8 + 8 bits: range within that of its coarse cell.
layout(std430, binding = BINDING_BLOCK_RANGES) buffer BlockRanges { uint blockRanges[]; };
#endif

// ---- the rays, one element a pixel
#ifdef BINDING_RAY_BLOCK
layout(std430, binding = BINDING_RAY_BLOCK) buffer RayBlock { uint rayBlock[]; };
#endif
#ifdef BINDING_RAY_HIT
layout(std430, binding = BINDING_RAY_HIT) buffer RayHit { uint rayHit[]; };
#endif
#ifdef BINDING_LIVE_RAYS
layout(std430, binding = BINDING_LIVE_RAYS) buffer LiveRays { uint liveRays[]; };
#endif
#ifdef BINDING_NEXT_LIVE_RAYS
layout(std430, binding = BINDING_NEXT_LIVE_RAYS) buffer NextLiveRays { uint nextLiveRays[]; };
#endif
#ifdef BINDING_PIXEL_COLOR
layout(std430, binding = BINDING_PIXEL_COLOR) buffer PixelColor { uint pixelColor[]; };
#endif

// ---- the ray-block pairs of one pass: the "virtual GPU" of section 4
#ifdef BINDING_PAIR_BLOCK
layout(std430, binding = BINDING_PAIR_BLOCK) buffer PairBlock { uint pairBlock[]; };
#endif
#ifdef BINDING_PAIR_ENTRY
layout(std430, binding = BINDING_PAIR_ENTRY) buffer PairEntry { uint pairEntry[]; };
#endif
#ifdef BINDING_GROUPED_RAYS
layout(std430, binding = BINDING_GROUPED_RAYS) buffer GroupedRays { uint groupedRays[]; };
#endif

// ---- the block cache
#ifdef BINDING_CACHE_VALUES
layout(std430, binding = BINDING_CACHE_VALUES) buffer CacheValues { uint cacheValues[]; };
#endif
#ifdef BINDING_CACHE_MAP
struct MapEntry
{
  uint Block;  // key; NONE: free entry
  uint Slot;   // where the block's values are; NONE: not in the cache
  uint Rays;   // pairs of this pass that ask for the block; 0: not visible
  uint Offset; // where its rays stand in groupedRays; UNGROUPED: nowhere; NONE: deferred to the next pass
  uint Needs;  // neighbours wanted beside it, a bit each (see NeighbourBit)
};
layout(std430, binding = BINDING_CACHE_MAP) coherent buffer CacheMap { MapEntry cacheMap[]; };
#endif
#ifdef BINDING_CACHE_SLOT_BLOCK
layout(std430, binding = BINDING_CACHE_SLOT_BLOCK) buffer CacheSlotBlock { uint cacheSlotBlock[]; };
#endif
#ifdef BINDING_CACHE_SLOT_STAMP
layout(std430, binding = BINDING_CACHE_SLOT_STAMP) buffer CacheSlotStamp { uint cacheSlotStamp[]; };
#endif
#ifdef BINDING_CACHE_FREE_SLOTS
layout(std430, binding = BINDING_CACHE_FREE_SLOTS) buffer CacheFreeSlots { uint cacheFreeSlots[]; };
#endif
#ifdef BINDING_CACHE_VISIBLE
layout(std430, binding = BINDING_CACHE_VISIBLE) buffer CacheVisible { uint cacheVisible[]; };
#endif
#ifdef BINDING_CACHE_DECODE_LIST
layout(std430, binding = BINDING_CACHE_DECODE_LIST) buffer CacheDecodeList { uint cacheDecodeList[]; };
#endif
#ifdef BINDING_CACHE_WORK_ITEMS
struct WorkItem
{
  uint Block, FirstRay, RayCount;
};
layout(std430, binding = BINDING_CACHE_WORK_ITEMS) buffer CacheWorkItems { WorkItem cacheWorkItems[]; };
#endif
