// What every stage knows of the image, the camera, the isovalues, the volume and the cache.

#include "Shared/Constants.glsl.h"

#define UNIFORM_BLOCK(name, number) layout(std140, binding = number) uniform name
#define INSTANCE(name) name
#include "Shared/SceneBlocks.glsl.h"

// What follows from what the scene needs.
#if defined(TRANSLUCENT) || defined(CROPPED)
#define MANY_CROSSINGS // not every crossing of a ray with a surface is its hit
#endif
#if defined(HAS_RAYS) && (defined(LIT) || defined(TRANSLUCENT) || defined(COLORED))
#define HAS_PENDING_HITS // hits are queued to be lit, coloured or blended
#endif
#ifdef TRANSLUCENT
#define RAYS_CONTINUE true // behind a hit
#else
#define RAYS_CONTINUE false
#endif

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
