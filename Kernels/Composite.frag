// The partial or complete image goes to the window, lit, with the depth that opaque geometry is tested against.
// In: Hits, Depths, Normals.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#ifdef HAS_NORMALS
#include "PackedNormal.glsl"
#endif

layout(location = 0) out vec4 fragmentColor;

#ifdef HAS_NORMALS
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
#endif

vec3 Shade(uint pixel, float t)
{
#ifdef HAS_NORMALS
  vec3 direction = EyeRayDirection(pixel);
  vec3 toViewer = -normalize(direction);
  vec3 normal = UnpackNormal(normals[pixel]);
  normal = dot(normal, toViewer) < 0.0 ? -normal : normal;
  return Illuminate(EyeRayOrigin(pixel) + t * direction, normal, toViewer);
#else
  return scene.Color.rgb;
#endif
}

// A hit shows as soon as it can be lit.
bool Shows(uint pixel)
{
#ifdef HAS_NORMALS
  return normals[pixel] != NO_NORMAL;
#else
  return hits[pixel] != NO_HIT;
#endif
}

void main()
{
  ivec2 xy = ivec2(gl_FragCoord.xy) - scene.Image.zw;
  uint pixel = uint(xy.y * scene.Image.x + xy.x);
  if (!Shows(pixel))
  {
    discard;
  }
  float t = depths[pixel];
  float z = (scene.DepthTerms.x + t * scene.DepthTerms.y) / (scene.DepthTerms.z + t * scene.DepthTerms.w);
  gl_FragDepth = clamp(0.5 * z + 0.5, 0.0, 1.0);
  fragmentColor = vec4(clamp(Shade(pixel, t), 0.0, 1.0), 1.0);
}
