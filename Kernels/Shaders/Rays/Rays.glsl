// Camera rays, and the parameters t of the voxel planes that they cross: t orders all they meet.
// It is a whole number: on each axis the planes' parameters are First + index * Spacing, exactly.
// Every stage in every pass, on every GPU, therefore finds the same t for the same plane, and
// neighbouring cells share their face's. Nothing is derived back from t, so that the state of a ray
// is just the block that it is in.

#include "Shared/Scene.glsl"
#include "Shared/Wide.glsl"
#include "Surface/Hits.glsl"

// A ray in index space, in fixed point of 32 bits behind the point.
struct RayLine
{
  Wide3 Origin; // at t = 0
  Wide3 Way;    // from there to t = 2^WAY_BITS
};

struct Ray
{
  Wide3 First;      // parameters of the planes with index 0,
  Wide3 Spacing;    // and from each plane to the next one that the ray meets
  vec3 CellsPerT;   // not negative
  vec3 Begin;       // place in the first cell at Enter, from 0 to 1 in the direction of the ray
  ivec3 FirstCell;  // at Enter, but for planes that it lies on
  ivec3 Step;       // +1 or -1
  Wide Enter, Leave; // parameters between which the ray is in the part that is drawn
#ifdef LEVELS
  // All but Enter are those of a level of detail, of which the ray has a stretch: see
  // LevelStretches.glsl.
  Wide From;    // parameter where the stretch begins; it ends at Leave
  Wide End;     // where the ray leaves what is drawn
  bool Blends;  // with the next level
  bool Doubted; // has passed a block where the volume itself may have a surface
  bool Finest;  // looks at the volume itself, within a block of a coarser level
#endif
};

const Wide WAY = WIDE(1 << (WAY_BITS - 32), 0u);
// Planes of which not two are met: any spacing from here on is as good.
const Wide WIDEST_SPACING = WIDE(1 << (WAY_BITS - 31), 0u);
// Behind the way's end, by half of it: a plane there is never met.
const Wide NEVER_MET = WIDE(3 << (WAY_BITS - 33), 0u);
// Beyond all that a ray is compared with, and no sum of two wraps.
const Wide FARTHEST = WIDE(1 << 29, 0u);

// -1 on each axis on which the ray goes backwards, else 0.
ivec3 IsBackwards(Ray ray)
{
  return ray.Step >> 31;
}

// Parameters at which a ray crosses the plane with this index on each axis.
Wide3 PlanesT(Ray ray, ivec3 index)
{
  return Sum(ray.First, Negated(Product(ray.Spacing, uvec3(index)), IsBackwards(ray)));
}

// Pixels of the image are numbered in rows from the bottom left.
uvec2 PlaceInImage(uint pixel)
{
  uint width = uint(view.ImageSize.x);
  return uvec2(pixel % width, pixel / width);
}

// The rays are the viewport's, so that they are the same to the bit whatever part of it has rays.
uvec2 PlaceInViewport(uint pixel)
{
  return uvec2(view.FirstPixel) + PlaceInImage(pixel);
}

// So many times what is gained for each half pixel.
Wide3 GainOf(ivec3 high, uvec3 low, uvec3 least, uint halves)
{
  uvec3 carried, unused;
  umulExtended(least, uvec3(halves), carried, unused);
  return Sum(Product(WideOf(high, low), uvec3(halves)), WideOf(ivec3(0), carried));
}

Wide3 AtPixel(FixedPixelVector vector, uvec2 place)
{
  uvec2 halves = 2u * place + 1u;
  Wide3 x = GainOf(vector.PerXHigh, vector.PerXLow, vector.PerXLeast, halves.x);
  Wide3 y = GainOf(vector.PerYHigh, vector.PerYLow, vector.PerYLeast, halves.y);
  return Sum(WideOf(vector.BaseHigh, vector.BaseLow), Sum(x, y));
}

RayLine LineOf(uint pixel)
{
  uvec2 place = PlaceInViewport(pixel);
  return RayLine(AtPixel(view.RayOrigin, place), AtPixel(view.RayWay, place));
}

