// The grid: ZFP's blocks of samples, and macrocells of blocks. Each level of detail has one; blocks
// and macrocells are numbered through all, so that only who needs coordinates knows of levels.

#include "Shared/Scene.glsl"

#ifdef LEVELS
int level = 0; // whose grid the functions below are about; the volume itself is level 0
#define LEVEL_GRID volume.Levels[level]

uint FirstBlock()
{
  return volume.Levels[level].FirstBlock;
}

uint FirstMacrocell()
{
  return volume.Levels[level].FirstMacrocell;
}

// Chooses the level of a block.
void EnterLevelOf(uint block)
{
  level = 0;
  while (level + 1 < volume.NumberOfLevels && block >= volume.Levels[level + 1].FirstBlock)
  {
    ++level;
  }
}

void EnterLevelOfMacrocell(uint macrocell)
{
  level = 0;
  while (level + 1 < volume.NumberOfLevels && macrocell >= volume.Levels[level + 1].FirstMacrocell)
  {
    ++level;
  }
}

// How often the axes have every second sample of the volume itself.
ivec3 Halvings()
{
  return volume.Levels[level].Halvings;
}

// On which axes does the next level have every second sample of this one? 1, else 0.
ivec3 HalvedByNext()
{
  return volume.Levels[level + 1].Halvings - volume.Levels[level].Halvings;
}
#else
#define LEVEL_GRID volume

uint FirstBlock()
{
  return 0u;
}

uint FirstMacrocell()
{
  return 0u;
}

void EnterLevelOf(uint block) {}
void EnterLevelOfMacrocell(uint macrocell) {}
#endif

// What a macrocell's marks are about: see MarkBlocks.comp. Without levels there is the first kind.
const uint LEVEL_MARKS = 0u;
const uint BLEND_MARKS = 1u;
const uint ORIGINAL_MARKS = 2u;

uint MarksIndex(uint macrocell, uint kind)
{
#ifdef LEVELS
  return 3u * macrocell + kind;
#else
  return macrocell;
#endif
}

// Block that holds a sample, or a cell whose lowest corner is this sample.
ivec3 BlockOf(ivec3 voxel)
{
  return voxel >> BLOCK_SIDE_LOG2;
}

uvec3 PlaceInBlock(ivec3 voxel)
{
  return uvec3(voxel) & uint(BLOCK_SIDE - 1);
}

// On which axes do the next voxels lie in the next block?
bvec3 AreLastInBlock(ivec3 voxel)
{
  return equal(voxel & (BLOCK_SIDE - 1), ivec3(BLOCK_SIDE - 1));
}

ivec3 MacrocellOf(ivec3 block)
{
  return block >> MACROCELL_SIDE_LOG2;
}

// Of element number i of a grid, x fastest.
ivec3 CoordinatesIn(ivec3 grid, uint i)
{
  uint slice = uint(grid.x) * uint(grid.y);
  uint inSlice = i % slice;
  return ivec3(inSlice % uint(grid.x), inSlice / uint(grid.x), i / slice);
}

// Of a block, or macrocell, of this level.
ivec3 BlockCoordinates(uint block)
{
  return CoordinatesIn(LEVEL_GRID.Blocks, block - FirstBlock());
}

ivec3 MacrocellCoordinates(uint macrocell)
{
  return CoordinatesIn(LEVEL_GRID.Macrocells, macrocell - FirstMacrocell());
}

uint BlockIndex(ivec3 b)
{
  return FirstBlock() + uint(b.x) +
    uint(LEVEL_GRID.Blocks.x) * (uint(b.y) + uint(LEVEL_GRID.Blocks.y) * uint(b.z));
}

bool InGrid(ivec3 block)
{
  return all(lessThan(uvec3(block), uvec3(LEVEL_GRID.Blocks)));
}

uint MacrocellIndex(ivec3 c)
{
  return FirstMacrocell() + uint(c.x) +
    uint(LEVEL_GRID.Macrocells.x) * (uint(c.y) + uint(LEVEL_GRID.Macrocells.y) * uint(c.z));
}

// Number of a block within its macrocell.
uint LocalIndex(ivec3 block)
{
  uvec3 local = uvec3(block) & uint(MACROCELL_SIDE - 1);
  return local.x + uint(MACROCELL_SIDE) * (local.y + uint(MACROCELL_SIDE) * local.z);
}

// The block of that number, from the first of its macrocell.
ivec3 BlockInMacrocell(uint local)
{
  return CoordinatesIn(ivec3(MACROCELL_SIDE), local);
}

// Is a cell one of a set of its block's? Bit x + 4 y + 16 z is that of the cell with this lowest
// corner.
bool HoldsCell(uvec2 cells, ivec3 cell)
{
  uvec3 local = PlaceInBlock(cell);
  uint bit = local.x + uint(BLOCK_SIDE) * local.y + uint(ROWS_PER_BLOCK) * (local.z & 1u);
  return ((local.z < 2u ? cells.x : cells.y) >> bit & 1u) != 0u;
}

// What a plane of samples on x, y and z adds to the index of a sample in its block.
const uvec3 STRIDES_IN_BLOCK = uvec3(1, BLOCK_SIDE, ROWS_PER_BLOCK);

// From a block to its neighbour i, x fastest, of the 2^3 blocks from itself on.
ivec3 SideOffset(int i)
{
  return ivec3(i) >> ivec3(0, 1, 2) & 1;
}

// A step of the 8 bits in which a block's range is told within its macrocell's. Sums and products
// of floats are the same everywhere, quotients are not: the last step is a little longer.
float RangeUnit(vec2 macrocellRange)
{
  precise float unit = macrocellRange.y * (1.0 / 256.0) - macrocellRange.x * (1.0 / 256.0);
  return unit;
}

// The lowest value of a block, decoded from 8 bits. Ranges too small or large for steps have only
// the first and the last: see BlockRanges.comp.
float RangeLow(vec2 macrocellRange, uint steps)
{
  precise float low = macrocellRange.x + float(steps) * RangeUnit(macrocellRange);
  return steps == 0u ? macrocellRange.x : low;
}

float RangeHigh(vec2 macrocellRange, uint steps)
{
  precise float high = macrocellRange.x + float(steps) * RangeUnit(macrocellRange);
  return steps == 0u ? macrocellRange.x : steps == 255u ? macrocellRange.y : high;
}
