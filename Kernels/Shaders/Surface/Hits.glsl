// What the rays of pixels have met. The buffer has a section of a word a pixel for each of:
// - the hit's key,
// - its depth, the parameter t; in a translucent image that of the first hit,
// - with several isovalues the number of the hit's, and in the upper half that of the first hit's,
// - with another volume for the colours its value at the hit,
// - in a translucent image the window's depth where opaque geometry may hide the surface.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"

struct Hit
{
  uint Key;     // NO_HIT, or a number in the order of t: see HitKey in Rays.glsl
  int Isovalue; // its number
};

const Hit MISS = Hit(NO_HIT, 0);

uint ImagePixels()
{
  return uint(view.ImageSize.x * view.ImageSize.y);
}

#ifdef BUFFER_HITS
Hit HitOf(uint pixel)
{
#ifdef SEVERAL_ISOVALUES
  return Hit(hits[pixel], int(hits[2u * ImagePixels() + pixel] & 0xFFFFu));
#else
  return Hit(hits[pixel], 0);
#endif
}

float DepthOf(uint pixel)
{
  return uintBitsToFloat(hits[ImagePixels() + pixel]);
}

#ifdef SEVERAL_ISOVALUES
#define COLOR_SECTION 3u
#else
#define COLOR_SECTION 2u
#endif
#ifdef COLORED
#define OBSTACLE_SECTION (COLOR_SECTION + 1u)
#else
#define OBSTACLE_SECTION COLOR_SECTION
#endif

float ObstacleOf(uint pixel)
{
  return uintBitsToFloat(hits[OBSTACLE_SECTION * ImagePixels() + pixel]);
}

#ifdef COLORED
float ColorValueOf(uint pixel)
{
  return uintBitsToFloat(hits[COLOR_SECTION * ImagePixels() + pixel]);
}
#endif
#endif

#ifdef WRITES_HITS
#ifdef COLORED
void StoreColorValue(uint pixel, float value)
{
  hits[COLOR_SECTION * ImagePixels() + pixel] = floatBitsToUint(value);
}
#endif

void StoreHit(uint pixel, Hit hit, float depth)
{
#ifdef TRANSLUCENT
  bool first = hits[pixel] == NO_HIT;
#else
  bool first = true;
#endif
  hits[pixel] = hit.Key;
  if (first)
  {
    hits[ImagePixels() + pixel] = floatBitsToUint(depth);
  }
#ifdef SEVERAL_ISOVALUES
  uint at = 2u * ImagePixels() + pixel;
  uint firstIsovalue = first ? uint(hit.Isovalue) : hits[at] >> 16;
  hits[at] = uint(hit.Isovalue) | firstIsovalue << 16;
#endif
}
#endif
