// Asking for blocks: the stages that know which blocks are wanted call this, AdmitBlocks.comp answers.

// Asks for a block and those of its neighbours in `needs`; the first to ask lists it as visible.
uint MarkBlock(uint block, uint needs)
{
  uint entry = InsertEntry(block, scene.Cache.y / 4u * 3u); // the rest is for what blocks need beside them
  if (entry == NONE)
  {
    atomicAdd(control.DeferredBlocks, 1u);
    return NONE;
  }
  if ((cacheMap[entry].Needs & needs) != needs)
  {
    atomicOr(cacheMap[entry].Needs, needs);
  }
  if (atomicAdd(cacheMap[entry].Rays, 1u) == 0u)
  {
    uint at = atomicAdd(control.VisibleBlocks, 1u);
    cacheVisible[at] = entry;
    if (at % 64u == 0u && at / 64u < MAX_GROUPS)
    {
      atomicAdd(control.AdmitGroups.X, 1u);
    }
  }
  return entry;
}
