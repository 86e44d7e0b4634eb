// Cells in which there is no surface because the volume's mask hides them (see vtkBlockMask). A
// block has 64 bits, see HoldsCell. They are copied into the block's cache slot, so that only
// blocks without a slot have to search the runs. Likewise samples of the volume that gives the
// colours, which have no value.

#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"

// Bits of a block in a buffer of so many runs: those of the last run that begins at or before it.
#define FIND_IN_RUNS(number, words, block)                                                         \
  uint low = 0u; /* the first run begins at block 0 */                                             \
  uint high = number;                                                                              \
  while (high - low > 1u)                                                                          \
  {                                                                                                \
    uint middle = (low + high) / 2u;                                                               \
    bool before = words[middle] <= block;                                                          \
    low = before ? middle : low;                                                                   \
    high = before ? high : middle;                                                                 \
  }                                                                                                \
  return uvec2(words[number + 2u * low], words[number + 2u * low + 1u]);

#ifdef BUFFER_HIDDEN_CELLS
uvec2 FindHiddenCells(uint block)
{
  FIND_IN_RUNS(hiddenRuns, hiddenCells, block)
}
#endif

#ifdef BUFFER_HIDDEN_COLORS
uvec2 FindHiddenColors(uint block)
{
  FIND_IN_RUNS(hiddenColorRuns, hiddenColors, block)
}
#endif
