// The surface's normal where a ray has met it: the trilinear interpolant of the voxels' central differences, as
// in VTK's mapper, hence continuous across cells and blocks; one-sided at the volume's border, as in VTK's meshes.

struct SurfacePoint
{
  ivec3 Cell; // that holds the hit
  vec3 Local; // coordinates in its unit cube
};

// From the key alone, so that it is the same in whichever pass the normal is found.
SurfacePoint PointOf(Ray ray, uint key)
{
  dvec3 p = ray.Origin + HitT(ray, key) * ray.Direction;
  SurfacePoint hit;
  hit.Cell = ivec3(clamp(floor(p), dvec3(0.0LF), dvec3(volume.Samples - 2)));
  hit.Local = clamp(vec3(p - dvec3(hit.Cell)), vec3(0.0), vec3(1.0));
  return hit;
}

// First and last of the blocks that the samples around a cell lie in: central differences reach a voxel beyond it.
ivec3 FirstStencilBlock(ivec3 cell)
{
  return max(cell - 1, ivec3(0)) >> 2;
}

ivec3 LastStencilBlock(ivec3 cell)
{
  return min(cell + 2, volume.Samples - 1) >> 2;
}

// For the four planes of samples from one before the cell to one behind it, on each axis: what they add to the index of
// a sample, and do they lie in the further block?
struct Stencil
{
  uvec4 X, Y, Z;
#ifdef HAS_CACHE_MAP
  bvec4 FurtherX, FurtherY, FurtherZ;
#endif
};

Stencil PlaceStencil(ivec3 cell)
{
  ivec3 end = volume.Samples - 1;
  ivec3 before = max(cell - 1, ivec3(0));
  ivec3 behind = min(cell + 2, end);
  uvec3 a = SampleOffsets(before);
  uvec3 b = SampleOffsets(cell);
  uvec3 c = NextOffsets(cell, b);
  uvec3 d = SampleOffsets(behind);
  Stencil at;
  at.X = uvec4(a.x, b.x, c.x, d.x);
  at.Y = uvec4(a.y, b.y, c.y, d.y);
  at.Z = uvec4(a.z, b.z, c.z, d.z);
#ifdef HAS_CACHE_MAP
  ivec3 first = before >> 2;
  bvec3 fb = notEqual(cell >> 2, first);
  bvec3 fc = notEqual((cell + 1) >> 2, first);
  bvec3 fd = notEqual(behind >> 2, first);
  at.FurtherX = bvec4(false, fb.x, fc.x, fd.x);
  at.FurtherY = bvec4(false, fb.y, fc.y, fd.y);
  at.FurtherZ = bvec4(false, fb.z, fc.z, fd.z);
#endif
  return at;
}

// An eighth of a sample, so that no difference overflows, by its planes on x, y and z: x, y, z, w of the four.
#ifdef HAS_CACHE_MAP
#define SAMPLE(i, j, k) (0.125 * uintBitsToFloat( \
  cacheValues[64u * SlotAt(bvec3(at.FurtherX.i, at.FurtherY.j, at.FurtherZ.k)) + at.X.i + at.Y.j + at.Z.k]))
#else
#define SAMPLE(i, j, k) (0.125 * uintBitsToFloat(cacheValues[at.X.i + at.Y.j + at.Z.k]))
#endif

#ifdef COLORED
#ifdef HAS_CACHE_MAP
#define COLOR_SAMPLE(i, j, k) uintBitsToFloat(cacheValues[64u * (NumberOfSlots() + \
  SlotAt(bvec3(at.FurtherX.i, at.FurtherY.j, at.FurtherZ.k))) + at.X.i + at.Y.j + at.Z.k])
#else
#define COLOR_SAMPLE(i, j, k) uintBitsToFloat(cacheValues[64u * NumberOfSlots() + at.X.i + at.Y.j + at.Z.k])
#endif

// The trilinear interpolant of the volume that gives the colours.
float ColorValue(SurfacePoint hit)
{
  Stencil at = PlaceStencil(hit.Cell);
  vec4 low = vec4(COLOR_SAMPLE(y, y, y), COLOR_SAMPLE(z, y, y), COLOR_SAMPLE(y, z, y), COLOR_SAMPLE(z, z, y));
  vec4 high = vec4(COLOR_SAMPLE(y, y, z), COLOR_SAMPLE(z, y, z), COLOR_SAMPLE(y, z, z), COLOR_SAMPLE(z, z, z));
  vec4 face = mix(low, high, hit.Local.z);
  vec2 edge = mix(face.xy, face.zw, hit.Local.y);
  return mix(edge.x, edge.y, hit.Local.x);
}
#endif

#ifdef HAS_HIDDEN_CELLS
#include "Store/HiddenCells.glsl"

// Of the 27 cells around a cell, itself the middle one, x fastest, which are hidden; beyond the volume its last cells count.
uint HiddenAround(ivec3 cell)
{
  ivec3 first = FirstStencilBlock(cell);
  uint around = 0u;
  for (int i = 0; i < 27; ++i)
  {
    ivec3 other = clamp(cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1, ivec3(0), volume.Samples - 2);
#ifdef HAS_CACHE_MAP
    uint slot = SlotAt(notEqual(other >> 2, first));
#else
    uint slot = BlockIndex(other >> 2);
#endif
    around |= Hides(HiddenInSlot(slot), other) ? 1u << i : 0u;
  }
  return around;
}

