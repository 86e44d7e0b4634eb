// Packs unit vectors into 2 x 16 bits: places on an octahedron that is unfolded to a square
// (Cigolle et al. 2014). They are off by at most 6.5e-5.

vec2 SignNotZero(vec2 v)
{
  return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
}

uint PackNormal(vec3 n)
{
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  return packSnorm2x16(n.z < 0.0 ? (1.0 - abs(p.yx)) * SignNotZero(p) : p);
}

vec3 UnpackNormal(uint bits)
{
  vec2 p = unpackSnorm2x16(bits);
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  n.xy = n.z < 0.0 ? (1.0 - abs(n.yx)) * SignNotZero(n.xy) : n.xy;
  return normalize(n);
}
