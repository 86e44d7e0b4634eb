// What every stage knows of the image, the camera, the isovalues, the volume and the cache.

#include "Shared/Constants.glsl.h"

#define UNIFORM_BLOCK(name, number) layout(std140, binding = number) uniform name
#define INSTANCE(name) name
#include "Shared/SceneBlocks.glsl.h"

// Work groups of this size that it takes to give each item an invocation.
uint GroupsOf(uint items, uint size)
{
  return (items + size - 1u) / size;
}

// Dispatches are folded into two dimensions where one would exceed MAX_GROUPS.
#ifdef COMPUTE
uint FoldedGroup()
{
  return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}
#endif
