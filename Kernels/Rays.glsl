// Rays and their parameters. Everything a ray meets is ordered by the parameters t of the voxel planes
// it crosses; a plane's t is one formula of the ray and the plane's integer index, in double precision.
// So any stage, in any pass, finds the same t for the same plane, and a ray's state is just the block
// it is in: nothing accumulates, nothing is derived back from t, and neighbouring cells share their
// face's t to the last bit.

#define HIT_STEPS 4294967040.0LF // hit keys: the ray's way through the volume in 32-bit fixed point

struct Ray
{
  dvec3 Origin;    // index space
  dvec3 Direction; // index space, per unit of t
  dvec3 Inverse;   // 1 / direction; finite and huge where the ray is parallel to the planes
  ivec3 Step;      // +1 or -1
  double Enter, Leave; // parameters at which the ray enters and leaves the volume
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

// The ray through the centre of a pixel, numbered in rows from the bottom left (section 3.2).
Ray CameraRay(uint pixel)
{
  double x = double(pixel % uint(scene.Image.x)) + 0.5LF;
  double y = double(pixel / uint(scene.Image.x)) + 0.5LF;
  Ray ray;
  precise dvec3 origin = scene.RayOrigin[0].xyz + x * scene.RayOrigin[1].xyz + y * scene.RayOrigin[2].xyz;
  precise dvec3 direction =
    scene.RayDirection[0].xyz + x * scene.RayDirection[1].xyz + y * scene.RayDirection[2].xyz;
  ray.Origin = origin;
  ray.Direction = direction;
  ray.Inverse = dvec3(FiniteInverse(direction.x), FiniteInverse(direction.y), FiniteInverse(direction.z));
  ray.Step = 1 - 2 * ivec3(lessThan(direction, dvec3(0.0LF)));
  dvec3 first = PlanesT(ray, ivec3(0));
  dvec3 last = PlanesT(ray, scene.Samples.xyz - 1);
  ray.Enter = max(LargestOf(min(first, last)), scene.RayRange.x);
  ray.Leave = min(SmallestOf(max(first, last)), scene.RayRange.y);
  return ray;
}

// ---- hit keys: unsigned integers in the order of t, so that atomicMin keeps the nearest hit
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
