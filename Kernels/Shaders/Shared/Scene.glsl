// What every stage knows of the image, the camera, the isovalues, the volume and the cache.

#include "Shared/SceneBlocks.glsl.h"

#define NONE 0xFFFFFFFFu    // no block, no slot, no map page, no pixel
#define CLAIMED 0xFFFFFFFEu // a macrocell whose map page is being assigned in this very dispatch
#define NO_HIT 0xFFFFFFFFu  // hit key of a ray that has met no surface
#define NO_NORMAL 0x80008000u // of a pixel that has none yet; no packed normal has these bits
#define MAX_GROUPS 65535u   // OpenGL 4.3's guaranteed number of work groups on an axis

// What follows from what the scene needs.
#if defined(TRANSLUCENT) || defined(CROPPED)
#define MANY_CROSSINGS // not every crossing of a ray with a surface is its hit
#endif
#if defined(HAS_RAYS) && (defined(LIT) || defined(TRANSLUCENT) || defined(COLORED))
#define HIT_LIST // hits go on, to be lit, coloured or blended
#endif

// Dispatches are folded into two dimensions where one would exceed MAX_GROUPS.
#ifdef COMPUTE
uint FoldedGroup()
{
  return gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
}
#endif
