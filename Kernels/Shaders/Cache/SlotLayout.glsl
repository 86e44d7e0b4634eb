// Where things lie in the buffer of decoded samples: 64 samples a slot, x fastest; behind all slots
// likewise those of the volume that gives the colours; behind those, where cells are hidden, four
// words a slot, of which two are the bits of its block's cells. All slots are those that the buffer
// is laid out for: it may have memory for less.

#include "Shared/Buffers.glsl"
#include BLOCK_ACCESS

// The slot of a block's colours, from the slot of its samples.
uint ColorSlot(uint slot)
{
  return NumberOfSlots() + slot;
}

// In units of four words.
uint HiddenRow(uint slot)
{
#ifdef COLORED
  return 2u * uint(ROWS_PER_BLOCK) * NumberOfSlots() + slot;
#else
  return uint(ROWS_PER_BLOCK) * NumberOfSlots() + slot;
#endif
}

#if defined(HAS_HIDDEN_CELLS) && !defined(CACHE_BY_ROWS)
// The bits that came with a block into its slot.
uvec2 HiddenInSlot(uint slot)
{
  uint at = uint(BLOCK_SIDE) * HiddenRow(slot);
  return uvec2(cacheValues[at], cacheValues[at + 1u]);
}
#endif
