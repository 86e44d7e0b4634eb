// Marks the cells that an isosurface crosses, of the active blocks of a decoded volume: rays then
// load the samples of no other cell. A block in which none is crossed is no longer active. A work
// group takes a macrocell, a lane one of its blocks.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Cache/SlotLayout.glsl"
#include "Rays/BlockRange.glsl"
#include "Store/HiddenCells.glsl"
#include "Surface/Excess.glsl"
#include BLOCK_ACCESS

// For the planes of samples on z that bound a layer of cells, bit x + 5 y for each cell's face.
struct Faces
{
  uint Any; // one of the face's four corners is inside
  uint All;
};

// Bit x + 5 y: is the sample inside, of 5 x 5 of a block and its neighbours?
uint InsideInPlane(ivec3 first, ivec3 last, int z, int isovalue)
{
  uint inside = 0u;
  for (int y = 0; y <= BLOCK_SIDE; ++y)
  {
    for (int x = 0; x <= BLOCK_SIDE; ++x)
    {
      uvec3 offsets = SampleOffsets(min(first + ivec3(x, y, z), last));
      float value = uintBitsToFloat(cacheValues[offsets.x + offsets.y + offsets.z]);
      inside |= uint(IsInside(value, isovalue)) << (x + (BLOCK_SIDE + 1) * y);
    }
  }
  return inside;
}

Faces FacesOf(uint inside)
{
  uint row = inside | inside >> 1;
  uint rows = inside & inside >> 1;
  return Faces(row | row >> (BLOCK_SIDE + 1), rows & rows >> (BLOCK_SIDE + 1));
}

// From bit x + 5 y to x + 4 y.
uint InLayer(uint faces)
{
  uint layer = 0u;
  for (int y = 0; y < BLOCK_SIDE; ++y)
  {
    layer |= (faces >> ((BLOCK_SIDE + 1) * y) & 15u) << (BLOCK_SIDE * y);
  }
  return layer;
}

// Bit x + 4 y + 16 z for each cell of a block that the isosurface crosses.
uvec2 CrossedCells(ivec3 block, int isovalue)
{
  ivec3 first = BLOCK_SIDE * block;
  ivec3 last = LEVEL_GRID.Samples - 1;
  uvec2 crossed = uvec2(0u);
  Faces lower = FacesOf(InsideInPlane(first, last, 0, isovalue));
  for (int z = 0; z < BLOCK_SIDE; ++z)
  {
    Faces upper = FacesOf(InsideInPlane(first, last, z + 1, isovalue));
    uint cells = InLayer((lower.Any | upper.Any) & ~(lower.All & upper.All)) << (16 * (z & 1));
    crossed |= z < 2 ? uvec2(cells, 0u) : uvec2(0u, cells);
    lower = upper;
  }
  return crossed;
}

uvec2 MarksOf(ivec3 block, vec2 range)
{
  uvec2 marks = uvec2(0u);
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (StraddlesIsovalue(range.x, range.y, i))
    {
      marks |= CrossedCells(block, i);
    }
  }
#ifdef HAS_HIDDEN_CELLS
  marks &= ~HiddenInSlot(BlockIndex(block));
#endif
  return marks;
}

shared uint groupMarks[2]; // the macrocell's marks of blocks that stay

vec2 RangeOf(uint macrocell, uint local)
{
  uint two = macrocells[macrocell].Ranges[local >> 1]; // blocks share a word
  return BlockRange(
    vec2(macrocells[macrocell].Low, macrocells[macrocell].High), two >> (16u * (local & 1u)));
}

void main()
{
  uint local = gl_LocalInvocationIndex;
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  for (uint macrocell = FoldedGroup(); macrocell < volume.NumberOfMacrocells; macrocell += groups)
  {
    uvec2 marked = blockMarks[MarksIndex(macrocell, LEVEL_MARKS)];
    if (marked == uvec2(0u)) // the same in the whole group
    {
      continue;
    }
    if (local < 2u)
    {
      groupMarks[local] = 0u;
    }
    barrier();
    if (((local < 32u ? marked.x : marked.y) >> (local & 31u) & 1u) != 0u)
    {
      EnterLevelOfMacrocell(macrocell);
      ivec3 block = MACROCELL_SIDE * MacrocellCoordinates(macrocell) + BlockInMacrocell(local);
      uvec2 marks = MarksOf(block, RangeOf(macrocell, local));
      cellMarks[BlockIndex(block)] = marks;
      if (marks != uvec2(0u))
      {
        atomicOr(groupMarks[local >> 5], 1u << (local & 31u));
      }
    }
    barrier();
    if (local == 0u)
    {
      blockMarks[MarksIndex(macrocell, LEVEL_MARKS)] = uvec2(groupMarks[0], groupMarks[1]);
    }
    barrier();
  }
}
