// Decodes the blocks that rays have requested into free cache slots; without a cache, all blocks.
// Before there are any rays, it fills the empty cache with boxes of blocks, for BlockRanges.

#define CACHE_BY_ROWS

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Store/DecodeListed.glsl"

#ifdef HAS_CACHE_MAP
// Gives the block of request i the next free slot and enters it in the map; NONE if there is no
// slot or no map page. The block may be requested again in the next pass.
uint SlotFor(uint i, uint block)
{
  if (FillsBox())
  {
    return i;
  }
  EnterLevelOf(block);
  ivec3 coordinates = BlockCoordinates(block);
  uint macrocell = MacrocellIndex(MacrocellOf(coordinates));
  uint local = LocalIndex(coordinates);
  atomicAnd(macrocells[macrocell].Requested[local >> 5], ~(1u << (local & 31u)));
  if (i >= control.FreeSlots)
  {
    return NONE;
  }
  uint ring = 2u * cache.Slots;
  uint slot = cacheFreeSlots[(control.FreeSlotsBegin + i) % ring];
  uint page = macrocells[macrocell].Page;
  if (page == NONE)
  {
    uint at = control.FreeSlots + atomicAdd(control.ReturnedSlots, 1u);
    cacheFreeSlots[(control.FreeSlotsBegin + at) % ring] = slot;
    return NONE;
  }
  mapPages[page].Slots[local] = slot;
  mapPages[page].Stamp = control.PassSerial;
  atomicAdd(mapPages[page].Used, 1u);
  return slot;
}
#else
uint SlotFor(uint i, uint block)
{
  return block;
}
#endif

// Where the slots of the volume that is drawn begin.
uint FirstSlot()
{
  return 0u;
}
