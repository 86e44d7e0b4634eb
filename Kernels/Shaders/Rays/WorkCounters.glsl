// Counts what the rays of a work group do, for the records of passes.

#include "Cache/UseBlocks.glsl"

uint pairs = 0u; // of a ray and a block that this invocation has intersected

shared uint groupActiveRays;
shared uint groupPairs;
shared uint groupVisibleBlocks;
shared uint groupActiveBlocks;

// Call first, with a barrier behind it.
void OpenWorkCounters()
{
  if (gl_LocalInvocationIndex == 0u)
  {
    groupActiveRays = 0u;
    groupPairs = 0u;
    groupVisibleBlocks = 0u;
    groupActiveBlocks = 0u;
    OpenTouchedSlots();
  }
}

void CloseWorkCounters()
{
  atomicAdd(groupPairs, pairs);
  AddTouchedSlots();
#ifdef BUFFER_CACHE_SEEN
  atomicAdd(groupVisibleBlocks, visibleBlocks);
  atomicAdd(groupActiveBlocks, activeBlocks);
#endif
  barrier();
  if (gl_LocalInvocationIndex == 0u && groupActiveRays > 0u)
  {
    atomicAdd(control.ActiveRays, groupActiveRays);
    atomicAdd(control.Pairs, groupPairs);
    CloseTouchedSlots();
#ifdef BUFFER_CACHE_SEEN
    atomicAdd(control.VisibleBlocks, groupVisibleBlocks);
    atomicAdd(control.ActiveBlocks, groupActiveBlocks);
#endif
  }
}
