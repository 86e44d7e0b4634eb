// The block cache, admission (section 3.5): one invocation a visible block reserves slots for what its
// dual grid needs and the cache lacks, lists it for decoding, and allots its rays a run in GroupedRays.
// A block for which there is no room is deferred: the pass takes fewer rays, the result is the same.
// The first block of a pass always finds room, so every pass gets on.
// In: CacheVisible, CacheMap, CacheFreeSlots. Out: CacheMap, CacheSlotBlock, CacheSlotStamp,
// CacheDecodeList, CacheWorkItems, Control.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"

layout(local_size_x = 64) in;

bool Missing(uint block)
{
  uint entry = FindEntry(block);
  return entry == NONE || cacheMap[entry].Slot >= CLAIMED;
}

uint CountMissing(ivec3 block, uint needs)
{
  uint missing = 0u;
  for (; needs != 0u; needs &= needs - 1u)
  {
    ivec3 other = block + NeighbourOffset(uint(findLSB(needs)));
    missing += InGrid(other) && Missing(BlockIndex(other)) ? 1u : 0u;
  }
  return missing;
}

// Room for `count` more blocks? Reservations are never given back within a pass, and blocks that several
// ask for count several times; a cache with a slot for every block has room for all in any case.
bool Reserve(uint count)
{
  return count == 0u || scene.Cache.x >= uint(scene.Blocks.w) || atomicAdd(control.ReservedSlots, count) + count <= control.FreeSlots;
}

// Gives the block a slot and lists it for decoding.
void Fill(uint entry, uint block)
{
  uint at = atomicAdd(control.DecodedBlocks, 1u);
  uint slot = cacheFreeSlots[(control.FreeHead + at) % scene.Cache.x];
  cacheSlotBlock[slot] = block;
  cacheDecodeList[at] = slot;
  cacheMap[entry].Slot = slot;
  if (at % 32u == 0u && at / 32u < MAX_GROUPS)
  {
    atomicAdd(control.DecodeGroups.X, 1u);
  }
  atomicExchange(cacheSlotStamp[slot], control.PassSerial);
  atomicAdd(control.ActiveBlocks, 1u);
}

// Makes sure that the block is cached at the end of this pass and marks it as used now.
bool Activate(uint block)
{
  uint entry = InsertEntry(block, scene.Cache.y);
  if (entry == NONE)
  {
    return false;
  }
  uint slot = atomicCompSwap(cacheMap[entry].Slot, NONE, CLAIMED);
  if (slot == NONE)
  {
    Fill(entry, block);
  }
  else if (slot != CLAIMED && atomicExchange(cacheSlotStamp[slot], control.PassSerial) != control.PassSerial)
  {
    atomicAdd(control.ActiveBlocks, 1u);
  }
  return true;
}

bool Admit(ivec3 block, uint needs)
{
  if (!Reserve(CountMissing(block, needs)))
  {
    return false;
  }
  bool complete = true;
  for (; needs != 0u; needs &= needs - 1u)
  {
    ivec3 other = block + NeighbourOffset(uint(findLSB(needs)));
    complete = complete && (!InGrid(other) || Activate(BlockIndex(other)));
  }
  return complete;
}

// The offset of the counting sort needs no scan: runs may stand in any order. Long runs are cut into
// several work items, so that a block that fills the screen keeps more than one work group busy.
uint AllotRun(uint block, uint rays)
{
  uint first = atomicAdd(control.Pairs, rays);
  if (rays < scene.Payload.w)
  {
    return UNGROUPED; // IntersectPairs.comp sees to them
  }
  uint perItem = scene.Payload.z;
  uint items = (rays + perItem - 1u) / perItem;
  uint item = atomicAdd(control.WorkItems, items);
  for (uint i = 0u; i < items; ++i)
  {
    cacheWorkItems[item + i] = WorkItem(block, first + i * perItem, min(perItem, rays - i * perItem));
  }
  atomicMax(control.IntersectGroups.X, min(item + items, MAX_GROUPS));
  return first;
}

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  for (uint i = gl_GlobalInvocationID.x; i < control.VisibleBlocks; i += stride)
  {
    uint entry = cacheVisible[i];
    uint block = cacheMap[entry].Block;
    bool admitted = Admit(BlockCoordinates(block), cacheMap[entry].Needs);
    cacheMap[entry].Offset = admitted ? AllotRun(block, cacheMap[entry].Rays) : NONE;
    cacheMap[entry].Rays = 0u;
    cacheMap[entry].Needs = 0u;
    atomicAdd(control.AdmittedBlocks, admitted ? 1u : 0u);
    atomicAdd(control.DeferredBlocks, admitted ? 0u : 1u);
  }
}
