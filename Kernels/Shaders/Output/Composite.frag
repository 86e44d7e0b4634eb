// Draws the image, partial or complete, lit, into the window with its depths.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Surface/Hits.glsl"
#include "Output/WindowDepth.glsl"
#ifdef TRANSLUCENT
#include "Light/Layers.glsl"
#else
#include "Light/Shading.glsl"
#endif
#ifdef HAS_NORMALS
#include "Surface/PackedNormal.glsl"
#endif

layout(location = 0) out vec4 fragmentColor;
// in view coordinates, for passes of VTK's such as ambient occlusion
layout(location = 1) out vec4 fragmentPosition;
layout(location = 2) out vec4 fragmentNormal;

// Tells whether a pixel has a hit that is finished: lit, coloured or blended.
#ifdef TRANSLUCENT
bool Shows(uint pixel)
{
  return layers[pixel] != uvec2(0u);
}
#else
bool Shows(uint pixel)
{
#ifdef HAS_NORMALS
  return normals[pixel] != NO_NORMAL;
#elif defined(COLORED)
  return HitKeyOf(pixel) != NO_HIT && !isnan(ColorValueOf(pixel)); // NaN until it is found
#else
  return HitKeyOf(pixel) != NO_HIT;
#endif
}
#endif

void main()
{
  uint pixel = FragmentPixel();
  if (!Shows(pixel))
  {
    discard;
  }
  float t = DepthOf(pixel);
  gl_FragDepth = WindowDepth(t);
#ifdef TRANSLUCENT
  fragmentColor = BlendedLayers(pixel);
  fragmentPosition = vec4(0.0); // keeps what lies behind: it is blended like the colour
  fragmentNormal = vec4(0.0);
#else
  vec3 direction = EyeRayDirection(pixel);
#ifdef HAS_NORMALS
  vec3 normal = UnpackNormal(normals[pixel]);
#else
  vec3 normal = -normalize(direction); // unlit hits have none: face the viewer
#endif
  fragmentPosition = vec4(EyeRayOrigin(pixel) + t * direction, 1.0);
  fragmentNormal = vec4(dot(normal, direction) > 0.0 ? -normal : normal, 1.0);
  fragmentColor = vec4(Shade(pixel, t, normal, HitOf(pixel).Isovalue).xyz, 1.0);
#endif
}
