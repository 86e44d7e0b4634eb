// The partial or complete image goes to the window, with the depth that opaque geometry is tested against.
// In: RayHit, PixelColor.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"

layout(location = 0) out vec4 fragmentColor;

void main()
{
  ivec2 xy = ivec2(gl_FragCoord.xy) - scene.Image.zw;
  uint pixel = uint(xy.y * scene.Image.x + xy.x);
  vec4 color = unpackUnorm4x8(pixelColor[pixel]);
  if (color.a == 0.0)
  {
    discard;
  }
  float t = float(HitT(CameraRay(pixel), rayHit[pixel]));
  float z = (scene.DepthTerms.x + t * scene.DepthTerms.y) / (scene.DepthTerms.z + t * scene.DepthTerms.w);
  gl_FragDepth = clamp(0.5 * z + 0.5, 0.0, 1.0);
  fragmentColor = color;
}
