// Initial rays (section 3.2): every pixel's state is reset; those whose ray meets the volume go live.
// In: scene. Out: RayBlock, RayHit, PixelColor, NextLiveRays.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "Rays.glsl"
#include "Grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

shared uint groupCount;
shared uint groupFirst;

void main()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupCount = 0u;
  }
  barrier();
  ivec2 xy = ivec2(gl_GlobalInvocationID.xy);
  uint pixel = uint(xy.y * scene.Image.x + xy.x);
  bool live = false;
  if (all(lessThan(xy, scene.Image.xy)))
  {
    Ray ray = CameraRay(pixel);
    live = ray.Enter <= ray.Leave;
    rayBlock[pixel] = live ? BlockIndex(FirstBlock(ray)) : EXITED;
    rayHit[pixel] = NO_HIT;
    pixelColor[pixel] = 0u;
  }
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
