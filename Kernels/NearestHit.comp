// Nearest hit and the rays that go on (sections 3.7 and 4.4): the intersection stage has kept the
// nearest hit's key; a ray is done when it has one and nothing nearer was deferred, or when it has left
// the volume.
// In: LiveRays, RayHit, PairBlock, PairEntry. Out: RayBlock, NextLiveRays.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"

layout(local_size_x = 64) in;

shared uint groupCount;
shared uint groupFirst;

// First block of the ray that was not intersected in this pass for want of cache; NONE if all were.
uint FirstDeferred(uint index)
{
  if (control.DeferredBlocks == 0u)
  {
    return NONE;
  }
  uint first = index * control.Speculation;
  for (uint i = first; i < first + control.Speculation && pairBlock[i] != NONE; ++i)
  {
    if (pairEntry[i] == NONE)
    {
      return pairBlock[i];
    }
  }
  return NONE;
}

// A nearer hit than the one it has could only come from a block that the ray enters before it.
bool BeforeHit(uint pixel, uint block)
{
  uint hit = rayHit[pixel];
  if (hit == NO_HIT)
  {
    return true;
  }
  Ray ray = CameraRay(pixel);
  return HitKey(ray, BlockEntry(ray, BlockCoordinates(block))) < hit;
}

bool GoesOn(uint index, uint pixel)
{
  uint deferred = FirstDeferred(index);
  uint next = deferred != NONE ? deferred : rayBlock[pixel];
  bool goesOn = next != EXITED && BeforeHit(pixel, next);
  rayBlock[pixel] = goesOn ? next : EXITED;
  return goesOn;
}

void main()
{
  uint stride = gl_NumWorkGroups.x * 64u;
  for (uint first = gl_WorkGroupID.x * 64u; first < control.LiveRays; first += stride)
  {
    if (gl_LocalInvocationIndex == 0u)
    {
      groupCount = 0u;
    }
    barrier();
    uint index = first + gl_LocalInvocationIndex;
    uint pixel = index < control.LiveRays ? liveRays[index] : 0u;
    bool live = index < control.LiveRays && GoesOn(index, pixel);
    uint at = live ? atomicAdd(groupCount, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationIndex == 0u)
    {
      groupFirst = atomicAdd(control.NextLiveRays, groupCount);
    }
    barrier();
    if (live)
    {
      nextLiveRays[groupFirst + at] = pixel;
    }
  }
}
