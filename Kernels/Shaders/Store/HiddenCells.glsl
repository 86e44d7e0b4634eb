// Cells in which there is no surface, as a volume's mask says (see vtkBlockMask): of every block 64 bits, bit x + 4y + 16z
// for the cell with that lowest corner. They come with a block into its cache slot; only what has no slot searches the runs.

#ifdef BUFFER_HIDDEN_CELLS
// A block's bits: those of the last run that begins at or before it.
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

// In units of four words: where a slot's bits are in the buffer of values.
uint HiddenRow(uint slot)
{
#ifdef COLORED
  return 32u * NumberOfSlots() + slot;
#else
  return 16u * NumberOfSlots() + slot;
#endif
}

#if defined(BUFFER_CACHE_VALUES) && !defined(CACHE_BY_ROWS)
// The bits that came with a block into its slot.
uvec2 HiddenInSlot(uint slot)
{
  uint at = 4u * HiddenRow(slot);
  return uvec2(cacheValues[at], cacheValues[at + 1u]);
}
#endif

bool Hides(uvec2 hidden, ivec3 cell)
{
  uvec3 local = uvec3(cell) & 3u;
  uint bit = local.x + 4u * local.y + 16u * (local.z & 1u);
  return ((local.z < 2u ? hidden.x : hidden.y) >> bit & 1u) != 0u;
}
