// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What storage buffers consist of. GLSL (Buffers.glsl) and C++ (Glsl.h) read this file.

// A dispatch whose size the GPU decides.
struct Dispatch
{
  uint X;
  uint Y;
  uint Z;
  uint Padding0;
};

#ifdef BUFFER_CONTROL
STORAGE_BLOCK(Control, BUFFER_CONTROL)
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
  uint Pairs;          // ray-block pairs that were intersected
  uint Requests;       // blocks asked for, each once
  uint DeniedRequests; // of these, blocks for which the cache had no room
  uint VisibleBlocks;  // distinct blocks that were intersected; only for detailed statistics
  uint ActiveBlocks;   // these, and the neighbours that rays reach into
  uint TouchedSlots;   // cached blocks on map pages that this image used
  // the cache: rings of free slots and of free map pages, where they begin and how many there are
  uint FreeSlotsBegin;
  uint FreeSlots;
  uint ReturnedSlots; // taken for blocks that no map page could be found for
  uint FreePagesBegin;
  uint FreePages;
  uint TakenPages;
  uint EvictWanted;          // units to be freed: see PlanEviction in PlanCache.glsl
  uint EvictByPages;         // 1: a page counts as one unit; 0: as many as it has slots
  uint Evicted;              // units of the threshold age freed so far
  uint DeniedRequestsBefore; // of the pass before
  uint ContinuingRays;       // the last pass's translucent hits, behind which rays may go on
  uint NextContinuingRays;   // rays that go on behind hits of this pass
  uint KeptSlotsBegin;       // while the cache grows: FreeSlotsBegin of the ring, unwound,
  uint KeptFreeSlots;        // and the free slots before
  uint Padding0;
  Dispatch CastGroups;
  Dispatch StragglerGroups; // of CastStragglers instead, when few rays are left
  Dispatch FinishGroups;
  Dispatch RequestGroups;
  Dispatch DecodeGroups;
  Dispatch EvictGroups;
  uint Ages[PASS_AGES]; // units on pages by their ages, in passes
}
INSTANCE(control);
#endif

// What a pass did, for the statistics.
struct PassRecord
{
  uint ActiveRays;
  uint Speculation;
  uint Pairs;
  uint VisibleBlocks;
  uint ActiveBlocks;
  uint DecodedBlocks;
  uint CachedBlocks;
  uint RemainingRays;
  uint RefusedBlocks;
  uint TouchedSlots;
  uint Padding0;
  uint Padding1;
};

struct Macrocell
{
  float Low; // range of the dual grids of its blocks
  float High;
#ifdef HAS_CACHE_MAP
  uint Page;         // of the block map, where its blocks' cache slots stand
  uint Requested[2]; // blocks asked for in this pass, a bit each
#endif
  // of its blocks' dual grids, two a word, 8 + 8 bits each: steps within its own range
  uint Ranges[BLOCKS_PER_MACROCELL / 2];
};

// A page of the block map: the slots of a macrocell's blocks.
struct MapPage
{
  uint Owner; // the macrocell; NONE: the page is free
  uint Stamp; // last pass that used it
  uint Used;  // slots on it
  uint Free;  // not of this page: an element of the ring of free pages
  uint Slots[BLOCKS_PER_MACROCELL];
};
