// The map from a block to its cache slot: a hash table with linear probing, sized by the cache. Entries
// are only ever added during a pass; CacheRebuild.comp makes the table anew after an eviction.

#define MAX_PROBES 256u

uint MapStart(uint block)
{
  uint h = block * 0x9E3779B1u;
  h ^= h >> 15;
  h *= 0x85EBCA77u;
  h ^= h >> 13;
  uint high, low;
  umulExtended(h, scene.Cache.y, high, low);
  return high;
}

uint NextEntry(uint entry)
{
  return entry + 1u == scene.Cache.y ? 0u : entry + 1u;
}

// The block's entry; NONE if it has none.
uint FindEntry(uint block)
{
  uint entry = MapStart(block);
  for (uint i = 0u; i < MAX_PROBES; ++i)
  {
    uint key = cacheMap[entry].Block;
    if (key == block)
    {
      return entry;
    }
    if (key == NONE)
    {
      return NONE;
    }
    entry = NextEntry(entry);
  }
  return NONE;
}

// Takes one of the entries of which at most `most` may be in use.
bool ReserveEntry(uint most)
{
  if (atomicAdd(control.MapUsed, 1u) < most)
  {
    return true;
  }
  atomicAdd(control.MapUsed, ~0u);
  return false;
}

// The block's entry, added where it had none and fewer than `most` are in use; NONE if the table is too full.
// Many invocations may ask for one block at once and each reserve an entry for it until the first has
// added it: who finds none to reserve looks again.
uint InsertEntry(uint block, uint most)
{
  uint entry = MapStart(block);
  uint patience = 16u;
  for (uint i = 0u; i < MAX_PROBES && patience > 0u;)
  {
    uint key = cacheMap[entry].Block;
    if (key == NONE)
    {
      if (!ReserveEntry(most))
      {
        --patience;
        continue;
      }
      key = atomicCompSwap(cacheMap[entry].Block, NONE, block);
      if (key == NONE)
      {
        return entry;
      }
      atomicAdd(control.MapUsed, ~0u); // another was first
    }
    if (key == block)
    {
      return entry;
    }
    entry = NextEntry(entry);
    ++i;
  }
  return NONE;
}

// Bit of the neighbour at `offset`, each component -1, 0 or 1, in MapEntry.Needs.
uint NeighbourBit(ivec3 offset)
{
  return 1u << uint((offset.x + 1) + 3 * (offset.y + 1) + 9 * (offset.z + 1));
}

ivec3 NeighbourOffset(uint bit)
{
  return ivec3(bit % 3u, (bit / 3u) % 3u, bit / 9u) - 1;
}

// Bits of the block itself and of the seven at its +x, +y and +z sides: its dual grid (section 3.4).
#define DUAL_GRID_NEEDS ((1u << 13) | (1u << 14) | (1u << 16) | (1u << 17) | (1u << 22) | (1u << 23) | (1u << 25) | (1u << 26))
