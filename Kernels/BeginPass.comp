// Begin of a pass: the rays that went on are this pass's; N_spec = min(limit, floor(w h / N_act))
// (section 4); the dispatches get their sizes.
// In: Control. Out: Control, PassStatistics.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "PassControl.glsl"

layout(local_size_x = 1) in;

void main()
{
  TurnOver();
  uint rays = control.NextLiveRays;
  uint pixels = uint(scene.Image.x * scene.Image.y);
  control.LiveRays = rays;
  control.NextLiveRays = 0u;
  control.Speculation = rays == 0u ? 0u : clamp(pixels / rays, 1u, scene.Cache.z);
  control.TraverseGroups.X = GroupsFor(rays, 64u);
  control.PairGroups.X = GroupsFor(rays * control.Speculation, 64u);
}