// How fast coordinates change along a ray, for the parameters at which they reach a value.
struct Speed
{
  ivec3 Backwards; // -1 where a coordinate falls, else 0
  Wide3 Inverse;   // 2^(126 - Zeros) / the absolute way
  ivec3 Zeros;     // leading zero bits of the absolute way, 2 or more
};

Speed SpeedOf(Wide3 way)
{
  Speed speed;
  speed.Backwards = AreNegative(way);
  Wide3 absolute = Negated(way, speed.Backwards);
  // a plane to which the ray is parallel is met beyond all others
  absolute = LargerOf(absolute, AllOf(WIDE(0, 1u)));
  speed.Zeros = LeadingZeros(absolute);
  speed.Inverse = Reciprocal(ShiftLeft(absolute, speed.Zeros));
  return speed;
}

// Parameters at which coordinates have changed by so much; FARTHEST, before or behind, beyond twice
// the way.
Wide3 ReachedAt(Speed speed, Wide3 change)
{
  ivec3 negative = AreNegative(change);
  Wide3 scaled = HighProduct(Negated(change, negative), speed.Inverse);
  // in eighths, so that no shift goes to the right
  ivec3 bits = speed.Zeros - (126 - 64 - WAY_BITS - 3);
  ivec3 far = -ivec3(lessThan(LeadingZeros(scaled) - bits, ivec3(3)));
  Wide3 t = Halved(ShiftLeft(scaled, bits), 3);
  return Negated(Choose(t, AllOf(FARTHEST), far), negative ^ speed.Backwards);
}

// From a plane of voxels to the next.
Wide3 SpacingOf(Speed speed)
{
  const int bits = 126 - 32 - WAY_BITS;
  Wide3 spacing = ShiftRight(speed.Inverse, clamp(bits - speed.Zeros, 0, 63));
  ivec3 wide = -ivec3(greaterThan(speed.Zeros, ivec3(32))); // less than half a cell on all the way
  return Choose(spacing, AllOf(WIDEST_SPACING), wide);
}

Wide3 ChangeToPlanes(RayLine line, ivec3 index)
{
  return Difference(WideOf(index, uvec3(0u)), line.Origin);
}

// The place of a ray at a parameter from 0 to 2^WAY_BITS.
Wide3 PlaceAt(RayLine line, Wide t)
{
  const int bits = 63 - WAY_BITS; // 64 would be one too many at the end of the way
  ivec3 negative = AreNegative(line.Way);
  Wide3 halfOfGain = HighProduct(Negated(line.Way, negative), AllOf(Doubled(t, bits)));
  return Sum(line.Origin, Negated(ShiftLeft(halfOfGain, ivec3(1)), negative));
}

// Within a cell, from 0 to 1 between its planes.
vec3 PlaceInCell(Wide3 place, ivec3 cell)
{
  return clamp(vec3(HighOf(place) - cell) + vec3(LowOf(place)) * (1.0 / TWO_TO_32), 0.0, 1.0);
}

#ifdef CLIPPED
void ClipRay(inout Ray ray, uint pixel)
{
  uvec2 place = PlaceInViewport(pixel);
  for (int i = 0; 3 * i < view.NumberOfClippingPlanes; ++i)
  {
    Wide3 distance = AtPixel(view.ClippingOrigin[i], place);
    Speed speed = SpeedOf(AtPixel(view.ClippingWay[i], place));
    Wide3 t = ReachedAt(speed, Difference(AllOf(WIDE(0, 0u)), distance));
    Wide3 enter = Choose(t, AllOf(ray.Enter), speed.Backwards);
    Wide3 leave = Choose(AllOf(ray.Leave), t, speed.Backwards);
    ray.Enter = LargerOf(ray.Enter, LargestOf(enter));
    ray.Leave = SmallerOf(ray.Leave, SmallestOf(leave));
  }
}
#endif

// ---- depths along the view direction
float DepthAt(Wide t)
{
  return view.FirstDepth + view.DepthOfWay * (ToFloat(t) * (1.0 / ToFloat(WAY)));
}

Wide AtDepth(float depth)
{
  float way = clamp((depth - view.FirstDepth) / view.DepthOfWay, 0.0, 1.0);
  return ToWide(way * ToFloat(WAY));
}

