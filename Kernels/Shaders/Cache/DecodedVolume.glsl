// How a decoded block is found where the whole volume is decoded: its slot is its number, and no
// block is ever missing. The same interface as CachedBlocks.glsl.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"

uint NumberOfSlots()
{
  return volume.NumberOfBlocks;
}

uint SlotOf(ivec3 block)
{
  return BlockIndex(block);
}

void FindSlots(ivec3 first, ivec3 reach) {}
void ExchangeSlots() {}

bool LacksSlots()
{
  return false;
}

uint MissingSlots()
{
  return 0u;
}

uint FoundSlot(ivec3 first, ivec3 block)
{
  return BlockIndex(block);
}

uvec3 StridesOfBlocks()
{
  uvec2 row = uvec2(LEVEL_GRID.Blocks.xy);
  return uint(SAMPLES_PER_BLOCK) * uvec3(1u, row.x, row.x * row.y);
}

// What planes of samples on x, y and z add to the index of a sample; where the level begins counts
// with those on x.
uvec3 SampleOffsets(ivec3 planes)
{
  return PlaceInBlock(planes) * STRIDES_IN_BLOCK + uvec3(BlockOf(planes)) * StridesOfBlocks() +
    uvec3(uint(SAMPLES_PER_BLOCK) * FirstBlock(), 0u, 0u);
}

// Of the next planes, from those of `planes`.
uvec3 NextSampleOffsets(ivec3 planes, uvec3 offsets)
{
  return offsets + STRIDES_IN_BLOCK +
    uvec3(AreLastInBlock(planes)) *
      (StridesOfBlocks() - uint(BLOCK_SIDE) * STRIDES_IN_BLOCK);
}

// Indices of the samples at a cell's corners, on its lower and its upper z face, x fastest.
void FindCorners(ivec3 cell, out uvec4 low, out uvec4 high)
{
  uvec3 near = SampleOffsets(cell);
  uvec3 far = NextSampleOffsets(cell, near);
  low = uvec4(near.x, far.x, near.x, far.x) + uvec4(near.y, near.y, far.y, far.y);
  high = low + far.z;
  low += near.z;
}

// For the four planes of samples from one before a cell to one behind it, on each axis: what they
// add to the index of a sample.
struct Stencil
{
  uvec4 X, Y, Z;
};

Stencil PlaceStencil(ivec3 before, ivec3 cell, ivec3 behind)
{
  uvec3 a = SampleOffsets(before);
  uvec3 b = SampleOffsets(cell);
  uvec3 c = NextSampleOffsets(cell, b);
  uvec3 d = SampleOffsets(behind);
  return Stencil(uvec4(a.x, b.x, c.x, d.x), uvec4(a.y, b.y, c.y, d.y), uvec4(a.z, b.z, c.z, d.z));
}

// Index of a stencil's sample by its planes on x, y and z: x, y, z, w of the four.
#define STENCIL_INDEX(at, i, j, k) (at.X.i + at.Y.j + at.Z.k)

// There are no pages to mark as used, and nothing to ask for.
void UsePages(ivec3 first, ivec3 reach) {}
void OpenTouchedSlots() {}
void AddTouchedSlots() {}
void CloseTouchedSlots() {}
void OpenRequests() {}
void RequestBlock(ivec3 block) {}
void CloseRequests() {}
