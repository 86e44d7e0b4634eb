// Which isovalues the range of a block's values holds.

#include "Shared/Scene.glsl"
#include "Shared/Grid.glsl"

// Tells whether a range has a value below the isovalue and one that is not.
bool StraddlesIsovalue(float low, float high, int number)
{
  FloatSum isovalue = view.Isovalues[number];
  precise float below = (low - isovalue.High) - isovalue.Low;
  precise float above = (high - isovalue.High) - isovalue.Low;
  return below < 0.0 && above >= 0.0;
}

// The range of a block, of 8 + 8 bits as BlockRanges.comp stores them; upside down if it is empty.
vec2 BlockRange(vec2 macrocellRange, uint steps)
{
  uint low = steps & 0xFFu;
  uint high = steps >> 8 & 0xFFu;
  return low <= high ? vec2(RangeLow(macrocellRange, low), RangeHigh(macrocellRange, high))
                     : vec2(1.0, 0.0);
}
