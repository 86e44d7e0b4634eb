// Lights a surface by Phong's model, in view coordinates.

#include "Shared/Scene.glsl"
#include "Rays/Rays.glsl"
#include "Surface/Hits.glsl"

#ifdef COLORED
#include "Light/ValueColors.glsl"
#endif

#ifdef LIT
// The part of a light that arrives at a position, and the direction that it comes from.
float Attenuation(Light light, vec3 position, out vec3 toLight)
{
  if (light.IsPositional == 0)
  {
    toLight = light.Position;
    return 1.0;
  }
  vec3 way = light.Position - position;
  float distance = length(way);
  toLight = way / distance;
  vec3 fading =
    vec3(light.ConstantAttenuation, light.LinearAttenuation, light.QuadraticAttenuation);
  float attenuation = 1.0 / dot(fading, vec3(1.0, distance, distance * distance));
  if (light.IsSpot != 0)
  {
    float cosine = dot(-toLight, light.ConeAxis);
    attenuation *= cosine >= light.ConeCosine ? pow(cosine, light.ConeExponent) : 0.0;
  }
  return attenuation;
}

// The normal of the side that a light reaches.
vec3 FacingNormal(vec3 normal, vec3 toLight, vec3 toViewer)
{
  vec3 seenFrom = look.LitSides == LIT_LIKE_MESHES ? toViewer : toLight;
  return look.LitSides != ONE_SIDED && dot(normal, seenFrom) > 0.0 ? normal : -normal;
}

vec3 Illuminate(vec3 position, vec3 normal, vec3 toViewer, vec3 surfaceColor)
{
  vec3 color = look.Ambient * surfaceColor;
  for (int i = 0; i < look.NumberOfLights; ++i)
  {
    vec3 toLight;
    float attenuation = Attenuation(look.Lights[i], position, toLight);
    vec3 facing = FacingNormal(normal, toLight, toViewer);
    float cosine = dot(facing, toLight);
    if (cosine > 0.0)
    {
      float highlight = max(dot(reflect(-toLight, facing), toViewer), 0.0);
      vec3 diffuse = look.Diffuse * cosine * look.Lights[i].Diffuse * surfaceColor;
      vec3 specular =
        look.Specular * pow(highlight, look.SpecularPower) * look.Lights[i].Specular;
      color += attenuation * (diffuse + specular);
    }
  }
  return clamp(color, 0.0, 1.0);
}
#endif

// Colour and opacity of a hit at parameter t of a pixel's ray; where nothing is lit the normal does
// not count.
vec4 Shade(uint pixel, float t, vec3 normal, int isovalue)
{
#ifdef COLORED
  vec4 color = ColorOfValue(ColorValueOf(pixel));
  color.w *= look.Colors[isovalue].Opacity;
#else
  vec4 color = vec4(look.Colors[isovalue].Rgb, look.Colors[isovalue].Opacity);
#endif
#ifdef LIT
  vec3 direction = EyeRayDirection(pixel);
  vec3 position = EyeRayOrigin(pixel) + t * direction;
  color.xyz = Illuminate(position, normal, -normalize(direction), color.xyz);
#endif
  return color;
}
