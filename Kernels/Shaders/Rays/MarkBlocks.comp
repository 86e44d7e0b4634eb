// Marks the active blocks, for the isovalues of the scene: those whose range of values holds one.
// Rays then read two words a macrocell, whatever there is to compare. A lane takes a macrocell; of
// most it reads no more than the macrocell's own range. With levels of detail it marks, beside the
// blocks of a level, those of its blend with the next, and those that stand for samples of the
// volume between which the surface is: levels are marked one after the other, the finest first.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/BlockRange.glsl"
#include "Store/VolumeSlice.glsl"

bool StraddlesAnyIsovalue(float low, float high)
{
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (StraddlesIsovalue(low, high, i))
    {
      return true;
    }
  }
  return false;
}

// 1 if a block's range holds an isovalue, else 0.
uint IsMarked(vec2 macrocellRange, uint steps)
{
  vec2 range = BlockRange(macrocellRange, steps);
  return StraddlesAnyIsovalue(range.x, range.y) ? 1u : 0u;
}

// Two blocks share a word of ranges, 32 a word of marks.
uint MarksOf(uint macrocell, vec2 range, uint firstWord)
{
  const uint words = uint(BLOCKS_PER_MACROCELL) / 4u;
  uint marks = 0u;
  for (uint i = 0u; i < words; ++i)
  {
    uint two = macrocells[macrocell].Ranges[firstWord + i];
    marks |= (IsMarked(range, two) | IsMarked(range, two >> 16) << 1) << (2u * i);
  }
  return marks;
}

#ifdef LEVELS
// Is the surface of the level, or of its blend with the next, possible in a block? Where either has
// no visible cell there is none. Ranges are upside down then.
bool MayBlend(vec2 range, vec2 coarse)
{
  return range.x <= range.y && coarse.x <= coarse.y &&
    StraddlesAnyIsovalue(min(range.x, coarse.x), max(range.y, coarse.y));
}

vec2 RangeIn(uint macrocell, uint local)
{
  uint two = macrocells[macrocell].Ranges[local >> 1];
  vec2 range = vec2(macrocells[macrocell].Low, macrocells[macrocell].High);
  return BlockRange(range, two >> (16u * (local & 1u)));
}

// The active blocks where the next level blends in: a coarse block, of one macrocell for all that a
// macrocell has, holds each of them.
uvec2 BlendMarks(uint macrocell)
{
  uvec2 marks = uvec2(0u);
  if (level + 1 >= volume.NumberOfLevels)
  {
    return marks;
  }
  ivec3 place = MacrocellCoordinates(macrocell);
  ivec3 halved = HalvedByNext();
  ++level;
  uint coarse = MacrocellIndex(place >> halved);
  --level;
  if (!MayBlend(vec2(macrocells[macrocell].Low, macrocells[macrocell].High),
        vec2(macrocells[coarse].Low, macrocells[coarse].High)))
  {
    return marks;
  }
  for (uint local = 0u; local < uint(BLOCKS_PER_MACROCELL); ++local)
  {
    ivec3 block = MACROCELL_SIDE * place + BlockInMacrocell(local) >> halved;
    uint mark = MayBlend(RangeIn(macrocell, local), RangeIn(coarse, LocalIndex(block))) ? 1u : 0u;
    marks |= local < 32u ? uvec2(mark << local, 0u) : uvec2(0u, mark << (local & 31u));
  }
  return marks;
}
#endif

#ifdef LEVELS
// The blocks that stand for samples of the volume itself between which the surface may be: those
// over such blocks of the level before, whose marks are there already.
uvec2 OriginalMarks(uint macrocell)
{
  uvec2 marks = uvec2(0u);
  ivec3 place = MacrocellCoordinates(macrocell);
  --level;
  ivec3 halved = HalvedByNext();
  for (int i = 0; i < BLOCKS_PER_MACROCELL; ++i)
  {
    ivec3 first = MACROCELL_SIDE * place + BlockInMacrocell(uint(i)) << halved;
    bool marked = false;
    for (int side = 0; side < 8; ++side)
    {
      ivec3 block = first + (SideOffset(side) & halved);
      if (InGrid(block))
      {
        uint local = LocalIndex(block);
        uvec2 finer = blockMarks[MarksIndex(MacrocellIndex(MacrocellOf(block)), ORIGINAL_MARKS)];
        marked = marked || ((local < 32u ? finer.x : finer.y) >> (local & 31u) & 1u) != 0u;
      }
    }
    uint bit = marked ? 1u << (i & 31) : 0u;
    marks |= i < 32 ? uvec2(bit, 0u) : uvec2(0u, bit);
  }
  ++level;
  return marks;
}

void StoreMarks(uint macrocell, uvec2 marks)
{
  EnterLevelOfMacrocell(macrocell);
  blockMarks[MarksIndex(macrocell, LEVEL_MARKS)] = marks;
  blockMarks[MarksIndex(macrocell, BLEND_MARKS)] = BlendMarks(macrocell);
  blockMarks[MarksIndex(macrocell, ORIGINAL_MARKS)] =
    level == 0 ? marks : OriginalMarks(macrocell);
}
#else
void StoreMarks(uint macrocell, uvec2 marks)
{
  blockMarks[MarksIndex(macrocell, LEVEL_MARKS)] = marks;
}
#endif

void main()
{
  uint first = slice.x + GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  for (uint macrocell = first; macrocell < slice.y; macrocell += stride)
  {
    vec2 range = vec2(macrocells[macrocell].Low, macrocells[macrocell].High);
    uvec2 marks = uvec2(0u);
    if (StraddlesAnyIsovalue(range.x, range.y))
    {
      marks.x = MarksOf(macrocell, range, 0u);
      marks.y = MarksOf(macrocell, range, uint(BLOCKS_PER_MACROCELL) / 4u);
    }
    StoreMarks(macrocell, marks);
  }
}
