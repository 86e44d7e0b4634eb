// Where a pixel's ray has met the surface, for the shading stages.

struct HitPoint
{
  double T;
  ivec3 Cell; // that holds the hit
  vec3 Local; // coordinates in its unit cube
};

HitPoint HitOf(uint pixel)
{
  Ray ray = CameraRay(pixel);
  HitPoint hit;
  hit.T = HitT(ray, rayHit[pixel]);
  dvec3 p = ray.Origin + hit.T * ray.Direction;
  hit.Cell = ivec3(clamp(floor(p), dvec3(0.0LF), dvec3(scene.Samples.xyz - 2)));
  hit.Local = clamp(vec3(p - dvec3(hit.Cell)), vec3(0.0), vec3(1.0));
  return hit;
}

// A hit is shaded once, when its ray needs no further block.
bool AwaitsShading(uint pixel)
{
  return rayHit[pixel] != NO_HIT && rayBlock[pixel] == EXITED && (pixelColor[pixel] >> 24) == 0u;
}
