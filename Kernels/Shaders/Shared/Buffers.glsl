// Every storage buffer of the pipeline, as the GPU sees it. docs/reference/buffers.md has their sizes, and who reads
// and writes them. The assembler defines BUFFER_X as the declaration of a buffer up to its block's name, in stages that
// use it only, and HAS_X in all stages if the scene needs buffer X.

#ifdef BUFFER_CONTROL
// A dispatch whose size the GPU decides: three group counts and a pad.
struct Dispatch
{
  uint X, Y, Z, Pad;
};
BUFFER_CONTROL Control
{
  // the rays of this pass: those carried over in a list, then fresh ones in tile order
  uint Rays;
  uint Carried;
  uint NextCarried; // rays that go on to the next pass
  uint List;        // which of the two lists they stand in, 0 or 1
  uint Fresh;       // first pixel, in tile order, whose ray has not begun
  uint Frontier;    // rays of pixels from here on, in tile order, wait: the cache has no room for them
  uint Window;      // pixels from the first live one to the frontier
  uint FirstLive;   // least tile order of a live ray
  uint Unlit;       // hits without a normal, which stand in the same list from its end on
  uint NextUnlit;   // of these, such as have to wait for blocks
  uint PassSerial;  // counts passes over the cache's whole life: the clock of the LRU
  uint ImageSerial; // first pass of this image
  uint PassIndex;   // passes of this image
  uint NewImage;    // set by the CPU: the next pass is the first of an image
  // what the pass did
  uint ActiveRays;    // rays that were cast, without those that miss the volume or wait
  uint Pairs;         // ray-block pairs that were intersected
  uint Requests;      // blocks asked for, each once
  uint Refused;       // of these, blocks for which the cache had no room
  uint VisibleBlocks; // distinct blocks that were intersected, and those and the neighbours they reach
  uint ActiveBlocks;  // into; counted only for detailed statistics
  uint TouchedSlots;  // cached blocks on map pages that this image used
  // the cache: rings of free slots and of free map pages, where they begin and how many there are
  uint FreeSlotsBegin;
  uint FreeSlots;
  uint ReturnedSlots; // taken for blocks that no map page could be found for
  uint FreePagesBegin;
  uint FreePages;
  uint TakenPages;
  uint EvictWanted;  // units to be freed: see PlanEviction in PlanPass.comp
  uint EvictByPages; // 1: a page counts as one unit; 0: as many as it has slots
  uint Evicted;      // units of the threshold age freed so far
  uint RefusedBefore; // blocks for which the pass before had no room
  uint Again;         // translucent hits of the last pass: their rays go on, where they do
  uint GoingOn;       // of this pass, rays that go on behind such a hit
  uint ControlPad0, ControlPad1, ControlPad2;
  Dispatch CastGroups;
  Dispatch FewGroups; // where few rays are left, of CastFewRays instead
  Dispatch NormalGroups;
  Dispatch RequestGroups;
  Dispatch DecodeGroups;
  Dispatch EvictGroups;
  uint Ages[256]; // units on pages by their ages, in passes
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
  uint Ranges[32]; // of its 64 blocks' dual grids, two a word: steps within its own range, 8 + 8 bits each
};
BUFFER_MACROCELLS Macrocells { Macrocell macrocells[]; };
#endif
#ifdef BUFFER_HIDDEN_CELLS
// Which cells are hidden, as runs of blocks that are alike: how many runs there are, the first block of each, and then two
// words of bits for each. See HiddenCells.glsl.
BUFFER_HIDDEN_CELLS HiddenCells { uint hiddenRuns; uint hiddenCells[]; };
#endif

// ---- the image
#ifdef BUFFER_HITS
// What a pixel's ray has met, see Hits.glsl.
BUFFER_HITS Hits { uint hits[]; };
#endif
#ifdef BUFFER_LAYERS
// What the layers of a translucent image add up to, front to back: colour times opacity, opacity; 4 x 16 bits.
BUFFER_LAYERS Layers { uvec2 layers[]; };
#endif
#ifdef BUFFER_NORMALS
BUFFER_NORMALS Normals { uint normals[]; };
#endif
#ifdef BUFFER_RAYS
// For every pixel the block that its live ray waits for or goes on in; then two lists, in turn, of the pixels of live rays, and from
// their ends on of hits without a normal.
BUFFER_RAYS Rays { uint rays[]; };
#endif

// ---- the block cache
#ifdef BUFFER_CACHE_VALUES
// 64 samples a slot, x fastest; behind all slots likewise those of the volume that gives the colours, and then, where cells
// are hidden, 4 words a slot: the bits of its block's cells, and two of no use. A stage that defines CACHE_BY_ROWS has all in
// rows of four.
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
