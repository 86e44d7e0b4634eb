// The values' excess over an isovalue, in sixteenths: a power of two changes no other bit, and
// nothing overflows that a root is found by.

#include "Shared/Scene.glsl"

vec4 Excess(vec4 values, int isovalue)
{
  vec2 level = 0.0625 * vec2(view.Isovalues[isovalue].High, view.Isovalues[isovalue].Low);
  precise vec4 excess = (0.0625 * values - level.x) - level.y;
  return excess;
}

float Excess(float value, int isovalue)
{
  vec2 level = 0.0625 * vec2(view.Isovalues[isovalue].High, view.Isovalues[isovalue].Low);
  precise float excess = (0.0625 * value - level.x) - level.y;
  return excess;
}

bool IsInside(float value, int isovalue)
{
  return Excess(value, isovalue) >= 0.0;
}