#if defined(OBSTRUCTED) && defined(BUFFER_HITS)
// Parameter at which a ray meets opaque geometry that has this depth in the window.
Wide ObstacleT(float depth)
{
  precise float z = 2.0 * depth - 1.0;
  precise float above = look.ClipZ - z * look.ClipW;
  precise float below = z * look.ClipWPerT - look.ClipZPerT;
  return AtDepth(above / below);
}
#endif

// The planes through which a ray leaves what is drawn.
ivec3 LastPlanes(Speed speed)
{
  return Choose(view.LastDrawn, view.FirstDrawn, speed.Backwards);
}

Wide EnterT(RayLine line, Speed speed)
{
  ivec3 planes = Choose(view.FirstDrawn, view.LastDrawn, speed.Backwards);
  return LargerOf(WIDE(0, 0u), LargestOf(ReachedAt(speed, ChangeToPlanes(line, planes))));
}

// A ray that is outside where it should enter has left through other planes before; rounding by
// some units does not count.
bool IsDrawnAt(Wide3 place)
{
  Wide3 rounding = AllOf(WIDE(0, 16u));
  Wide3 sinceFirst = Difference(Sum(place, rounding), WideOf(view.FirstDrawn, uvec3(0u)));
  Wide3 untilLast = Difference(WideOf(view.LastDrawn, uvec3(0u)), Difference(place, rounding));
  return (AreNegative(sinceFirst) | AreNegative(untilLast)) == ivec3(0);
}

// Places the planes of all cells, from those through which the ray leaves its first cell: `next`.
void PlacePlanes(RayLine line, Speed speed, ivec3 next, inout Ray ray)
{
  ray.Spacing = SpacingOf(speed);
  Wide3 at = ReachedAt(speed, ChangeToPlanes(line, next));
  at = SmallerOf(SmallerOf(at, Sum(AllOf(ray.Enter), ray.Spacing)), AllOf(NEVER_MET));
  at = LargerOf(at, AllOf(ray.Enter)); // whatever the rounding: the ray is in its first cell
  ray.First = Difference(at, Negated(Product(ray.Spacing, uvec3(next)), speed.Backwards));
}

// Parameter at which the ray leaves through one of the last planes, by the planes' own formula, so
// that no cell behind them is entered. Parameters that wrap are of planes that are not met.
Wide LastT(Ray ray, ivec3 next, ivec3 last)
{
  vec3 way = vec3(abs(last - next)) * ToFloat(ray.Spacing);
  ivec3 met = -ivec3(lessThan(way, vec3(ToFloat(NEVER_MET))));
  return SmallestOf(Choose(AllOf(NEVER_MET), PlanesT(ray, last), met));
}

// The ray through the centre of a pixel. It misses what is drawn if it leaves before it enters.
Ray CameraRay(uint pixel)
{
  RayLine line = LineOf(pixel);
  Speed speed = SpeedOf(line.Way);
  Ray ray;
  ray.Step = 1 + 2 * speed.Backwards;
  ray.CellsPerT = abs(ToFloat(line.Way)) * (1.0 / TWO_TO_32) * (1.0 / ToFloat(WAY));
  ray.Enter = EnterT(line, speed);
  ray.Leave = WAY;
#ifdef CLIPPED
  ClipRay(ray, pixel);
#endif
#if defined(OBSTRUCTED) && defined(BUFFER_HITS)
  ray.Leave = SmallerOf(ray.Leave, ObstacleT(ObstacleOf(pixel)));
#endif
  Wide3 place = PlaceAt(line, SmallerOf(ray.Enter, WAY));
  if (IsLess(ray.Leave, ray.Enter) || !IsDrawnAt(place))
  {
    ray.Leave = Difference(ray.Enter, WIDE(0, 1u));
    return ray;
  }
  ray.FirstCell = clamp(HighOf(place), view.FirstDrawn, view.LastDrawn - 1);
  vec3 begin = PlaceInCell(place, ray.FirstCell);
  ray.Begin = mix(begin, 1.0 - begin, notEqual(speed.Backwards, ivec3(0)));
  ivec3 next = ray.FirstCell + (1 + ray.Step) / 2;
  PlacePlanes(line, speed, next, ray);
  ray.Leave = SmallerOf(ray.Leave, LastT(ray, next, LastPlanes(speed)));
  return ray;
}

