// What the rays of pixels have met. The buffer has a section of a word a pixel for each of:
// - the hit's key,
// - its depth along the view direction; in a translucent image that of the first hit,
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
uint HitWord(uint section, uint pixel)
{
  return section * ImagePixels() + pixel;
}

uint HitKeyOf(uint pixel)
{
  return hits[HitWord(KEY_SECTION, pixel)];
}

Hit HitOf(uint pixel)
{
#ifdef SEVERAL_ISOVALUES
  return Hit(HitKeyOf(pixel), int(hits[HitWord(ISOVALUE_SECTION, pixel)] & 0xFFFFu));
#else
  return Hit(HitKeyOf(pixel), 0);
#endif
}

float DepthOf(uint pixel)
{
  return uintBitsToFloat(hits[HitWord(DEPTH_SECTION, pixel)]);
}

float ObstacleOf(uint pixel)
{
  return uintBitsToFloat(hits[HitWord(OBSTACLE_SECTION, pixel)]);
}

#ifdef COLORED
float ColorValueOf(uint pixel)
{
  return uintBitsToFloat(hits[HitWord(COLOR_SECTION, pixel)]);
}
#endif
#endif

#ifdef WRITES_HITS
#ifdef COLORED
void StoreColorValue(uint pixel, float value)
{
  hits[HitWord(COLOR_SECTION, pixel)] = floatBitsToUint(value);
}
#endif

void StoreHit(uint pixel, Hit hit, float depth)
{
#ifdef TRANSLUCENT
  bool first = HitKeyOf(pixel) == NO_HIT;
#else
  bool first = true;
#endif
  hits[HitWord(KEY_SECTION, pixel)] = hit.Key;
  if (first)
  {
    hits[HitWord(DEPTH_SECTION, pixel)] = floatBitsToUint(depth);
  }
#ifdef SEVERAL_ISOVALUES
  uint at = HitWord(ISOVALUE_SECTION, pixel);
  uint firstIsovalue = first ? uint(hit.Isovalue) : hits[at] >> 16;
  hits[at] = uint(hit.Isovalue) | firstIsovalue << 16;
#endif
}
#endif