// Is an edge of the grid one of hidden cells only? `cells` are the bits of the four around it, moved by `place`.
bool OfHidden(uint around, uint cells, int place)
{
  return (around >> place & cells) == cells;
}

#define CELLS_X (1u | 1u << 3 | 1u << 9 | 1u << 12) // around an edge along x, y, z
#define CELLS_Y (1u | 1u << 1 | 1u << 9 | 1u << 10)
#define CELLS_Z (1u | 1u << 1 | 1u << 3 | 1u << 4)

// The samples beyond four corners' edges out of the cell, from the plane `place` on; those of hidden cells have no values
// that count, and what the corners and those opposite to them lead to stands in.
vec4 Beyond(vec4 samples, vec4 corners, vec4 opposite, uint around, uint cells, ivec4 places)
{
  bvec4 none = bvec4(OfHidden(around, cells, places.x), OfHidden(around, cells, places.y),
    OfHidden(around, cells, places.z), OfHidden(around, cells, places.w));
  return mix(samples, 2.0 * corners - opposite, none);
}
#endif

// Central differences at the cell's corners, interpolated. Planes y and z of the stencil are the cell's own.
vec3 Gradient(SurfacePoint hit)
{
  Stencil at = PlaceStencil(hit.Cell);
  // at the corners, x fastest; then across them to the outer planes of each axis, the axis' side the slowest
  vec4 low = vec4(SAMPLE(y, y, y), SAMPLE(z, y, y), SAMPLE(y, z, y), SAMPLE(z, z, y));
  vec4 high = vec4(SAMPLE(y, y, z), SAMPLE(z, y, z), SAMPLE(y, z, z), SAMPLE(z, z, z));
  vec4 beforeX = vec4(SAMPLE(x, y, y), SAMPLE(x, z, y), SAMPLE(x, y, z), SAMPLE(x, z, z));
  vec4 behindX = vec4(SAMPLE(w, y, y), SAMPLE(w, z, y), SAMPLE(w, y, z), SAMPLE(w, z, z));
  vec4 beforeY = vec4(SAMPLE(y, x, y), SAMPLE(z, x, y), SAMPLE(y, x, z), SAMPLE(z, x, z));
  vec4 behindY = vec4(SAMPLE(y, w, y), SAMPLE(z, w, y), SAMPLE(y, w, z), SAMPLE(z, w, z));
  vec4 beforeZ = vec4(SAMPLE(y, y, x), SAMPLE(z, y, x), SAMPLE(y, z, x), SAMPLE(z, z, x));
  vec4 behindZ = vec4(SAMPLE(y, y, w), SAMPLE(z, y, w), SAMPLE(y, z, w), SAMPLE(z, z, w));
#ifdef HAS_HIDDEN_CELLS
  uint around = HiddenAround(hit.Cell);
  vec4 leftX = vec4(low.xz, high.xz), rightX = vec4(low.yw, high.yw);
  vec4 leftY = vec4(low.xy, high.xy), rightY = vec4(low.zw, high.zw);
  beforeX = Beyond(beforeX, leftX, rightX, around, CELLS_X, ivec4(0, 3, 9, 12));
  behindX = Beyond(behindX, rightX, leftX, around, CELLS_X, ivec4(2, 5, 11, 14));
  beforeY = Beyond(beforeY, leftY, rightY, around, CELLS_Y, ivec4(0, 1, 9, 10));
  behindY = Beyond(behindY, rightY, leftY, around, CELLS_Y, ivec4(6, 7, 15, 16));
  beforeZ = Beyond(beforeZ, low, high, around, CELLS_Z, ivec4(0, 1, 3, 4));
  behindZ = Beyond(behindZ, high, low, around, CELLS_Z, ivec4(18, 19, 21, 22));
#endif
  // differences on the four edges in the axis' direction, at their near and their far ends; over two voxels, but at the
  // volume's border over one
  vec3 near = mix(vec3(1.0), vec3(2.0), equal(hit.Cell, ivec3(0)));
  vec3 far = mix(vec3(1.0), vec3(2.0), equal(hit.Cell + 2, volume.Samples));
  vec4 nearX = near.x * (vec4(low.yw, high.yw) - beforeX);
  vec4 farX = far.x * (behindX - vec4(low.xz, high.xz));
  vec4 nearY = near.y * (vec4(low.zw, high.zw) - beforeY);
  vec4 farY = far.y * (behindY - vec4(low.xy, high.xy));
  vec4 nearZ = near.z * (high - beforeZ);
  vec4 farZ = far.z * (behindZ - low);
  vec3 u = hit.Local;
  vec4 onX = mix(nearX, farX, u.x);
  vec4 onY = mix(nearY, farY, u.y);
  vec4 onZ = mix(nearZ, farZ, u.z);
  vec2 xz = mix(onX.xz, onX.yw, u.y);
  vec2 yz = mix(onY.xz, onY.yw, u.x);
  vec2 zy = mix(onZ.xz, onZ.yw, u.x);
  return vec3(mix(xz.x, xz.y, u.z), mix(yz.x, yz.y, u.z), mix(zy.x, zy.y, u.y));
}

// Scaled so that neither tiny nor huge gradients under- or overflow; towards the viewer where there is none.
vec3 ViewNormal(vec3 gradient, vec3 toViewer)
{
  float largest = max(abs(gradient.x), max(abs(gradient.y), abs(gradient.z)));
  if (!(largest > 0.0) || isinf(largest))
  {
    return toViewer;
  }
  return normalize(look.NormalMatrix * (gradient / largest));
}
