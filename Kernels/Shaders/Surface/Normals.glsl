// The surface's normal at a hit: the trilinear interpolant of the voxels' central differences, as
// in VTK's mapper, hence continuous across cells and blocks; one-sided at the volume's border, as
// in VTK's meshes. Also the value of the volume that gives the colours.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Cache/SlotLayout.glsl"
#include "Rays/Rays.glsl"
#include "Store/HiddenCells.glsl"
#include BLOCK_ACCESS

struct SurfacePoint
{
  ivec3 Cell; // that holds the hit
  vec3 Local; // coordinates in its unit cube
};

// In this level, from the key alone, so that it is the same in whichever pass the normal is found.
SurfacePoint PointOf(RayLine line, uint key)
{
  Wide3 place = PlaceAt(line, HitT(key));
  SurfacePoint hit;
#ifdef LEVELS
  ivec3 side = ivec3(1) << Halvings(); // of a cell
  hit.Cell = clamp(HighOf(place) >> Halvings(), ivec3(0), LEVEL_GRID.Samples - 2);
  vec3 sinceCorner = vec3(HighOf(place) - hit.Cell * side) + vec3(LowOf(place)) * (1.0 / TWO_TO_32);
  hit.Local = clamp(sinceCorner / vec3(side), 0.0, 1.0);
#else
  hit.Cell = clamp(HighOf(place), ivec3(0), volume.Samples - 2);
  hit.Local = PlaceInCell(place, hit.Cell);
#endif
  return hit;
}

// The samples that central differences at a cell's corners need: from one before the cell to one
// behind it, inside the volume.
ivec3 FirstStencilSample(ivec3 cell)
{
  return max(cell - 1, ivec3(0));
}

ivec3 LastStencilSample(ivec3 cell)
{
  return min(cell + 2, LEVEL_GRID.Samples - 1);
}

Stencil StencilOf(ivec3 cell)
{
  return PlaceStencil(FirstStencilSample(cell), cell, LastStencilSample(cell));
}

// An eighth of a sample of the stencil `at`, so that no difference overflows. Of its planes x, y, z
// and w on an axis y and z are the cell's own.
#define SAMPLE(i, j, k) (0.125 * uintBitsToFloat(cacheValues[STENCIL_INDEX(at, i, j, k)]))

#ifdef COLORED
#define COLOR_SAMPLE(i, j, k)                                                                      \
  uintBitsToFloat(cacheValues[uint(SAMPLES_PER_BLOCK) * ColorSlot(0u) + STENCIL_INDEX(at, i, j, k)])

#define NO_VALUE uintBitsToFloat(0x7F800000u) // infinity

#ifdef CATEGORIES
// The value of the nearest sample that gives the colours: between two categories there is none.
float ColorValue(SurfacePoint hit)
{
  Stencil at = StencilOf(hit.Cell);
  bvec3 far = greaterThanEqual(hit.Local, vec3(0.5));
  vec4 low = vec4(COLOR_SAMPLE(y, y, y), COLOR_SAMPLE(z, y, y), COLOR_SAMPLE(y, z, y),
    COLOR_SAMPLE(z, z, y));
  vec4 high = vec4(COLOR_SAMPLE(y, y, z), COLOR_SAMPLE(z, y, z), COLOR_SAMPLE(y, z, z),
    COLOR_SAMPLE(z, z, z));
  vec4 face = far.z ? high : low;
  vec2 edge = far.y ? face.zw : face.xy;
  float value = far.x ? edge.y : edge.x;
  return isnan(value) ? NO_VALUE : value;
}
#else
// The trilinear interpolant of the volume that gives the colours; of samples that are hidden there,
// which are NaN, it has no value.
float ColorValue(SurfacePoint hit)
{
  Stencil at = StencilOf(hit.Cell);
  vec4 low = vec4(COLOR_SAMPLE(y, y, y), COLOR_SAMPLE(z, y, y), COLOR_SAMPLE(y, z, y),
    COLOR_SAMPLE(z, z, y));
  vec4 high = vec4(COLOR_SAMPLE(y, y, z), COLOR_SAMPLE(z, y, z), COLOR_SAMPLE(y, z, z),
    COLOR_SAMPLE(z, z, z));
  vec4 face = mix(low, high, hit.Local.z);
  vec2 edge = mix(face.xy, face.zw, hit.Local.y);
  float value = mix(edge.x, edge.y, hit.Local.x);
  return isnan(value) ? NO_VALUE : value;
}
#endif
#endif

#ifdef HAS_HIDDEN_CELLS
// Which of the 27 cells around a cell, itself the middle one, x fastest, are hidden. Beyond the
// volume its last cells count.
uint HiddenAround(ivec3 cell)
{
  ivec3 first = BlockOf(FirstStencilSample(cell));
  uint around = 0u;
  for (int i = 0; i < 27; ++i)
  {
    ivec3 other = cell + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    other = clamp(other, ivec3(0), LEVEL_GRID.Samples - 2);
    around |= HoldsCell(HiddenInSlot(FoundSlot(first, BlockOf(other))), other) ? 1u << i : 0u;
  }
  return around;
}

// Are all four cells around an edge of the grid hidden? Their bits are `cells`, moved by `place`.
bool HasHiddenCellsOnly(uint around, uint cells, int place)
{
  return (around >> place & cells) == cells;
}

