// Rays and their parameters (section 3.2). Everything a ray meets is ordered by the parameters t of the
// voxel planes it crosses; a plane's t is one formula of the ray and the plane's integer index, in double
// precision. So any stage, in any pass, finds the same t for the same plane, and a ray's state is just the
// block it is in: nothing accumulates, nothing is derived back from t, and neighbouring cells share their
// face's t to the last bit.

#include "Surface/Hits.glsl"

struct Ray
{
  dvec3 Origin;    // index space
  dvec3 Direction; // index space, per unit of t
  dvec3 Inverse;   // 1 / direction; finite and huge where the ray is parallel to the planes
  ivec3 Step;      // +1 or -1
  double Enter, Leave; // parameters at which the ray enters and leaves the volume, or the part of it that is drawn
};

// Parameters at which the ray crosses the plane of this index on each axis.
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

// Parallel rays: planes ahead are never reached, planes behind were crossed long ago.
double FiniteInverse(double d)
{
  return abs(d) > 1e-290LF ? 1.0LF / d : 1e290LF;
}

// Centre of a pixel; pixels are numbered in rows from the bottom left.
dvec2 PixelCentre(uint pixel)
{
  return dvec2(double(pixel % uint(view.ImageSize.x)), double(pixel / uint(view.ImageSize.x))) + 0.5LF;
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
// Parameter at which a ray meets opaque geometry of this depth in the window.
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
  precise dvec3 origin = view.RayOrigin.Base + at.x * view.RayOrigin.PerX + at.y * view.RayOrigin.PerY;
  precise dvec3 direction =
    view.RayDirection.Base + at.x * view.RayDirection.PerX + at.y * view.RayDirection.PerY;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Inverse = dvec3(FiniteInverse(direction.x), FiniteInverse(direction.y), FiniteInverse(direction.z));
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
  return vec3(view.EyeDirection.Base + at.x * view.EyeDirection.PerX + at.y * view.EyeDirection.PerY);
}

// ---- tile order: pixels in tiles of 8 x 8, so that neighbours in a work group are neighbours in the image
uint Tiles(int pixels)
{
  return uint(pixels + 7) >> 3;
}

uint PixelsInTiles()
{
  return 64u * Tiles(view.ImageSize.x) * Tiles(view.ImageSize.y);
}

// NONE for those parts of the last tiles that stick out of the image.
uint PixelInTileOrder(uint order)
{
  uint tile = order >> 6;
  uint x = 8u * (tile % Tiles(view.ImageSize.x)) + (order & 7u);
  uint y = 8u * (tile / Tiles(view.ImageSize.x)) + ((order >> 3) & 7u);
  return x < uint(view.ImageSize.x) && y < uint(view.ImageSize.y) ? y * uint(view.ImageSize.x) + x : NONE;
}

uint TileOrderOf(uint pixel)
{
  uint x = pixel % uint(view.ImageSize.x);
  uint y = pixel / uint(view.ImageSize.x);
  return 64u * ((y >> 3) * Tiles(view.ImageSize.x) + (x >> 3)) + 8u * (y & 7u) + (x & 7u);
}

// Blocks that each of so many rays may ask for (N_spec, section 4).
uint Speculation(uint rays)
{
  return clamp(ImagePixels() / (PIXELS_PER_BLOCK_AHEAD * max(rays, 1u)), 1u, cache.SpeculationLimit);
}

// ---- hit keys: unsigned integers in the order of t
uint HitKey(Ray ray, double t)
{
  precise double extent = ray.Leave - ray.Enter;
  precise double fraction = extent > 0.0LF ? clamp((t - ray.Enter) / extent, 0.0LF, 1.0LF) : 0.0LF;
  return uint(fraction * HIT_STEPS);
}

double HitT(Ray ray, uint key)
{
  return ray.Enter + (double(key) + 0.5LF) / HIT_STEPS * (ray.Leave - ray.Enter);
}
