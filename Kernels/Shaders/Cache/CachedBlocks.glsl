// How a decoded block is found in the cache. Its slot stands on the map page of its macrocell.
// DecodedVolume.glsl has the same interface; #include BLOCK_ACCESS is one of them.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"

uint NumberOfSlots()
{
  return cache.SlotCapacity;
}

// The slot of a block by the number of its macrocell and its own there; NONE if it has none.
uint SlotIn(uint macrocell, uint local)
{
  uint page = macrocells[macrocell].Page;
  return page >= CLAIMED ? NONE : mapPages[page].Slots[local];
}

// NONE if the block is not in the cache.
uint SlotOf(ivec3 block)
{
  return SlotIn(MacrocellIndex(MacrocellOf(block)), LocalIndex(block));
}

// What planes of samples on x, y and z add to the index of a sample in its block.
uvec3 SampleOffsets(ivec3 planes)
{
  return PlaceInBlock(planes) * STRIDES_IN_BLOCK;
}

// Of the next planes, from those of `planes`.
uvec3 NextSampleOffsets(ivec3 planes, uvec3 offsets)
{
  return offsets + STRIDES_IN_BLOCK -
    uvec3(AreLastInBlock(planes)) * (uint(BLOCK_SIDE) * STRIDES_IN_BLOCK);
}

// Slots of a block and those beside it, x fastest, in the lower and the upper layer. No stage
// indexes them: what is indexed by a variable does not stay in registers.
uvec4 lowSlots, highSlots;

#ifdef LEVELS
uvec4 lowSlotsAside, highSlotsAside; // of the other level, where two blend

// Exchanges the slots that were found last and those aside.
void ExchangeSlots()
{
  uvec4 low = lowSlots, high = highSlots;
  lowSlots = lowSlotsAside;
  highSlots = highSlotsAside;
  lowSlotsAside = low;
  highSlotsAside = high;
}
#endif

// What a block adds on each axis to the number of its macrocell, and to its own there.
struct PlaceInMap
{
  uvec3 Macrocell, Local;
};

PlaceInMap PlaceOf(ivec3 block)
{
  uvec2 row = uvec2(LEVEL_GRID.Macrocells.xy);
  uvec3 strides = uvec3(1u, row.x, row.x * row.y);
  const uvec3 localStrides = uvec3(1, MACROCELL_SIDE, MACROCELL_SIDE * MACROCELL_SIDE);
  return PlaceInMap(uvec3(MacrocellOf(block)) * strides + uvec3(FirstMacrocell(), 0, 0),
    (uvec3(block) & uint(MACROCELL_SIDE - 1)) * localStrides);
}

// 0 where a ray does not reach to.
uint SlotBeside(bool reached, uvec3 macrocell, uvec3 local)
{
  return reached
    ? SlotIn(macrocell.x + macrocell.y + macrocell.z, local.x + local.y + local.z)
    : 0u;
}

// Finds the slots of the blocks from `first` to first + reach, a component 0 or 1.
void FindSlots(ivec3 first, ivec3 reach)
{
  PlaceInMap near = PlaceOf(first), far = PlaceOf(first + 1);
  uvec3 m = near.Macrocell, n = far.Macrocell;
  uvec3 l = near.Local, k = far.Local;
  bvec3 r = greaterThan(reach, ivec3(0));
  lowSlots.x = SlotBeside(true, m, l);
  lowSlots.y = SlotBeside(r.x, uvec3(n.x, m.yz), uvec3(k.x, l.yz));
  lowSlots.z = SlotBeside(r.y, uvec3(m.x, n.y, m.z), uvec3(l.x, k.y, l.z));
  lowSlots.w = SlotBeside(r.x && r.y, uvec3(n.xy, m.z), uvec3(k.xy, l.z));
  highSlots.x = SlotBeside(r.z, uvec3(m.xy, n.z), uvec3(l.xy, k.z));
  highSlots.y = SlotBeside(r.x && r.z, uvec3(n.x, m.y, n.z), uvec3(k.x, l.y, k.z));
  highSlots.z = SlotBeside(r.y && r.z, uvec3(m.x, n.yz), uvec3(l.x, k.yz));
  highSlots.w = SlotBeside(all(r), n, k);
}

// Did the last search miss a block?
bool LacksSlots()
{
  return any(equal(lowSlots, uvec4(NONE))) || any(equal(highSlots, uvec4(NONE)));
}

// A bit for each block that it missed.
uint MissingSlots()
{
  uvec4 low = uvec4(equal(lowSlots, uvec4(NONE))) << uvec4(0u, 1u, 2u, 3u);
  uvec4 high = uvec4(equal(highSlots, uvec4(NONE))) << uvec4(4u, 5u, 6u, 7u);
  return low.x | low.y | low.z | low.w | high.x | high.y | high.z | high.w;
}

