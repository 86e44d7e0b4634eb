// Rays and their parameters (section 3.2). Everything a ray meets is ordered by the parameters t of the
// voxel planes it crosses; a plane's t is one formula of the ray and the plane's integer index, in double
// precision. So any stage, in any pass, finds the same t for the same plane, and a ray's state is just the
// block it is in: nothing accumulates, nothing is derived back from t, and neighbouring cells share their
// face's t to the last bit.

#include "Surface/Hits.glsl"

#define HIT_STEPS 4294967040.0LF // hit keys: the ray's way through the volume in 32-bit fixed point

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
  return dvec2(double(pixel % uint(scene.Image.x)), double(pixel / uint(scene.Image.x))) + 0.5LF;
}

#ifdef CLIPPED
void ClipRay(inout Ray ray)
{
  for (int i = 0; i < scene.Surface.y; ++i)
  {
    dvec4 plane = scene.ClippingPlanes[i];
    precise double at = dot(plane.xyz, ray.Origin) + plane.w;
    precise double along = dot(plane.xyz, ray.Direction);
    precise double t = -at * FiniteInverse(along);
    ray.Enter = along > 0.0LF ? max(ray.Enter, t) : ray.Enter;
    ray.Leave = along < 0.0LF ? min(ray.Leave, t) : ray.Leave;
    ray.Leave = along == 0.0LF && at < 0.0LF ? ray.Enter - 1.0LF : ray.Leave;
  }
}
#endif

#if defined(OBSTRUCTED) && defined(BINDING_HITS)
// Parameter at which a ray meets opaque geometry of this depth in the window.
double ObstacleT(float depth)
{
  double z = 2.0LF * double(depth) - 1.0LF;
  dvec4 terms = dvec4(scene.DepthTerms);
  return (terms.x - z * terms.z) / (z * terms.w - terms.y);
}
#endif

// The ray through the centre of a pixel.
Ray CameraRay(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  Ray ray;
  precise dvec3 origin = scene.RayOrigin[0].xyz + at.x * scene.RayOrigin[1].xyz + at.y * scene.RayOrigin[2].xyz;
  precise dvec3 direction =
    scene.RayDirection[0].xyz + at.x * scene.RayDirection[1].xyz + at.y * scene.RayDirection[2].xyz;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Inverse = dvec3(FiniteInverse(direction.x), FiniteInverse(direction.y), FiniteInverse(direction.z));
  ray.Step = 1 - 2 * ivec3(lessThan(direction, dvec3(0.0LF)));
  dvec3 first = PlanesT(ray, scene.FirstDrawn.xyz);
  dvec3 last = PlanesT(ray, scene.LastDrawn.xyz);
  ray.Enter = max(LargestOf(min(first, last)), scene.RayRange.x);
  ray.Leave = min(SmallestOf(max(first, last)), scene.RayRange.y);
#ifdef CLIPPED
  ClipRay(ray);
#endif
#if defined(OBSTRUCTED) && defined(BINDING_HITS)
  ray.Leave = min(ray.Leave, ObstacleT(ObstacleOf(pixel)));
#endif
  return ray;
}

// The same ray in view coordinates, where the surface is lit.
vec3 EyeRayOrigin(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  return vec3(scene.EyeOrigin[0].xyz + at.x * scene.EyeOrigin[1].xyz + at.y * scene.EyeOrigin[2].xyz);
}

vec3 EyeRayDirection(uint pixel)
{
  dvec2 at = PixelCentre(pixel);
  return vec3(scene.EyeDirection[0].xyz + at.x * scene.EyeDirection[1].xyz + at.y * scene.EyeDirection[2].xyz);
}

// ---- tile order: pixels in tiles of 8 x 8, so that neighbours in a work group are neighbours in the image
uint Tiles(int pixels)
{
  return uint(pixels + 7) >> 3;
}

uint PixelsInTiles()
{
  return 64u * Tiles(scene.Image.x) * Tiles(scene.Image.y);
}

// NONE for those parts of the last tiles that stick out of the image.
uint PixelInTileOrder(uint order)
{
  uint tile = order >> 6;
  uint x = 8u * (tile % Tiles(scene.Image.x)) + (order & 7u);
  uint y = 8u * (tile / Tiles(scene.Image.x)) + ((order >> 3) & 7u);
  return x < uint(scene.Image.x) && y < uint(scene.Image.y) ? y * uint(scene.Image.x) + x : NONE;
}

uint TileOrderOf(uint pixel)
{
  uint x = pixel % uint(scene.Image.x);
  uint y = pixel / uint(scene.Image.x);
  return 64u * ((y >> 3) * Tiles(scene.Image.x) + (x >> 3)) + 8u * (y & 7u) + (x & 7u);
}

// Blocks that each of so many rays may ask for (N_spec, section 4).
uint Speculation(uint rays)
{
  return clamp(ImagePixels() / (scene.Policy.y * max(rays, 1u)), 1u, scene.Cache.z);
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
