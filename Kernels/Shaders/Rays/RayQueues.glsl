// The queues of rays and of hits, and for each pixel the block that its ray waits for or goes on
// in. All lie in one buffer of three sections, a word a pixel each: the blocks, then two queues of
// rays that take turns, this pass's and the next one's. Pending hits, which have no normal or
// colour yet, fill the queues from their ends: those of this pass the next pass's queue, and the
// postponed ones this pass's. No pixel is in a queue both as a ray and as a hit, so that they never
// meet.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"

#ifdef HAS_RAYS
uint ThisQueue(uint index)
{
  return ImagePixels() * (1u + control.Queue) + index;
}

uint NextQueue(uint index)
{
  return ImagePixels() * (2u - control.Queue) + index;
}

uint FromEnd(uint index)
{
  return ImagePixels() - 1u - index;
}

uint BlockOfRay(uint pixel)
{
  return rayQueues[pixel];
}

// A ray of the next pass.
uint NextRay(uint index)
{
  return rayQueues[NextQueue(index)];
}

// A hit of this pass that is pending. One of the last pass, whose ray goes on behind it: NONE if
// the ray has ended, or the hit is still pending.
uint PendingHit(uint index)
{
  return rayQueues[NextQueue(FromEnd(index))];
}

uint ContinuingRay(uint index)
{
  return rayQueues[ThisQueue(FromEnd(index))];
}

// Rays of this pass that have begun before: waiting ones, then continuing ones.
uint BegunRays()
{
#ifdef TRANSLUCENT
  return control.WaitingRays + control.ContinuingRays;
#else
  return control.WaitingRays;
#endif
}

uint BegunRay(uint index)
{
#ifdef TRANSLUCENT
  return index < control.WaitingRays ? rayQueues[ThisQueue(index)]
                                     : ContinuingRay(index - control.WaitingRays);
#else
  return rayQueues[ThisQueue(index)];
#endif
}

// Has the cache no room for the ray of this pixel, by its tile order, in this pass?
bool IsOrderBehindFrontier(uint order)
{
  return control.Frontier < PixelsInTiles() && order >= control.Frontier;
}

bool BehindFrontier(uint pixel)
{
  return IsOrderBehindFrontier(TileOrderOf(pixel));
}

// Rays that a group of RequestBlocks takes at a time, of which each looks so many blocks ahead.
uint RaysPerRequestGroup(uint speculation)
{
  return min(REQUEST_BLOCKS_GROUP_SIZE, GROUP_BLOCKS_AHEAD / speculation);
}

#ifdef WRITES_RAYS
void StoreBlockOfRay(uint pixel, uint block)
{
  rayQueues[pixel] = block;
}

void StoreNextRay(uint index, uint pixel)
{
  rayQueues[NextQueue(index)] = pixel;
}

void StorePendingHit(uint index, uint pixel)
{
  rayQueues[NextQueue(FromEnd(index))] = pixel;
}

void StorePostponedHit(uint index, uint pixel)
{
  rayQueues[ThisQueue(FromEnd(index))] = pixel;
}

// Tells the next pass of a ray that is not done, by its place in tile order.
void RecordFirstLive(uint order)
{
  if (control.Window < PixelsInTiles())
  {
    atomicMin(control.FirstLive, order);
  }
}

// Takes places in the next pass's queue for rays of which `first` is the least tile order.
uint ReserveNextRays(uint count, uint first)
{
  RecordFirstLive(first);
  uint at = atomicAdd(control.NextWaitingRays, count);
  uint groups = GroupsOf(at + count, RaysPerRequestGroup(Speculation(at + count)));
  atomicMax(control.RequestGroups.X, min(groups, MAX_GROUPS));
  return at;
}

#ifdef HAS_PENDING_HITS
// Takes places for hits of this pass.
uint ReservePendingHits(uint count)
{
  uint at = atomicAdd(control.PendingHits, count);
  atomicMax(
    control.FinishGroups.X, min(GroupsOf(at + count, FINISH_HITS_GROUP_SIZE), MAX_GROUPS));
  return at;
}
#endif
#endif
#else
// One pass casts all rays to their ends: none has begun before.
uint BegunRays()
{
  return 0u;
}

uint BegunRay(uint index)
{
  return NONE;
}

uint BlockOfRay(uint pixel)
{
  return NONE;
}

bool IsOrderBehindFrontier(uint order)
{
  return false;
}

void StoreBlockOfRay(uint pixel, uint block) {}
#endif
