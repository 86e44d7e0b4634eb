// The fragment's pixel in the image, and its depth in the window.

#include "Shared/Scene.glsl"

uint FragmentPixel()
{
  ivec2 xy = ivec2(gl_FragCoord.xy) - view.ImageOrigin;
  return uint(xy.y * view.ImageSize.x + xy.x);
}

// Depth of the point at parameter t of a ray; the same bits in the image and in a selection, which
// is drawn over the image's depths.
float WindowDepth(float t)
{
  precise float z = (look.ClipZ + t * look.ClipZPerT) / (look.ClipW + t * look.ClipWPerT);
  return clamp(0.5 * z + 0.5, 0.0, 1.0);
}
