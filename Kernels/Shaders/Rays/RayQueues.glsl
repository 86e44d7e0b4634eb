// The rays of a pass, and those that go on to the next.

shared uint groupActive;
shared uint groupPairs;
shared uint groupTouched;
shared uint groupVisible;
shared uint groupNeeded;

uint pairs = 0u; // ray-block pairs that this invocation has intersected

void OpenGroup()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActive = 0u;
    groupPairs = 0u;
    groupTouched = 0u;
    groupVisible = 0u;
    groupNeeded = 0u;
  }
}

void CountWork()
{
  atomicAdd(groupPairs, pairs);
#ifdef HAS_CACHE_MAP
  atomicAdd(groupTouched, touchedSlots);
#endif
#ifdef BUFFER_CACHE_SEEN
  atomicAdd(groupVisible, visibleBlocks);
  atomicAdd(groupNeeded, activeBlocks);
#endif
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupActive > 0u)
  {
    atomicAdd(control.ActiveRays, groupActive);
    atomicAdd(control.Pairs, groupPairs);
#ifdef HAS_CACHE_MAP
    atomicAdd(control.TouchedSlots, groupTouched);
#endif
#ifdef BUFFER_CACHE_SEEN
    atomicAdd(control.VisibleBlocks, groupVisible);
    atomicAdd(control.ActiveBlocks, groupNeeded);
#endif
  }
}

#ifdef HAS_RAYS
// Element of the list of this pass, and of the one that is made for the next.
uint ThisList(uint index)
{
  return ImagePixels() * (1u + control.List) + index;
}

uint NextList(uint index)
{
  return ImagePixels() * (2u - control.List) + index;
}

bool BehindFrontier(uint pixel)
{
  return control.Frontier < PixelsInTiles() && TileOrderOf(pixel) >= control.Frontier;
}

void NoteLive(uint order)
{
  if (control.Window < PixelsInTiles())
  {
    atomicMin(control.FirstLive, order);
  }
}

// Takes places for rays of which `first` is the least tile order.
uint ReserveRays(uint count, uint first)
{
  NoteLive(first);
  uint at = atomicAdd(control.NextCarried, count);
  // enough groups of RequestBlocks for whatever number of rays it will be, and what they look ahead
  uint rays = at + count;
  uint groups = max((rays + REQUEST_BLOCKS_GROUP_SIZE - 1u) / REQUEST_BLOCKS_GROUP_SIZE, min((rays + 3u) / 4u, ImagePixels() / 1024u + 1u));
  atomicMax(control.RequestGroups.X, min(groups, MAX_GROUPS));
  return at;
}

#ifdef HIT_LIST
// Takes places for hits without a normal.
uint ReserveUnlit(uint count)
{
  uint at = atomicAdd(control.Unlit, count);
  atomicMax(control.NormalGroups.X, min((at + count + FINISH_HITS_GROUP_SIZE - 1u) / FINISH_HITS_GROUP_SIZE, MAX_GROUPS));
  return at;
}

// Place of such a hit, from the end of a list on.
uint FromEnd(uint index)
{
  return ImagePixels() - 1u - index;
}
#endif

// Pixel of a ray of this pass that has begun. Those of translucent hits stand in the list of those hits; NONE for one
// that has ended, or still waits there.
uint BegunPixel(uint index)
{
#ifdef TRANSLUCENT
  return index < control.Carried ? rays[ThisList(index)] : rays[ThisList(FromEnd(index - control.Carried))];
#else
  return rays[ThisList(index)];
#endif
}

uint BegunRays()
{
#ifdef TRANSLUCENT
  return control.Carried + control.Again;
#else
  return control.Carried;
#endif
}
#endif
