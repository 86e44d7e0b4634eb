// The partial or complete image goes to the window, lit, with the depth that opaque geometry is tested against.
// In: Hits, Normals or Layers.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "WindowDepth.glsl"
#ifdef TRANSLUCENT
#include "Layers.glsl"
#else
#include "Shading.glsl"
#endif
#ifdef HAS_NORMALS
#include "PackedNormal.glsl"
#endif

layout(location = 0) out vec4 fragmentColor;
#ifdef HAS_NORMALS
// where VTK's passes ask for them, such as ambient occlusion: in view coordinates
layout(location = 1) out vec4 fragmentPosition;
layout(location = 2) out vec4 fragmentNormal;
#endif

// A hit shows as soon as it is lit.
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
#else
  return hits[pixel] != NO_HIT;
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
#else
  vec3 normal = vec3(0.0);
#ifdef HAS_NORMALS
  normal = UnpackNormal(normals[pixel]);
  fragmentPosition = vec4(EyeRayOrigin(pixel) + t * EyeRayDirection(pixel), 1.0);
  fragmentNormal = vec4(dot(normal, EyeRayDirection(pixel)) > 0.0 ? -normal : normal, 1.0);
#endif
  fragmentColor = vec4(Shade(pixel, t, normal, HitOf(pixel).Surface), 1.0);
#endif
}
