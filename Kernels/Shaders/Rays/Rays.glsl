// Camera rays, and the parameters t of the voxel planes that they cross: t orders all they meet.
// A plane's t is one formula of the ray and the plane's integer index, in double precision. Every
// stage in every pass therefore finds the same t for the same plane, and neighbouring cells share
// their face's t to the last bit. Nothing accumulates and nothing is derived back from t, so that
// the state of a ray is just the block that it is in.

#include "Shared/Scene.glsl"
#include "Surface/Hits.glsl"

struct Ray
{
  dvec3 Origin;    // index space
  dvec3 Direction; // index space, per unit of t
  dvec3 Inverse;   // 1 / direction; finite and huge where the ray is parallel to the planes
  ivec3 Step;      // +1 or -1
  double Enter, Leave; // parameters between which the ray is in the part that is drawn
};

// Parameters at which a ray crosses the plane with this index on each axis.
dvec3 PlanesT(Ray ray, ivec3 index)
{
  precise dvec3 t = (dvec3(index) - ray.Origin) * ray.Inverse;
  return t;
}

double SmallestOf(dvec3 v)
{
  return min(v.x, min(v.y, v.z));
}

double LargestOf(dvec3 v)
{
  return max(v.x, max(v.y, v.z));
}

// Keeps planes finite to which a ray is parallel: it never reaches those ahead, and crossed those
// behind long ago.
double FiniteInverse(double d)
{
  return abs(d) > 1e-290LF ? 1.0LF / d : 1e290LF;
}

// Pixels are numbered in rows from the bottom left.
dvec2 PixelCentre(uint pixel)
{
  uint width = uint(view.ImageSize.x);
  return dvec2(double(pixel % width), double(pixel / width)) + 0.5LF;
}

#ifdef CLIPPED
void ClipRay(inout Ray ray)
{
  for (int i = 0; i < view.NumberOfClippingPlanes; ++i)
  {
    ClippingPlane plane = view.ClippingPlanes[i];
    precise double at = dot(plane.Normal, ray.Origin) + plane.Offset;
    precise double along = dot(plane.Normal, ray.Direction);
    precise double t = -at * FiniteInverse(along);
    ray.Enter = along > 0.0LF ? max(ray.Enter, t) : ray.Enter;
    ray.Leave = along < 0.0LF ? min(ray.Leave, t) : ray.Leave;
    ray.Leave = along == 0.0LF && at < 0.0LF ? ray.Enter - 1.0LF : ray.Leave;
  }
}
#endif

#if defined(OBSTRUCTED) && defined(BUFFER_HITS)
// Parameter at which a ray meets opaque geometry that has this depth in the window.
double ObstacleT(float depth)
{
  double z = 2.0LF * double(depth) - 1.0LF;
  return (double(look.ClipZ) - z * double(look.ClipW)) /
    (z * double(look.ClipWPerT) - double(look.ClipZPerT));
}
#endif

// The ray through the centre of a pixel.
Ray CameraRay(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  Ray ray;
  precise dvec3 origin =
    view.RayOrigin.Base + at.x * view.RayOrigin.PerX + at.y * view.RayOrigin.PerY;
  precise dvec3 direction =
    view.RayDirection.Base + at.x * view.RayDirection.PerX + at.y * view.RayDirection.PerY;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Inverse =
    dvec3(FiniteInverse(direction.x), FiniteInverse(direction.y), FiniteInverse(direction.z));
  ray.Step = 1 - 2 * ivec3(lessThan(direction, dvec3(0.0LF)));
  dvec3 first = PlanesT(ray, view.FirstDrawn);
  dvec3 last = PlanesT(ray, view.LastDrawn);
  ray.Enter = max(LargestOf(min(first, last)), view.NearDistance);
  ray.Leave = min(SmallestOf(max(first, last)), view.FarDistance);
#ifdef CLIPPED
  ClipRay(ray);
#endif
#if defined(OBSTRUCTED) && defined(BUFFER_HITS)
  ray.Leave = min(ray.Leave, ObstacleT(ObstacleOf(pixel)));
#endif
  return ray;
}

// The same ray in view coordinates, where the surface is lit.
vec3 EyeRayOrigin(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  return vec3(view.EyeOrigin.Base + at.x * view.EyeOrigin.PerX + at.y * view.EyeOrigin.PerY);
}

vec3 EyeRayDirection(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  return vec3(
    view.EyeDirection.Base + at.x * view.EyeDirection.PerX + at.y * view.EyeDirection.PerY);
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

// NONE where the last tiles reach beyond the image.
uint PixelInTileOrder(uint order)
{
  uint tile = order / PIXELS_PER_TILE;
  uint x = TILE_SIDE * (tile % Tiles(view.ImageSize.x)) + order % TILE_SIDE;
  uint y = TILE_SIDE * (tile / Tiles(view.ImageSize.x)) + (order / TILE_SIDE) % TILE_SIDE;
  bool inImage = x < uint(view.ImageSize.x) && y < uint(view.ImageSize.y);
  return inImage ? y * uint(view.ImageSize.x) + x : NONE;
}

uint TileOrderOf(uint pixel)
{
  uint x = pixel % uint(view.ImageSize.x);
  uint y = pixel / uint(view.ImageSize.x);
  uint tile = (y / TILE_SIDE) * Tiles(view.ImageSize.x) + x / TILE_SIDE;
  return PIXELS_PER_TILE * tile + TILE_SIDE * (y % TILE_SIDE) + x % TILE_SIDE;
}

// Number of blocks that each of `rays` rays may ask for (N_spec of the paper).
uint Speculation(uint rays)
{
  uint blocks = ImagePixels() / (PIXELS_PER_BLOCK_AHEAD * max(rays, 1u));
  return clamp(blocks, 1u, cache.SpeculationLimit);
}

// ---- hit keys: the place between Enter and Leave in fixed point
uint HitKey(Ray ray, double t)
{
  precise double extent = ray.Leave - ray.Enter;
  precise double fraction =
    extent > 0.0LF ? clamp((t - ray.Enter) / extent, 0.0LF, 1.0LF) : 0.0LF;
  return uint(fraction * HIT_STEPS);
}

double HitT(Ray ray, uint key)
{
  return ray.Enter + (double(key) + 0.5LF) / HIT_STEPS * (ray.Leave - ray.Enter);
}
