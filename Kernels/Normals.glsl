// The surface's normal where a ray has met it: the trilinear interpolant of the voxels' central differences, as
// in VTK's mapper, hence continuous across cells and blocks.

struct HitPoint
{
  ivec3 Cell; // that holds the hit
  vec3 Local; // coordinates in its unit cube
};

// From the key alone, so that it is the same in whichever pass the normal is found.
HitPoint HitOf(Ray ray, uint key)
{
  dvec3 p = ray.Origin + HitT(ray, key) * ray.Direction;
  HitPoint hit;
  hit.Cell = ivec3(clamp(floor(p), dvec3(0.0LF), dvec3(scene.Samples.xyz - 2)));
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
  return min(cell + 2, scene.Samples.xyz - 1) >> 2;
}

// For the four planes of samples from one before the cell to one behind it, on each axis: do they lie in the
// further block, and what do they add to the index within it?
bvec4 furtherX, furtherY, furtherZ;
uvec4 withinX, withinY, withinZ;

void PlaceStencil(ivec3 cell)
{
  ivec4 planes = ivec4(-1, 0, 1, 2);
  ivec3 last = scene.Samples.xyz - 1;
  ivec3 first = FirstStencilBlock(cell);
  ivec4 x = clamp(cell.x + planes, ivec4(0), ivec4(last.x));
  ivec4 y = clamp(cell.y + planes, ivec4(0), ivec4(last.y));
  ivec4 z = clamp(cell.z + planes, ivec4(0), ivec4(last.z));
  furtherX = notEqual(x >> 2, ivec4(first.x));
  furtherY = notEqual(y >> 2, ivec4(first.y));
  furtherZ = notEqual(z >> 2, ivec4(first.z));
  withinX = uvec4(x & 3);
  withinY = uvec4(y & 3) * 4u;
  withinZ = uvec4(z & 3) * 16u;
}

// Sample on planes (i, j, k), 0 … 3 each; the cell's own are 1 and 2.
float Sample(int i, int j, int k)
{
  uint slot = SlotAt(bvec3(furtherX[i], furtherY[j], furtherZ[k]));
  return uintBitsToFloat(cacheValues[slot * 64u + withinX[i] + withinY[j] + withinZ[k]]);
}

// Central differences at the cell's corners, interpolated.
vec3 Gradient(HitPoint hit)
{
  PlaceStencil(hit.Cell);
  float corners[8];
  for (int n = 0; n < 8; ++n)
  {
    corners[n] = Sample(1 + (n & 1), 1 + ((n >> 1) & 1), 1 + (n >> 2));
  }
  vec3 gradient = vec3(0.0);
  for (int n = 0; n < 8; ++n)
  {
    ivec3 side = SideOffset(n);
    ivec3 own = 1 + side;
    ivec3 outer = 3 * side;
    vec3 beyond =
      vec3(Sample(outer.x, own.y, own.z), Sample(own.x, outer.y, own.z), Sample(own.x, own.y, outer.z));
    vec3 across = vec3(corners[n ^ 1], corners[n ^ 2], corners[n ^ 4]);
    vec3 difference = (beyond - across) * vec3(2 * side - 1);
    vec3 weight = mix(1.0 - hit.Local, hit.Local, vec3(side));
    gradient += weight.x * weight.y * weight.z * difference;
  }
  return gradient;
}

// Scaled so that neither tiny nor huge gradients under- or overflow; towards the viewer where there is none.
vec3 ViewNormal(vec3 gradient, vec3 toViewer)
{
  float largest = max(abs(gradient.x), max(abs(gradient.y), abs(gradient.z)));
  if (!(largest > 0.0) || isinf(largest))
  {
    return toViewer;
  }
  return normalize(mat3(scene.NormalMatrix) * (gradient / largest));
}
