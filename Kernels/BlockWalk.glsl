// The walk of a ray through the cells of one block (section 3.7), after Amanatides and Woo. Where the
// cells' corner values come from is the business of the stage that includes this.

// Does the surface cross the cell, i.e. are its corners on both sides? `local`: its place in the block.
bool CellCrossed(uvec3 local);

// Value - isovalue at the cell's corners, x fastest.
void LoadCorners(uvec3 local, out float w[8]);

// Cell of the block in which the ray is at parameter t: every plane with a smaller or equal one is crossed.
ivec3 CellAt(Ray ray, ivec3 block, double t)
{
  ivec3 entry = EntryPlanes(ray, block, 4);
  ivec3 crossed = ivec3(0);
  for (int i = 1; i < 4; ++i)
  {
    crossed += ivec3(lessThanEqual(PlanesT(ray, entry + i * ray.Step), dvec3(t)));
  }
  return entry - (1 - ray.Step) / 2 + crossed * ray.Step;
}

// Coordinates in the cell's unit cube at parameter t; exact on the faces that the ray is crossing.
vec3 LocalCoordinates(Ray ray, ivec3 cell, double t, bvec3 onFace, bool leaving)
{
  precise dvec3 p = ray.Origin + t * ray.Direction - dvec3(cell);
  vec3 u = clamp(vec3(p), vec3(0.0), vec3(1.0));
  vec3 face = vec3((leaving ? 1 + ray.Step : 1 - ray.Step) / 2);
  return mix(u, face, onFace);
}

// First hit of the ray in the cell between parameters t0 and t1; false if there is none.
bool IntersectCell(Ray ray, ivec3 cell, double t0, double t1, dvec3 exits, out double t)
{
  float w[8];
  LoadCorners(uvec3(cell) & 3u, w);
  bvec3 entering = equal(PlanesT(ray, EntryPlanes(ray, cell, 1)), dvec3(t0));
  bvec3 leaving = equal(exits, dvec3(t1));
  vec3 u0 = LocalCoordinates(ray, cell, t0, entering, false);
  vec3 u1 = LocalCoordinates(ray, cell, t1, leaving, true);
  float s = FirstTransition(CubicAlong(w, u0, u1));
  precise double hit = t0 + double(s) * (t1 - t0);
  t = hit;
  return s >= 0.0;
}

// First hit of the ray in the block; false if there is none. The walk to the next crossed cell is a loop
// of its own, so that the lanes of a group meet again for the costly part.
bool IntersectBlock(Ray ray, ivec3 block, double t0, out double t)
{
  double end = BlockExit(ray, block);
  ivec3 cell = CellAt(ray, block, t0);
  for (int tested = 0; tested < 16; ++tested) // a ray crosses at most 10 cells of 4^3
  {
    dvec3 exits = PlanesT(ray, ExitPlanes(ray, cell, 1));
    double t1 = min(SmallestOf(exits), end);
    for (int passed = 0; passed < 16 && t1 < end && !CellCrossed(uvec3(cell) & 3u); ++passed)
    {
      cell += ivec3(lessThanEqual(exits, dvec3(t1))) * ray.Step;
      t0 = t1;
      exits = PlanesT(ray, ExitPlanes(ray, cell, 1));
      t1 = min(SmallestOf(exits), end);
    }
    if (!CellCrossed(uvec3(cell) & 3u))
    {
      return false;
    }
    if (IntersectCell(ray, cell, t0, t1, exits, t))
    {
      return true;
    }
    if (t1 >= end)
    {
      return false;
    }
    cell += ivec3(lessThanEqual(exits, dvec3(t1))) * ray.Step;
    t0 = t1;
  }
  return false;
}

void TraceRay(uint pixel, ivec3 block)
{
  Ray ray = CameraRay(pixel);
  double entry = BlockEntry(ray, block);
  double t;
  if (rayHit[pixel] >= HitKey(ray, entry) && IntersectBlock(ray, block, entry, t))
  {
    atomicMin(rayHit[pixel], HitKey(ray, t));
  }
}