bool Misses(Ray ray)
{
  return view.HasRays == 0 || IsLess(ray.Leave, ray.Enter);
}

// The same ray in view coordinates, where the surface is lit.
vec2 PixelCentre(uint pixel)
{
  return vec2(PlaceInViewport(pixel)) + 0.5;
}

vec3 EyeRayOrigin(uint pixel)
{
  vec2 at = PixelCentre(pixel);
  return view.EyeOrigin.Base + at.x * view.EyeOrigin.PerX + at.y * view.EyeOrigin.PerY;
}

vec3 EyeRayDirection(uint pixel)
{
  vec2 at = PixelCentre(pixel);
  return view.EyeDirection.Base + at.x * view.EyeDirection.PerX + at.y * view.EyeDirection.PerY;
}

// ---- tile order: pixels in square tiles, so that neighbours in a work group are neighbours in the
// image
const uint TILE_SIDE = 8u;
const uint PIXELS_PER_TILE = TILE_SIDE * TILE_SIDE;

uint Tiles(int pixels)
{
  return (uint(pixels) + TILE_SIDE - 1u) / TILE_SIDE;
}

uint PixelsInTiles()
{
  return PIXELS_PER_TILE * Tiles(view.ImageSize.x) * Tiles(view.ImageSize.y);
}

// In a tile, each 2^n pixels in order from a multiple of it are a square or two of them: however
// many lanes run in step, their pixels are neighbours. From the lowest bit on an order has two bits
// of x, two of y, the third of x and the third of y.
uvec2 PlaceInTile(uint order)
{
  return uvec2((order & 3u) | (order >> 2u & 4u), (order >> 2u & 3u) | (order >> 3u & 4u));
}

uint OrderInTile(uvec2 place)
{
  return (place.x & 3u) | (place.y & 3u) << 2u | (place.x & 4u) << 2u | (place.y & 4u) << 3u;
}

// NONE where the last tiles reach beyond the image.
uint PixelInTileOrder(uint order)
{
  uint tile = order / PIXELS_PER_TILE;
  uint width = Tiles(view.ImageSize.x);
  uvec2 first = TILE_SIDE * uvec2(tile % width, tile / width);
  uvec2 place = first + PlaceInTile(order % PIXELS_PER_TILE);
  bool inImage = all(lessThan(place, uvec2(view.ImageSize)));
  return inImage ? place.y * uint(view.ImageSize.x) + place.x : NONE;
}

uint TileOrderOf(uint pixel)
{
  uvec2 place = PlaceInImage(pixel);
  uvec2 tile = place / TILE_SIDE;
  return PIXELS_PER_TILE * (tile.y * Tiles(view.ImageSize.x) + tile.x) +
    OrderInTile(place % TILE_SIDE);
}

// Measures how much work the GPU takes at once, however small a part of the viewport has rays.
uint ViewportPixels()
{
  return uint(view.ViewportSize.x * view.ViewportSize.y);
}

// Number of blocks that each of `rays` rays may ask for (N_spec of the paper).
uint Speculation(uint rays)
{
  uint blocks = ViewportPixels() / (PIXELS_PER_BLOCK_AHEAD * max(rays, 1u));
  return clamp(blocks, 1u, cache.SpeculationLimit);
}

// ---- hit keys: the upper bits of the parameter
uint HitKey(Wide t)
{
  Wide last = Difference(WAY, WIDE(0, 1u));
  Wide at = SmallerOf(LargerOf(t, WIDE(0, 0u)), last);
  const int bits = WAY_BITS - KEY_BITS;
  uint key = uint(HighOf(at)) << (32 - bits) | LowOf(at) >> bits;
  return min(key, NO_HIT - 1u);
}

// The middle of the parameters that have this key.
Wide HitT(uint key)
{
  const int bits = WAY_BITS - KEY_BITS;
  return WideOf(int(key >> (32 - bits)), key << bits | 1u << (bits - 1));
}
