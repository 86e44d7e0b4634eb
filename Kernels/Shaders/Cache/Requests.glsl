// Asks for blocks that are not in the cache. The first to ask for one in a pass lists it; a bit a
// block tells. A work group's requests go to the list together, and DecodeBlocks.comp fills them.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Shared/GroupAppend.glsl"

#define MAX_GROUP_REQUESTS 256u // that go together; what a group has beyond goes by itself

shared uint groupRequests[MAX_GROUP_REQUESTS];

// A free page of the map for a macrocell; NONE if there is none.
uint TakePage(uint macrocell)
{
  uint at = atomicAdd(control.TakenPages, 1u);
  if (at >= control.FreePages)
  {
    return NONE;
  }
  uint page = mapPages[(control.FreePagesBegin + at) % cache.MapPages].Free;
  mapPages[page].Owner = macrocell;
  mapPages[page].Stamp = control.PassSerial;
  mapPages[page].Used = 0u;
  return page;
}

// Reserves places in the list of requests, and sizes the dispatch of DecodeBlocks to match.
uint ReserveRequests(uint count)
{
  uint at = atomicAdd(control.Requests, count);
  atomicMax(
    control.DecodeGroups.X, min(GroupsOf(at + count, DECODE_BLOCKS_GROUP_SIZE), MAX_GROUPS));
  return at;
}

// Stores a request, or denies it if the list is full: it may be asked for again.
void StoreRequest(uint at, uint block)
{
  if (at < cache.Slots)
  {
    cacheRequests[at] = block;
    return;
  }
  EnterLevelOf(block);
  ivec3 coordinates = BlockCoordinates(block);
  uint local = LocalIndex(coordinates);
  uint macrocell = MacrocellIndex(MacrocellOf(coordinates));
  atomicAnd(macrocells[macrocell].Requested[local >> 5], ~(1u << (local & 31u)));
}

// Call first, with a barrier before any request.
void OpenRequests()
{
  OpenGroupList(REQUESTS);
}

// True for the first that asks in this pass.
bool IsFirstRequest(uint macrocell, uint local)
{
  uint bit = 1u << (local & 31u);
  return (macrocells[macrocell].Requested[local >> 5] & bit) == 0u &&
    (atomicOr(macrocells[macrocell].Requested[local >> 5], bit) & bit) == 0u;
}

// Asks for a block, unless another has already done so in this pass.
void RequestBlock(ivec3 block)
{
  uint macrocell = MacrocellIndex(MacrocellOf(block));
  if (!IsFirstRequest(macrocell, LocalIndex(block)))
  {
    return;
  }
  if (macrocells[macrocell].Page == NONE &&
    atomicCompSwap(macrocells[macrocell].Page, NONE, CLAIMED) == NONE)
  {
    macrocells[macrocell].Page = TakePage(macrocell);
  }
  uint place = AddToGroupList(REQUESTS);
  if (place < MAX_GROUP_REQUESTS)
  {
    groupRequests[place] = BlockIndex(block);
  }
  else
  {
    StoreRequest(ReserveRequests(1u), BlockIndex(block));
  }
}

void CloseRequests()
{
  barrier();
  uint count = min(GroupListCount(REQUESTS), MAX_GROUP_REQUESTS);
  if (ReservesFor(REQUESTS))
  {
    SetGroupListBegin(REQUESTS, ReserveRequests(count));
  }
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < count; i += GROUP_SIZE)
  {
    StoreRequest(GroupListBegin(REQUESTS) + i, groupRequests[i]);
  }
}
