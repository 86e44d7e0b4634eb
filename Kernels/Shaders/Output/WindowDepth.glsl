// The fragment's pixel in the image, and its depth in the window.

#include "Shared/Scene.glsl"

uint FragmentPixel()
{
  vec2 inViewport = (gl_FragCoord.xy - vec2(view.ViewportOrigin)) * view.PixelsPerFragment;
  ivec2 xy = clamp(ivec2(inViewport) - view.FirstPixel, ivec2(0), view.ImageSize - 1);
  return uint(xy.y * view.ImageSize.x + xy.x);
}

// Depth of the point at parameter t of a ray; the same bits in the image and in a selection, which
// is drawn over the image's depths.
float WindowDepth(float t)
{
  precise float z = (look.ClipZ + t * look.ClipZPerT) / (look.ClipW + t * look.ClipWPerT);
  return clamp(0.5 * z + 0.5, 0.0, 1.0);
}
