// Every storage buffer of the pipeline, as the GPU sees it. docs/reference/buffers.md has their
// sizes, and who reads and writes them. The assembler defines BUFFER_X as the declaration of a
// buffer up to its block's name, in stages that use it, WRITES_X in those that write it, and HAS_X
// in all stages if the scene needs buffer X.

#include "Shared/Scene.glsl"

#define STORAGE_BLOCK(name, declaration) declaration name
#include "Shared/BufferStructs.glsl.h"

#ifdef BUFFER_PASS_STATISTICS
BUFFER_PASS_STATISTICS PassStatistics { PassRecord passRecords[]; };
#endif

// ---- the volume
#ifdef BUFFER_STREAM
BUFFER_STREAM StreamBuffer { uint stream[]; };
#endif
#ifdef BUFFER_MACROCELLS
BUFFER_MACROCELLS Macrocells { Macrocell macrocells[]; };
#endif
#ifdef BUFFER_BLOCK_MARKS
// Of each macrocell; with levels of detail three: see MarkBlocks.comp.
BUFFER_BLOCK_MARKS BlockMarks { uvec2 blockMarks[]; };
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
#ifdef BUFFER_HIDDEN_COLORS
// Likewise, which samples of the volume that gives the colours have no value.
BUFFER_HIDDEN_COLORS HiddenColors
{
  uint hiddenColorRuns;
  uint hiddenColors[];
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
#ifdef BUFFER_CELL_MARKS
BUFFER_CELL_MARKS CellMarks { uvec2 cellMarks[]; }; // see MarkCells.comp
#endif
#ifdef BUFFER_CACHE_MAP
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
