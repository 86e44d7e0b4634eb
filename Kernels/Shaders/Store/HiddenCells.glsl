// Cells in which there is no surface because the volume's mask hides them (see vtkBlockMask). A
// block has 64 bits, see HoldsCell. They are copied into the block's cache slot, so that only
// blocks without a slot have to search the runs.

#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"

#ifdef BUFFER_HIDDEN_CELLS
// Bits of a block: those of the last run that begins at or before it.
uvec2 FindHiddenCells(uint block)
{
  uint low = 0u; // the first run begins at block 0
  uint high = hiddenRuns;
  while (high - low > 1u)
  {
    uint middle = (low + high) / 2u;
    if (hiddenCells[middle] <= block)
    {
      low = middle;
    }
    else
    {
      high = middle;
    }
  }
  return uvec2(hiddenCells[hiddenRuns + 2u * low], hiddenCells[hiddenRuns + 2u * low + 1u]);
}
#endif
