// Asking for blocks that are not in the cache (section 3.4). The first to ask for one in a pass lists it; a bit a block
// tells. A work group's requests go to the list together, and DecodeBlocks.comp fills them.

#define LISTED 256u

shared uint listed[LISTED];
shared uint listedCount;
shared uint listedBegin;

// A free page of the map for a macrocell; NONE where there is none.
uint TakePage(uint cell)
{
  uint at = atomicAdd(control.TakenPages, 1u);
  if (at >= control.FreePages)
  {
    return NONE;
  }
  uint page = mapPages[(control.FreePagesBegin + at) % cache.MapPages].Free;
  mapPages[page].Cell = cell;
  mapPages[page].Stamp = control.PassSerial;
  mapPages[page].Used = 0u;
  return page;
}

// Takes places on the list of requests, and makes DecodeBlocks.comp have an invocation for each.
uint ReserveRequests(uint count)
{
  uint at = atomicAdd(control.Requests, count);
  atomicMax(control.DecodeGroups.X, min((at + count + DECODE_BLOCKS_GROUP_SIZE - 1u) / DECODE_BLOCKS_GROUP_SIZE, MAX_GROUPS));
  return at;
}

// What is behind the end of the list is refused, and may be asked for again.
void ListRequest(uint at, uint block)
{
  if (at < cache.Slots)
  {
    cacheRequests[at] = block;
    return;
  }
  ivec3 coordinates = BlockCoordinates(block);
  uint local = LocalIndex(coordinates);
  atomicAnd(macrocells[MacrocellIndex(coordinates >> 2)].Requested[local >> 5], ~(1u << (local & 31u)));
}

// Call first, with a barrier before any request.
void OpenRequests()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    listedCount = 0u;
  }
}

// Asks for a block, unless another has already done so in this pass.
void RequestBlock(ivec3 block)
{
  uint cell = MacrocellIndex(block >> 2);
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
  uint at = atomicAdd(listedCount, 1u);
  if (at < LISTED)
  {
    listed[at] = BlockIndex(block);
  }
  else
  {
    ListRequest(ReserveRequests(1u), BlockIndex(block));
  }
}

void CloseRequests()
{
  barrier();
  uint count = min(listedCount, LISTED);
  if (gl_LocalInvocationIndex == 0u && count > 0u)
  {
    listedBegin = ReserveRequests(count);
  }
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < count; i += GROUP_SIZE)
  {
    ListRequest(listedBegin + i, listed[i]);
  }
}
