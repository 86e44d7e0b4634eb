// Colours of the values of the volume that gives them: see Palette.glsl.h.

#include "Shared/Scene.glsl"
#include "Light/Palette.glsl.h"

vec4 NodeColor(int i)
{
  return vec4(palette.Nodes[i].Rgb, palette.Opacities[i >> 2][i & 3]);
}

// The last node that is not above a value, or the first one.
int LastNodeUpTo(float value)
{
  int low = 0;
  int high = palette.NumberOfNodes;
  while (high - low > 1)
  {
    int middle = (low + high) / 2;
    if (palette.Nodes[middle].Value <= value)
    {
      low = middle;
    }
    else
    {
      high = middle;
    }
  }
  return low;
}

#ifdef CATEGORIES
// Colour and opacity of the nearest category, if the value is one.
vec4 ColorOfValue(float value)
{
  int below = LastNodeUpTo(value);
  int above = min(below + 1, palette.NumberOfNodes - 1);
  float toBelow = abs(value - palette.Nodes[max(below, 0)].Value);
  float toAbove = abs(value - palette.Nodes[max(above, 0)].Value);
  bool found = palette.NumberOfNodes > 0 && min(toBelow, toAbove) <= palette.Tolerance;
  return found ? NodeColor(toBelow <= toAbove ? below : above) : palette.None;
}
#else
// Colour and opacity of a value; infinity stands for none.
vec4 ColorOfValue(float value)
{
  int last = palette.NumberOfNodes - 1;
  float lowest = palette.Nodes[0].Value;
  float highest = palette.Nodes[last].Value;
  if (isinf(value))
  {
    return palette.None;
  }
  if (value < lowest - palette.Tolerance)
  {
    return palette.Below;
  }
  if (value > highest + palette.Tolerance)
  {
    return palette.Above;
  }
  int below = min(LastNodeUpTo(value), last - 1);
  float from = palette.Nodes[below].Value;
  float to = palette.Nodes[below + 1].Value;
  float share = to > from ? clamp((value - from) / (to - from), 0.0, 1.0) : 1.0;
  return mix(NodeColor(below), NodeColor(below + 1), share);
}
#endif
