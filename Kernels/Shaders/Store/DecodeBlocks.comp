// Decompression (section 3.5): of the blocks that rays have asked for, into free cache slots; or, where there is no
// cache, of the whole volume.
// In: CacheRequests, CacheFreeSlots, Stream. Out: CacheValues, CacheMap, Macrocells, Control.

#define CACHE_BY_ROWS

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Store/BlockStore.glsl"
#include "Store/ZFPDecode.glsl"

#ifdef HAS_CACHE_MAP
// The block's bit is cleared for the next pass; it gets the slot whose turn it is, and its place on the map.
uint SlotFor(uint i, uint block)
{
  ivec3 coordinates = BlockCoordinates(block);
  uint cell = MacrocellIndex(coordinates >> 2);
  uint local = LocalIndex(coordinates);
  atomicAnd(macrocells[cell].Requested[local >> 5], ~(1u << (local & 31u)));
  if (i >= control.FreeSlots)
  {
    return NONE;
  }
  uint ring = 2u * cache.Slots;
  uint slot = cacheFreeSlots[(control.FreeSlotsBegin + i) % ring];
  uint page = macrocells[cell].Page;
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

uint FirstSlot()
{
  return 0u;
}

#include "Store/DecodeListed.glsl"
