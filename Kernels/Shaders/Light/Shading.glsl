// Light on a surface, by Phong's model, in view coordinates. Two-sided, a light reaches the surface from either side, as
// VTK's volume mapper has it, or only the side that is seen, as VTK's meshes are lit; one-sided only from where the values
// are lower.

#ifdef COLORED
// Colours over a range of values: low, 1 / (high - low).
layout(std140, binding = PALETTE_BINDING) uniform Palette
{
  vec4 Range;
  vec4 Colors[PALETTE_SIZE];
}
palette;

vec3 PaletteColor(float value)
{
  float at = clamp((value - palette.Range.x) * palette.Range.y, 0.0, 1.0) * float(PALETTE_SIZE - 1);
  int below = min(int(at), PALETTE_SIZE - 2);
  return mix(palette.Colors[below].rgb, palette.Colors[below + 1].rgb, at - float(below));
}
#endif

#ifdef LIT
// What of a light arrives, and from where.
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

// The side of the surface that counts for a light.
vec3 Facing(vec3 normal, vec3 toLight, vec3 toViewer)
{
  vec3 there = look.LitSides == LIT_LIKE_MESHES ? toViewer : toLight;
  return look.LitSides != ONE_SIDED && dot(normal, there) > 0.0 ? normal : -normal;
}

vec3 Illuminate(vec3 position, vec3 normal, vec3 toViewer, vec3 surfaceColor)
{
  vec3 color = look.Ambient * surfaceColor;
  for (int i = 0; i < look.NumberOfLights; ++i)
  {
    vec3 toLight;
    float attenuation = Attenuation(look.Lights[i], position, toLight);
    vec3 facing = Facing(normal, toLight, toViewer);
    float cosine = dot(facing, toLight);
    if (cosine > 0.0)
    {
      float highlight = max(dot(reflect(-toLight, facing), toViewer), 0.0);
      vec3 diffuse = look.Diffuse * cosine * look.Lights[i].Diffuse * surfaceColor;
      vec3 specular = look.Specular * pow(highlight, look.SpecularPower) * look.Lights[i].Specular;
      color += attenuation * (diffuse + specular);
    }
  }
  return clamp(color, 0.0, 1.0);
}
#endif

// Colour of a surface at parameter t of a pixel's ray; unlit, the normal does not matter.
vec3 Shade(uint pixel, float t, vec3 normal, int surface)
{
#ifdef COLORED
  vec3 color = PaletteColor(ColorValueOf(pixel));
#else
  vec3 color = look.Colors[surface].Rgb;
#endif
#ifdef LIT
  vec3 direction = EyeRayDirection(pixel);
  color = Illuminate(EyeRayOrigin(pixel) + t * direction, normal, -normalize(direction), color);
#endif
  return color;
}
