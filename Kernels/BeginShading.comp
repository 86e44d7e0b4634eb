// Begin of a shading round: the cache turns over as between passes, the rays rest.
// In: Control. Out: Control, PassStatistics.

#include "Scene.glsl"
#include "Buffers.glsl"
#include "PassControl.glsl"

layout(local_size_x = 1) in;

void main()
{
  TurnOver();
  control.LiveRays = 0u;
}
