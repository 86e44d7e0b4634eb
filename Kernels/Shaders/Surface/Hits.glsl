// What the rays of pixels have met. The buffer has a section of a word a pixel for each of:
// - the hit's key,
// - its depth along the view direction; in a translucent image that of the first hit. With levels
//   of detail its sign bit tells of that hit, or of a miss: see LEVEL_FLAG,
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

#ifdef LEVELS
// The sign bit of a depth. Of a conservative image: the hit is on the volume itself, whatever level
// is drawn at its depth. Of another: the volume itself may have a surface before it that the levels
// do not show. A miss has nothing but this bit then.
const uint LEVEL_FLAG = 0x80000000u;
#endif

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
#ifdef LEVELS
  return abs(uintBitsToFloat(hits[HitWord(DEPTH_SECTION, pixel)]));
#else
  return uintBitsToFloat(hits[HitWord(DEPTH_SECTION, pixel)]);
#endif
}

#ifdef LEVELS
bool HasLevelFlag(uint pixel)
{
  return (hits[HitWord(DEPTH_SECTION, pixel)] & LEVEL_FLAG) != 0u;
}

// Has the ray of a pixel without a hit been marked?
bool IsMissFlagged(uint pixel)
{
  return HitKeyOf(pixel) == NO_HIT && hits[HitWord(DEPTH_SECTION, pixel)] == LEVEL_FLAG;
}
#endif

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

#ifdef LEVELS
// Marks the ray of a pixel that has no hit yet.
void FlagMiss(uint pixel)
{
  if (HitKeyOf(pixel) == NO_HIT)
  {
    hits[HitWord(DEPTH_SECTION, pixel)] = LEVEL_FLAG;
  }
}
#endif

// A negative depth has the flag of levels.
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