#define CELLS_X (1u | 1u << 3 | 1u << 9 | 1u << 12) // around an edge along x, y, z
#define CELLS_Y (1u | 1u << 1 | 1u << 9 | 1u << 10)
#define CELLS_Z (1u | 1u << 1 | 1u << 3 | 1u << 4)

// The samples beyond four corners of the cell, each at the end of an edge. Samples of hidden cells
// alone have no values that count: they are extrapolated from the corners and those opposite.
vec4 Beyond(vec4 samples, vec4 corners, vec4 opposite, uint around, uint cells, ivec4 places)
{
  bvec4 hidden = bvec4(
    HasHiddenCellsOnly(around, cells, places.x), HasHiddenCellsOnly(around, cells, places.y),
    HasHiddenCellsOnly(around, cells, places.z), HasHiddenCellsOnly(around, cells, places.w));
  return mix(samples, 2.0 * corners - opposite, hidden);
}
#endif

// Differences along an axis on the cell's four edges in its direction, at place u of each: between
// the samples before, at either end of, and behind the edge. They span two voxels, at the volume's
// border one, as the factors tell.
vec4 DifferencesAt(
  float u, vec4 before, vec4 left, vec4 right, vec4 behind, float nearFactor, float farFactor)
{
  return mix(nearFactor * (right - before), farFactor * (behind - left), u);
}

// The gradient at the hit: central differences at the cell's corners, interpolated.
vec3 Gradient(SurfacePoint hit)
{
  Stencil at = StencilOf(hit.Cell);
  // at the corners, x fastest
  vec4 low = vec4(SAMPLE(y, y, y), SAMPLE(z, y, y), SAMPLE(y, z, y), SAMPLE(z, z, y));
  vec4 high = vec4(SAMPLE(y, y, z), SAMPLE(z, y, z), SAMPLE(y, z, z), SAMPLE(z, z, z));
  vec4 leftX = vec4(low.xz, high.xz), rightX = vec4(low.yw, high.yw);
  vec4 leftY = vec4(low.xy, high.xy), rightY = vec4(low.zw, high.zw);
  // beyond the corners, in the order of the edges that lead there
  vec4 beforeX = vec4(SAMPLE(x, y, y), SAMPLE(x, z, y), SAMPLE(x, y, z), SAMPLE(x, z, z));
  vec4 behindX = vec4(SAMPLE(w, y, y), SAMPLE(w, z, y), SAMPLE(w, y, z), SAMPLE(w, z, z));
  vec4 beforeY = vec4(SAMPLE(y, x, y), SAMPLE(z, x, y), SAMPLE(y, x, z), SAMPLE(z, x, z));
  vec4 behindY = vec4(SAMPLE(y, w, y), SAMPLE(z, w, y), SAMPLE(y, w, z), SAMPLE(z, w, z));
  vec4 beforeZ = vec4(SAMPLE(y, y, x), SAMPLE(z, y, x), SAMPLE(y, z, x), SAMPLE(z, z, x));
  vec4 behindZ = vec4(SAMPLE(y, y, w), SAMPLE(z, y, w), SAMPLE(y, z, w), SAMPLE(z, z, w));
#ifdef HAS_HIDDEN_CELLS
  uint around = HiddenAround(hit.Cell);
  beforeX = Beyond(beforeX, leftX, rightX, around, CELLS_X, ivec4(0, 3, 9, 12));
  behindX = Beyond(behindX, rightX, leftX, around, CELLS_X, ivec4(2, 5, 11, 14));
  beforeY = Beyond(beforeY, leftY, rightY, around, CELLS_Y, ivec4(0, 1, 9, 10));
  behindY = Beyond(behindY, rightY, leftY, around, CELLS_Y, ivec4(6, 7, 15, 16));
  beforeZ = Beyond(beforeZ, low, high, around, CELLS_Z, ivec4(0, 1, 3, 4));
  behindZ = Beyond(behindZ, high, low, around, CELLS_Z, ivec4(18, 19, 21, 22));
#endif
  vec3 near = mix(vec3(1.0), vec3(2.0), equal(hit.Cell, ivec3(0)));
  vec3 far = mix(vec3(1.0), vec3(2.0), equal(hit.Cell + 2, LEVEL_GRID.Samples));
  vec3 u = hit.Local;
  vec4 onX = DifferencesAt(u.x, beforeX, leftX, rightX, behindX, near.x, far.x);
  vec4 onY = DifferencesAt(u.y, beforeY, leftY, rightY, behindY, near.y, far.y);
  vec4 onZ = DifferencesAt(u.z, beforeZ, low, high, behindZ, near.z, far.z);
  vec2 xz = mix(onX.xz, onX.yw, u.y);
  vec2 yz = mix(onY.xz, onY.yw, u.x);
  vec2 zy = mix(onZ.xz, onZ.yw, u.x);
  vec3 gradient = vec3(mix(xz.x, xz.y, u.z), mix(yz.x, yz.y, u.z), mix(zy.x, zy.y, u.y));
#ifdef LEVELS
  gradient /= vec3(ivec3(1) << Halvings());
#endif
  return gradient;
}

// Scales first, so that neither tiny nor huge gradients under- or overflow. Towards the viewer if
// there is no gradient.
vec3 ViewNormal(vec3 gradient, vec3 toViewer)
{
  float largest = max(abs(gradient.x), max(abs(gradient.y), abs(gradient.z)));
  if (!(largest > 0.0) || isinf(largest))
  {
    return toViewer;
  }
  return normalize(look.NormalMatrix * (gradient / largest));
}
