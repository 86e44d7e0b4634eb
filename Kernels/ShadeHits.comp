// Shading, once a pixel: the normal is the trilinear interpolant of the voxels' central differences, as in
// VTK's mapper, hence continuous across cells and blocks.
// In: RayHit, RayBlock, PairEntry, CacheMap, CacheValues. Out: PixelColor.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "Hits.glsl"

layout(local_size_x = 64) in;

// Where the samples around a cell are: for the four planes of samples from one before the cell to one
// behind it, on each axis, what they add to the index of the block (of the eight below) and within it.
uint blockSlots[8];
uvec4 blockX, blockY, blockZ;
uvec4 withinX, withinY, withinZ;

void FindSamples(ivec3 cell)
{
  ivec4 planes = ivec4(-1, 0, 1, 2);
  ivec3 last = scene.Samples.xyz - 1;
  ivec4 x = clamp(cell.x + planes, ivec4(0), ivec4(last.x));
  ivec4 y = clamp(cell.y + planes, ivec4(0), ivec4(last.y));
  ivec4 z = clamp(cell.z + planes, ivec4(0), ivec4(last.z));
  ivec3 low = ivec3(x.x, y.x, z.x) >> 2;
  ivec3 high = ivec3(x.w, y.w, z.w) >> 2;
  blockX = uvec4((x >> 2) - low.x);
  blockY = uvec4((y >> 2) - low.y) * 2u;
  blockZ = uvec4((z >> 2) - low.z) * 4u;
  withinX = uvec4(x & 3);
  withinY = uvec4(y & 3) * 4u;
  withinZ = uvec4(z & 3) * 16u;
  for (int i = 0; i < 8; ++i)
  {
    ivec3 block = min(low + (ivec3(i) >> ivec3(0, 1, 2) & 1), high);
    uint entry = FindEntry(BlockIndex(block));
    blockSlots[i] = entry == NONE ? 0u : cacheMap[entry].Slot;
  }
}

// Sample on planes (i, j, k), 0 … 3 each; the cell's own are 1 and 2.
float Sample(int i, int j, int k)
{
  uint slot = blockSlots[blockX[i] + blockY[j] + blockZ[k]];
  return uintBitsToFloat(cacheValues[slot * 64u + withinX[i] + withinY[j] + withinZ[k]]);
}

// Central differences at the cell's corners, interpolated.
vec3 Gradient(HitPoint hit)
{
  FindSamples(hit.Cell);
  float corners[8];
  for (int n = 0; n < 8; ++n)
  {
    corners[n] = Sample(1 + (n & 1), 1 + ((n >> 1) & 1), 1 + (n >> 2));
  }
  vec3 gradient = vec3(0.0);
  for (int n = 0; n < 8; ++n)
  {
    ivec3 side = ivec3(n) >> ivec3(0, 1, 2) & 1;
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
  vec3 normal = normalize(mat3(scene.NormalMatrix) * (gradient / largest));
  return dot(normal, toViewer) < 0.0 ? -normal : normal;
}

vec3 Illuminate(vec3 position, vec3 normal, vec3 toViewer)
{
  vec3 color = scene.Material.x * scene.Color.rgb;
  for (int i = 0; i < scene.Lighting.x; ++i)
  {
    vec4 place = scene.Lights[i].Place;
    vec3 toLight = normalize(place.w == 0.0 ? place.xyz : place.xyz - position);
    float cosine = dot(normal, toLight);
    if (cosine > 0.0)
    {
      vec3 light = scene.Lights[i].Color.rgb;
      float highlight = max(dot(reflect(-toLight, normal), toViewer), 0.0);
      color += light * scene.Material.y * cosine * scene.Color.rgb;
      color += light * scene.Material.z * pow(highlight, scene.Material.w);
    }
  }
  return color;
}

vec3 Shade(uint pixel)
{
  if (scene.Lighting.x == 0)
  {
    return scene.Color.rgb;
  }
  HitPoint hit = HitOf(pixel);
  double x = double(pixel % uint(scene.Image.x)) + 0.5LF;
  double y = double(pixel / uint(scene.Image.x)) + 0.5LF;
  vec3 origin = vec3(scene.EyeOrigin[0].xyz + x * scene.EyeOrigin[1].xyz + y * scene.EyeOrigin[2].xyz);
  vec3 direction =
    vec3(scene.EyeDirection[0].xyz + x * scene.EyeDirection[1].xyz + y * scene.EyeDirection[2].xyz);
  vec3 toViewer = -normalize(direction);
  vec3 normal = ViewNormal(Gradient(hit), toViewer);
  return Illuminate(origin + float(hit.T) * direction, normal, toViewer);
}

void main()
{
  uint pixels = uint(scene.Image.x * scene.Image.y);
  uint stride = gl_NumWorkGroups.x * 64u;
  for (uint pixel = gl_GlobalInvocationID.x; pixel < pixels; pixel += stride)
  {
    if (!AwaitsShading(pixel))
    {
      continue;
    }
    uint entry = scene.Lighting.x == 0 ? 0u : pairEntry[pixel];
    if (entry == NONE || (scene.Lighting.x > 0 && cacheMap[entry].Offset == NONE))
    {
      atomicAdd(control.UnshadedHits, 1u); // the cache had no room: another round follows
      continue;
    }
    pixelColor[pixel] = packUnorm4x8(vec4(clamp(Shade(pixel), 0.0, 1.0), 1.0));
  }
}
