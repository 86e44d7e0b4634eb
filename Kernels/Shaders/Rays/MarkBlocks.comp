// Marks the active blocks, for the isovalues of the scene: those whose range of values holds one.
// Rays then read two words a macrocell, whatever there is to compare. A lane takes a macrocell; of
// most it reads no more than the macrocell's own range.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Shared/Grid.glsl"
#include "Rays/BlockRange.glsl"

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

void main()
{
  uint first = GROUP_SIZE * FoldedGroup() + gl_LocalInvocationIndex;
  uint stride = GROUP_SIZE * gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  for (uint macrocell = first; macrocell < volume.NumberOfMacrocells; macrocell += stride)
  {
    vec2 range = vec2(macrocells[macrocell].Low, macrocells[macrocell].High);
    uvec2 marks = uvec2(0u);
    if (StraddlesAnyIsovalue(range.x, range.y))
    {
      marks.x = MarksOf(macrocell, range, 0u);
      marks.y = MarksOf(macrocell, range, uint(BLOCKS_PER_MACROCELL) / 4u);
    }
    blockMarks[macrocell] = marks;
  }
}
