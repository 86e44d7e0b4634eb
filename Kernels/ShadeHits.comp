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

// The up to eight blocks around the hit: lowest one, and the slots.
struct Neighbourhood
{
  ivec3 Low;
  uint Slots[8];
};

Neighbourhood FindNeighbourhood(ivec3 cell)
{
  Neighbourhood around;
  around.Low = max(cell - 1, ivec3(0)) >> 2;
  for (uint i = 0u; i < 8u; ++i)
  {
    ivec3 block = min(around.Low + ivec3(i & 1u, (i >> 1) & 1u, i >> 2), (min(cell + 2, scene.Samples.xyz - 1)) >> 2);
    uint entry = FindEntry(BlockIndex(block));
    around.Slots[i] = entry == NONE ? NONE : cacheMap[entry].Slot;
  }
  return around;
}

float Value(Neighbourhood around, ivec3 voxel)
{
  ivec3 v = clamp(voxel, ivec3(0), scene.Samples.xyz - 1);
  ivec3 offset = (v >> 2) - around.Low;
  uint slot = around.Slots[offset.x + 2 * offset.y + 4 * offset.z];
  ivec3 local = v & 3;
  return uintBitsToFloat(cacheValues[slot * 64u + uint(local.x + 4 * local.y + 16 * local.z)]);
}

// Value of the interpolant at the hit, moved by a whole number of voxels.
float Interpolate(Neighbourhood around, ivec3 cell, vec3 u)
{
  vec4 x = vec4(mix(Value(around, cell), Value(around, cell + ivec3(1, 0, 0)), u.x),
    mix(Value(around, cell + ivec3(0, 1, 0)), Value(around, cell + ivec3(1, 1, 0)), u.x),
    mix(Value(around, cell + ivec3(0, 0, 1)), Value(around, cell + ivec3(1, 0, 1)), u.x),
    mix(Value(around, cell + ivec3(0, 1, 1)), Value(around, cell + ivec3(1, 1, 1)), u.x));
  vec2 y = mix(x.xz, x.yw, u.y);
  return mix(y.x, y.y, u.z);
}

vec3 Gradient(Neighbourhood around, HitPoint hit)
{
  vec3 gradient;
  for (int axis = 0; axis < 3; ++axis)
  {
    ivec3 step = ivec3(equal(ivec3(axis), ivec3(0, 1, 2)));
    gradient[axis] =
      Interpolate(around, hit.Cell + step, hit.Local) - Interpolate(around, hit.Cell - step, hit.Local);
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
  vec2 xy = vec2(float(pixel % uint(scene.Image.x)) + 0.5, float(pixel / uint(scene.Image.x)) + 0.5);
  vec3 origin = scene.EyeOrigin[0].xyz + xy.x * scene.EyeOrigin[1].xyz + xy.y * scene.EyeOrigin[2].xyz;
  vec3 direction =
    scene.EyeDirection[0].xyz + xy.x * scene.EyeDirection[1].xyz + xy.y * scene.EyeDirection[2].xyz;
  vec3 toViewer = -normalize(direction);
  vec3 normal = ViewNormal(Gradient(FindNeighbourhood(hit.Cell), hit), toViewer);
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
