// Where a block's values are (sections 3.4 and 3.5). With a cache: the slots stand on map pages, one for every
// macrocell that has blocks in it; what a ray lacks it asks for, and DecodeBlocks.comp fills the requests.
// Without, the whole volume is decoded and a block's slot is its number.

uint slots[8]; // of a block (bit 0, 1, 2 of the index: a block further in x, y, z) and what is beside it

// Statistics of this invocation.
uint touchedSlots = 0u;
uint visibleBlocks = 0u;
uint activeBlocks = 0u;

ivec3 SideOffset(int i)
{
  return ivec3(i) >> ivec3(0, 1, 2) & 1;
}

uint SlotOf(ivec3 block)
{
#ifdef HAS_CACHE_MAP
  uint page = macrocells[CoarseIndex(block >> 2)].Page;
  return page >= CLAIMED ? NONE : mapPages[page].Slots[LocalIndex(block)];
#else
  return BlockIndex(block);
#endif
}

// Fills `slots` for the blocks from `first` to first + reach, a component 0 or 1; returns those that are
// missing, a bit each.
uint FindSlots(ivec3 first, ivec3 reach)
{
  uint missing = 0u;
  for (int i = 0; i < 8; ++i)
  {
    ivec3 side = SideOffset(i);
    slots[i] = all(lessThanEqual(side, reach)) ? SlotOf(first + side) : 0u;
    missing |= slots[i] == NONE ? 1u << i : 0u;
  }
  return missing;
}

uint SlotAt(bvec3 side)
{
  uint x0 = side.x ? slots[1] : slots[0];
  uint x1 = side.x ? slots[3] : slots[2];
  uint x2 = side.x ? slots[5] : slots[4];
  uint x3 = side.x ? slots[7] : slots[6];
  uint y0 = side.y ? x1 : x0;
  uint y1 = side.y ? x3 : x2;
  return side.z ? y1 : y0;
}

#ifdef HAS_CACHE_SEEN
void CountBlocks(ivec3 reach, bool intersected)
{
  if (intersected && atomicExchange(cacheSeen[2u * slots[0]], control.PassSerial) != control.PassSerial)
  {
    ++visibleBlocks;
  }
  for (int i = 0; i < 8; ++i)
  {
    if (all(lessThanEqual(SideOffset(i), reach)) &&
      atomicExchange(cacheSeen[2u * slots[i] + 1u], control.PassSerial) != control.PassSerial)
    {
      ++activeBlocks;
    }
  }
}
#endif

#ifdef HAS_CACHE_MAP
// The least recently used pages are the first to be evicted.
void UsePage(ivec3 coarse)
{
  uint page = macrocells[CoarseIndex(coarse)].Page;
  if (mapPages[page].Stamp != control.PassSerial)
  {
    uint before = atomicExchange(mapPages[page].Stamp, control.PassSerial);
    touchedSlots += before < control.ImageSerial ? mapPages[page].Used : 0u;
  }
}
#endif

// The blocks found last are about to be used.
void UseBlocks(ivec3 first, ivec3 reach, bool intersected)
{
#ifdef HAS_CACHE_SEEN
  CountBlocks(reach, intersected);
#endif
#ifdef HAS_CACHE_MAP
  ivec3 across = ((first + reach) >> 2) - (first >> 2);
  UsePage(first >> 2);
  for (int i = 1; i < 8 && across != ivec3(0); ++i)
  {
    if (all(lessThanEqual(SideOffset(i), across)))
    {
      UsePage((first >> 2) + SideOffset(i));
    }
  }
#endif
}

#ifdef HAS_CACHE_MAP
#define STAGED 1024u

shared uint stagedRequests[STAGED];
shared uint stagedCount;
shared uint stagedBegin;

// A free page of the map for a macrocell; NONE where there is none.
uint TakePage(uint cell)
{
  uint at = atomicAdd(control.TakenPages, 1u);
  if (at >= control.FreePages)
  {
    return NONE;
  }
  uint page = mapPages[(control.FreePagesBegin + at) % scene.Cache.y].Free;
  mapPages[page].Cell = cell;
  mapPages[page].Stamp = control.PassSerial;
  mapPages[page].Used = 0u;
  return page;
}

// Takes places on the list of requests, which DecodeBlocks.comp works through in groups of 32.
uint ReserveRequests(uint count)
{
  uint at = atomicAdd(control.Requests, count);
  atomicMax(control.DecodeGroups.X, min((at + count + 31u) / 32u, MAX_GROUPS));
  return at;
}

// What is behind the end of the list is refused, and may be asked for again.
void ListRequest(uint at, uint block)
{
  if (at < scene.Cache.x)
  {
    cacheRequests[at] = block;
    return;
  }
  ivec3 coordinates = BlockCoordinates(block);
  uint local = LocalIndex(coordinates);
  atomicAnd(macrocells[CoarseIndex(coordinates >> 2)].Requested[local >> 5], ~(1u << (local & 31u)));
}

// Asks for a block, unless another ray has already done so in this pass.
void RequestBlock(ivec3 block)
{
  uint cell = CoarseIndex(block >> 2);
  uint local = LocalIndex(block);
  uint bit = 1u << (local & 31u);
  if ((macrocells[cell].Requested[local >> 5] & bit) != 0u ||
    (atomicOr(macrocells[cell].Requested[local >> 5], bit) & bit) != 0u)
  {
    return;
  }
  if (macrocells[cell].Page == NONE && atomicCompSwap(macrocells[cell].Page, NONE, CLAIMED) == NONE)
  {
    macrocells[cell].Page = TakePage(cell);
  }
  uint at = atomicAdd(stagedCount, 1u);
  if (at < STAGED)
  {
    stagedRequests[at] = BlockIndex(block);
  }
  else
  {
    ListRequest(ReserveRequests(1u), BlockIndex(block));
  }
}

void RequestBlocks(ivec3 first, uint missing)
{
  for (; missing != 0u; missing &= missing - 1u)
  {
    RequestBlock(first + SideOffset(findLSB(missing)));
  }
}

// The work group's requests go to the list together.
void FlushRequests()
{
  barrier();
  uint count = min(stagedCount, STAGED);
  if (gl_LocalInvocationIndex == 0u && count > 0u)
  {
    stagedBegin = ReserveRequests(count);
  }
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < count; i += 64u)
  {
    ListRequest(stagedBegin + i, stagedRequests[i]);
  }
}
#endif