uint SlotAt(bvec3 side)
{
  uvec4 layer = side.z ? highSlots : lowSlots;
  uvec2 row = side.y ? layer.zw : layer.xy;
  return side.x ? row.y : row.x;
}

// The slot of a block, of those that were found last from `first` on.
uint FoundSlot(ivec3 first, ivec3 block)
{
  return SlotAt(notEqual(block, first));
}

// Indices of the samples at a cell's corners, on its lower and its upper z face, x fastest. The
// slots of the cell's block are those that were found last.
void FindCorners(ivec3 cell, out uvec4 low, out uvec4 high)
{
  uvec3 near = SampleOffsets(cell);
  uvec3 far = NextSampleOffsets(cell, near);
  low = uvec4(near.x, far.x, near.x, far.x) + uvec4(near.y, near.y, far.y, far.y);
  high = low + far.z;
  low += near.z;
  bvec3 last = AreLastInBlock(cell); // the far corners lie in the next block
  uvec4 upper = last.z ? highSlots : lowSlots;
  uvec4 lowRows = last.y ? lowSlots : lowSlots.xyxy;
  uvec4 highRows = last.y ? upper : upper.xyxy;
  low += uint(SAMPLES_PER_BLOCK) * (last.x ? lowRows : lowRows.xxzz);
  high += uint(SAMPLES_PER_BLOCK) * (last.x ? highRows : highRows.xxzz);
}

// For the four planes of samples from one before a cell to one behind it, on each axis: the offsets
// of their samples in a block, and whether they lie in the further block.
struct Stencil
{
  uvec4 X, Y, Z;
  bvec4 FurtherX, FurtherY, FurtherZ;
};

Stencil PlaceStencil(ivec3 before, ivec3 cell, ivec3 behind)
{
  uvec3 a = SampleOffsets(before);
  uvec3 b = SampleOffsets(cell);
  uvec3 c = NextSampleOffsets(cell, b);
  uvec3 d = SampleOffsets(behind);
  ivec3 first = BlockOf(before);
  bvec3 fb = notEqual(BlockOf(cell), first);
  bvec3 fc = notEqual(BlockOf(cell + 1), first);
  bvec3 fd = notEqual(BlockOf(behind), first);
  return Stencil(uvec4(a.x, b.x, c.x, d.x), uvec4(a.y, b.y, c.y, d.y), uvec4(a.z, b.z, c.z, d.z),
    bvec4(false, fb.x, fc.x, fd.x), bvec4(false, fb.y, fc.y, fd.y), bvec4(false, fb.z, fc.z, fd.z));
}

// Index of a stencil's sample by its planes on x, y and z: x, y, z, w of the four. A macro, so that
// the planes are swizzles and stay in registers.
#define STENCIL_INDEX(at, i, j, k)                                                                 \
  (uint(SAMPLES_PER_BLOCK) * SlotAt(bvec3(at.FurtherX.i, at.FurtherY.j, at.FurtherZ.k)) +          \
    at.X.i + at.Y.j + at.Z.k)

#ifdef WRITES_CACHE_MAP
uint touchedSlots = 0u; // on pages that this invocation is the first of the image to use
shared uint groupTouchedSlots;

// Marks a page as used: the least recently used are evicted first.
void UsePage(ivec3 macrocell)
{
  uint page = macrocells[MacrocellIndex(macrocell)].Page;
  if (mapPages[page].Stamp != control.PassSerial)
  {
    uint before = atomicExchange(mapPages[page].Stamp, control.PassSerial);
    touchedSlots += before < control.ImageSerial ? mapPages[page].Used : 0u;
  }
}

// Marks the pages of the blocks from `first` to first + reach as used.
void UsePages(ivec3 first, ivec3 reach)
{
  ivec3 macrocell = MacrocellOf(first);
  ivec3 across = MacrocellOf(first + reach) - macrocell;
  // the macrocells beside it, a bit each, x fastest; a loop over them all would be unrolled
  uint beside = 1u | uint(across.x) << 1u;
  beside |= across.y != 0 ? beside << 2u : 0u;
  beside |= across.z != 0 ? beside << 4u : 0u;
  for (; beside != 0u; beside &= beside - 1u)
  {
    UsePage(macrocell + SideOffset(findLSB(beside)));
  }
}

void OpenTouchedSlots()
{
  groupTouchedSlots = 0u;
}

void AddTouchedSlots()
{
  atomicAdd(groupTouchedSlots, touchedSlots);
}

void CloseTouchedSlots()
{
  atomicAdd(control.TouchedSlots, groupTouchedSlots);
}
#endif

#ifdef WRITES_CACHE_REQUESTS
#include "Cache/Requests.glsl"
#endif
