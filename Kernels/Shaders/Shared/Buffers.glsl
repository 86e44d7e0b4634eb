// Every storage buffer of the pipeline, as the GPU sees it. docs/reference/buffers.md has their
// sizes, and who reads and writes them. The assembler defines BUFFER_X as the declaration of a
// buffer up to its block's name, in stages that use it, WRITES_X in those that write it, and HAS_X
// in all stages if the scene needs buffer X.

#include "Shared/Scene.glsl"

#ifdef BUFFER_CONTROL
// A dispatch whose size the GPU decides: three group counts and a pad.
struct Dispatch
{
  uint X, Y, Z, Pad;
};
BUFFER_CONTROL Control
{
  // the rays of this pass: waiting ones, continuing ones, then new ones in tile order
  uint Rays;
  uint WaitingRays;     // for blocks, since the last pass
  uint NextWaitingRays; // of the next pass
  uint Queue;           // which of the two queues is this pass's, 0 or 1: see RayQueues.glsl
  uint FirstNewRay;     // first pixel, in tile order, whose ray has not begun
  uint Frontier;        // first pixel, in tile order, for whose ray the cache has no room: it waits
  uint Window;          // pixels from the first live one to the frontier
  uint FirstLive;       // least tile order of a live ray
  uint PendingHits;     // of this pass, to be finished: given a normal or colour, or blended
  uint PostponedHits;   // of these, such as have to wait for blocks: pending in the next pass
  uint PassSerial;      // counts passes over the cache's whole life: the clock of the LRU
  uint ImageSerial;     // first pass of this image
  uint PassIndex;       // passes of this image
  uint NewImage;        // set by the CPU: the next pass is the first of an image
  // what the pass did
  uint ActiveRays;     // rays that were cast, without those that miss the volume or wait
  uint Pairs;         // ray-block pairs that were intersected
  uint Requests;      // blocks asked for, each once
  uint DeniedRequests; // of these, blocks for which the cache had no room
  uint VisibleBlocks; // distinct blocks that were intersected; only for detailed statistics
  uint ActiveBlocks;  // likewise, with the neighbours that rays reach into
  uint TouchedSlots;  // cached blocks on map pages that this image used
  // the cache: rings of free slots and of free map pages, where they begin and how many there are
  uint FreeSlotsBegin;
  uint FreeSlots;
  uint ReturnedSlots; // taken for blocks that no map page could be found for
  uint FreePagesBegin;
  uint FreePages;
  uint TakenPages;
  uint EvictWanted;  // units to be freed: see PlanEviction in PlanCache.glsl
  uint EvictByPages; // 1: a page counts as one unit; 0: as many as it has slots
  uint Evicted;      // units of the threshold age freed so far
  uint DeniedRequestsBefore; // of the pass before
  uint ContinuingRays;     // the last pass's translucent hits, behind which rays may go on
  uint NextContinuingRays; // rays that go on behind hits of this pass
  uint ControlPad0, ControlPad1, ControlPad2;
  Dispatch CastGroups;
  Dispatch StragglerGroups; // of CastStragglers instead, when few rays are left
  Dispatch FinishGroups;
  Dispatch RequestGroups;
  Dispatch DecodeGroups;
  Dispatch EvictGroups;
  uint Ages[PASS_AGES]; // units on pages by their ages, in passes
}
control;
#endif

#ifdef BUFFER_PASS_STATISTICS
struct PassRecord
{
  uint ActiveRays, Speculation, Pairs, VisibleBlocks;
  uint ActiveBlocks, DecodedBlocks, CachedBlocks, RemainingRays;
  uint RefusedBlocks, TouchedSlots, Pad0, Pad1;
};
BUFFER_PASS_STATISTICS PassStatistics { PassRecord passRecords[]; };
#endif

// ---- the volume
#ifdef BUFFER_STREAM
BUFFER_STREAM StreamBuffer { uint stream[]; };
#endif
#ifdef BUFFER_MACROCELLS
struct Macrocell
{
  float Low, High; // range of the dual grids of its blocks
#ifdef HAS_CACHE_MAP
  uint Page;         // of the block map, where its blocks' cache slots stand
  uint Requested[2]; // blocks asked for in this pass, a bit each
#endif
  // ranges of its 64 blocks' dual grids, two a word, 8 + 8 bits each: steps within its own range
  uint Ranges[32];
};
BUFFER_MACROCELLS Macrocells { Macrocell macrocells[]; };
#endif
#ifdef BUFFER_HIDDEN_CELLS
// Which cells are hidden, as runs of blocks that are alike: their number, the first block of each,
// then two words of bits for each. See HiddenCells.glsl.
BUFFER_HIDDEN_CELLS HiddenCells
{
  uint hiddenRuns;
  uint hiddenCells[];
};
#endif

// ---- the image
#ifdef BUFFER_HITS
// What a pixel's ray has met, see Hits.glsl.
BUFFER_HITS Hits { uint hits[]; };
#endif
#ifdef BUFFER_LAYERS
// What the layers of a translucent image add up to, front to back: colour times opacity, and
// opacity, in 4 x 16 bits.
BUFFER_LAYERS Layers { uvec2 layers[]; };
#endif
#ifdef BUFFER_NORMALS
BUFFER_NORMALS Normals { uint normals[]; };
#endif
#ifdef BUFFER_RAYS
BUFFER_RAYS Rays { uint rayQueues[]; }; // see RayQueues.glsl
#endif

// ---- the block cache
#ifdef BUFFER_CACHE_VALUES
// See SlotLayout.glsl. A stage that defines CACHE_BY_ROWS has all in rows of four.
#ifdef CACHE_BY_ROWS
BUFFER_CACHE_VALUES CacheValues { uvec4 cacheRows[]; };
#else
BUFFER_CACHE_VALUES CacheValues { uint cacheValues[]; };
#endif
#endif
#ifdef BUFFER_CACHE_MAP
struct MapPage
{
  uint Cell;  // the macrocell it belongs to; NONE: free
  uint Stamp; // last pass that used it
  uint Used;  // slots on it
  uint Free;  // not of this page: an element of the ring of free pages
  uint Slots[64];
};
BUFFER_CACHE_MAP CacheMap { MapPage mapPages[]; };
#endif
#ifdef BUFFER_CACHE_FREE_SLOTS
BUFFER_CACHE_FREE_SLOTS CacheFreeSlots { uint cacheFreeSlots[]; };
#endif
#ifdef BUFFER_CACHE_REQUESTS
BUFFER_CACHE_REQUESTS CacheRequests { uint cacheRequests[]; };
#endif
#ifdef BUFFER_CACHE_SEEN
// The last passes in which a slot's block was intersected, and in which it was needed at all.
BUFFER_CACHE_SEEN CacheSeen { uint cacheSeen[]; };
#endif
