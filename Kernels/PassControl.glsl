// What happens between two uses of the block cache, by a single invocation: the CPU decides none of it.

#define PASS_RECORDS 64u

uint GroupsFor(uint count, uint groupSize)
{
  return min((count + groupSize - 1u) / groupSize, MAX_GROUPS);
}

// Closes the record of the pass that has just ended, if there was one.
void RecordPass()
{
  if (control.LiveRays == 0u)
  {
    return;
  }
  PassRecord record;
  record.ActiveRays = control.LiveRays;
  record.Speculation = control.Speculation;
  record.Pairs = control.Pairs;
  record.VisibleBlocks = control.AdmittedBlocks;
  record.ActiveBlocks = control.ActiveBlocks;
  record.DecodedBlocks = control.DecodedBlocks;
  record.CachedBlocks = scene.Cache.x - control.FreeSlots;
  record.RemainingRays = control.NextLiveRays;
  record.DeferredBlocks = control.DeferredBlocks;
  passRecords[control.PassIndex % PASS_RECORDS] = record;
  ++control.PassIndex;
}

// The slots that were just filled leave the ring of free ones.
void TakeSlots()
{
  uint taken = control.DecodedBlocks;
  control.FreeHead = (control.FreeHead + taken) % scene.Cache.x;
  control.FreeSlots -= taken;
}

// No slot is in use now, so whatever is oldest may go: down to half of the cache when it was found
// nearly full, nothing when just the map has gone stale. A cache with room for the whole volume never
// evicts: blocks are deferred there only because reservations count shared neighbours more than once.
void PlanEviction()
{
  bool whole = scene.Cache.x >= uint(scene.Blocks.w);
  bool full = !whole && control.DeferredBlocks > 0u && control.FreeSlots < scene.Cache.x / 4u;
  bool stale = !whole && control.MapUsed > scene.Cache.y / 8u * 5u; // cached blocks take half at most
  control.EvictGroups.X = full || stale ? GroupsFor(scene.Cache.y, 256u) : 0u;
  if (full || stale)
  {
    control.Evicted = 0u;
    control.EvictSlots = full ? scene.Cache.x / 2u - control.FreeSlots : 0u;
    control.FreeHead = 0u; // CacheRebuild.comp counts anew
    control.FreeSlots = 0u;
    control.MapUsed = 0u;
    for (uint i = 0u; i < 256u; ++i)
    {
      control.Ages[i] = 0u;
    }
  }
}

void ResetCounters()
{
  ++control.PassSerial;
  control.AdmitGroups.X = 0u;
  control.DecodeGroups.X = 0u;
  control.IntersectGroups.X = 0u;
  control.Pairs = 0u;
  control.VisibleBlocks = 0u;
  control.AdmittedBlocks = 0u;
  control.ActiveBlocks = 0u;
  control.DecodedBlocks = 0u;
  control.WorkItems = 0u;
  control.ReservedSlots = 0u;
  control.DeferredBlocks = 0u;
  control.UnshadedHits = 0u;
}

// Closes the last use of the cache and opens the next one.
void TurnOver()
{
  TakeSlots();
  RecordPass();
  PlanEviction();
  ResetCounters();
}
