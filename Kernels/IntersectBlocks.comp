// Ray tracing the visible blocks (section 3.7): a work group loads the 5^3 values of a block's dual grid
// and walks its rays through the cells; the nearest hit of a ray is kept by an atomic minimum on its key.
// In: CacheWorkItems, GroupedRays, CacheMap, CacheValues. Out: RayHit.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"
#include "BlockMap.glsl"
#include "Intersection.glsl"

layout(local_size_x = 64) in;

#define DUAL_GRID 125u

shared uint cornerSlots[8];     // of the block and its + neighbours
shared float dualGrid[DUAL_GRID]; // value - isovalue
shared uint activeCells[2];     // cells whose corners lie on both sides, a bit each

void LoadDualGrid(ivec3 block)
{
  uint lane = gl_LocalInvocationIndex;
  if (lane < 8u)
  {
    ivec3 other = block + ivec3(lane & 1u, (lane >> 1) & 1u, lane >> 2);
    uint entry = InGrid(other) ? FindEntry(BlockIndex(other)) : NONE;
    cornerSlots[lane] = entry == NONE ? NONE : cacheMap[entry].Slot;
  }
  if (lane < 2u)
  {
    activeCells[lane] = 0u;
  }
  barrier();
  for (uint i = lane; i < DUAL_GRID; i += 64u)
  {
    uvec3 voxel = uvec3(i % 5u, (i / 5u) % 5u, i / 25u);
    uvec3 beyond = voxel >> 2;
    uint slot = cornerSlots[beyond.x + 2u * beyond.y + 4u * beyond.z];
    uvec3 local = voxel & 3u;
    // beyond the volume's last sample there are no cells, so the value does not matter
    uint bits = slot == NONE ? 0u : cacheValues[slot * 64u + local.x + 4u * local.y + 16u * local.z];
    precise float value = (uintBitsToFloat(bits) - scene.Isovalue.x) - scene.Isovalue.y;
    dualGrid[i] = value;
  }
  barrier();
}

void LoadCorners(uint first, out float w[8])
{
  for (uint i = 0u; i < 8u; ++i)
  {
    w[i] = dualGrid[first + (i & 1u) + 5u * ((i >> 1) & 1u) + 25u * (i >> 2)];
  }
}

// One lane a cell: is it crossed by the surface?
void FindActiveCells()
{
  uint lane = gl_LocalInvocationIndex;
  float w[8];
  LoadCorners((lane & 3u) + 5u * ((lane >> 2) & 3u) + 25u * (lane >> 4), w);
  bool someInside = false;
  bool allInside = true;
  for (int i = 0; i < 8; ++i)
  {
    someInside = someInside || Inside(w[i]);
    allInside = allInside && Inside(w[i]);
  }
  if (someInside && !allInside)
  {
    atomicOr(activeCells[lane >> 5], 1u << (lane & 31u));
  }
  barrier();
}

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
bool IntersectCell(Ray ray, ivec3 cell, uint corner, double t0, double t1, dvec3 exits, out double t)
{
  float w[8];
  LoadCorners(corner, w);
  bvec3 entering = equal(PlanesT(ray, EntryPlanes(ray, cell, 1)), dvec3(t0));
  bvec3 leaving = equal(exits, dvec3(t1));
  vec3 u0 = LocalCoordinates(ray, cell, t0, entering, false);
  vec3 u1 = LocalCoordinates(ray, cell, t1, leaving, true);
  float s = FirstTransition(CubicAlong(w, u0, u1));
  t = t0 + double(s) * (t1 - t0);
  return s >= 0.0;
}

bool Active(uvec3 local)
{
  uint bit = local.x + 4u * local.y + 16u * local.z;
  return (activeCells[bit >> 5] & (1u << (bit & 31u))) != 0u;
}

// First hit of the ray in the block; false if there is none. The walk to the next active cell is a loop
// of its own, so that the lanes of a group meet again for the costly part.
bool IntersectBlock(Ray ray, ivec3 block, double t0, out double t)
{
  double end = BlockExit(ray, block);
  ivec3 cell = CellAt(ray, block, t0);
  for (int tested = 0; tested < 16; ++tested) // a ray crosses at most 10 cells of 4^3
  {
    dvec3 exits = PlanesT(ray, ExitPlanes(ray, cell, 1));
    double t1 = min(SmallestOf(exits), end);
    for (int passed = 0; passed < 16 && t1 < end && !Active(uvec3(cell) & 3u); ++passed)
    {
      cell += ivec3(lessThanEqual(exits, dvec3(t1))) * ray.Step;
      t0 = t1;
      exits = PlanesT(ray, ExitPlanes(ray, cell, 1));
      t1 = min(SmallestOf(exits), end);
    }
    uvec3 local = uvec3(cell) & 3u;
    if (!Active(local))
    {
      return false;
    }
    if (IntersectCell(ray, cell, local.x + 5u * local.y + 25u * local.z, t0, t1, exits, t))
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

void main()
{
  for (uint item = gl_WorkGroupID.x; item < control.WorkItems; item += gl_NumWorkGroups.x)
  {
    WorkItem work = cacheWorkItems[item];
    ivec3 block = BlockCoordinates(work.Block);
    LoadDualGrid(block);
    FindActiveCells();
    if ((activeCells[0] | activeCells[1]) != 0u)
    {
      for (uint i = gl_LocalInvocationIndex; i < work.RayCount; i += 64u)
      {
        TraceRay(groupedRays[work.FirstRay + i], block);
      }
    }
    barrier();
  }
}
