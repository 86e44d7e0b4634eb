// The hits of a translucent image, blended front to back.

#include "Shared/Buffers.glsl"

#define OPAQUE_ENOUGH 0.998 // what lies behind changes no colour of 8 bits

// The sum of what is blended so far: colour times opacity, and opacity.
vec4 BlendedLayers(uint pixel)
{
  uvec2 bits = layers[pixel];
  return vec4(unpackUnorm2x16(bits.x), unpackUnorm2x16(bits.y));
}

#ifdef WRITES_LAYERS
// Blends a hit behind all others; false if nothing behind it would show.
bool AddLayer(uint pixel, vec3 color, float opacity)
{
  vec4 before = BlendedLayers(pixel);
  vec4 sum = before + (1.0 - before.w) * opacity * vec4(color, 1.0);
  layers[pixel] = uvec2(packUnorm2x16(sum.xy), packUnorm2x16(sum.zw));
  return sum.w < OPAQUE_ENOUGH;
}
#endif
