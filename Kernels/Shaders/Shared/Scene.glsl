// What every stage knows about the image, the camera, the volume and the isovalue: one uniform block,
// written once per Render by the mapper (struct SceneBlock, same order).

#define NONE 0xFFFFFFFFu    // no block, no slot, no map page, no pixel
#define CLAIMED 0xFFFFFFFEu // a macrocell whose map page is being assigned in this very dispatch
#define NO_HIT 0xFFFFFFFFu  // hit key of a ray that has met no surface
#define NO_NORMAL 0x80008000u // of a pixel that has none yet; no packed normal has these bits
#define MAX_GROUPS 65535u   // OpenGL 4.3's guaranteed number of work groups on an axis
#define MAX_LIGHTS 16
#define ONE_SIDED 0
#define TWO_SIDED 1
#define LIT_LIKE_MESHES 2
#define MAX_ISOVALUES 16
#define MAX_CLIPPING_PLANES 16

struct Light
{
  vec4 Place; // view coordinates: position (w = 1) or direction towards the light (w = 0)
  vec4 Color; // diffuse colour times intensity; w: the exponent of a spot light
  vec4 Axis;  // of a spot light, in view coordinates; w: cosine of its cone's angle, or -2 where it has none
  vec4 Fading; // with distance: constant, linear, quadratic; w unused
  vec4 Highlight; // specular colour times intensity; w unused
};

layout(std140, binding = 0) uniform Scene
{
  // A pixel's ray in index space: origin and direction are O[0] + x O[1] + y O[2] at the pixel's
  // centre (x, y); its parameter t is the depth along the view direction in world units.
  dvec4 RayOrigin[3];
  dvec4 RayDirection[3];
  dvec4 EyeOrigin[3]; // the same in view coordinates
  dvec4 EyeDirection[3];
  dvec4 RayRange;    // near and far clipping distance
  dvec4 ClippingPlanes[MAX_CLIPPING_PLANES]; // index space: the surface is drawn where xyz p + w >= 0
  dvec4 CroppingLow;  // index space: the planes that part the volume into 3^3 regions
  dvec4 CroppingHigh;
  ivec4 FirstDrawn;  // the surface is drawn between these samples; a piece of a volume has more, for normals
  ivec4 LastDrawn;
  ivec4 Samples;     // samples per axis; w: bits per block of the stream
  ivec4 Blocks;      // ZFP blocks per axis; w: their number
  ivec4 Macrocells; // macrocells of 4^3 blocks per axis; w: their number
  ivec4 Image;       // width and height of the viewport, its origin in the window
  uvec4 Cache;       // slots, pages of the block map, speculation limit, 1 where it cannot grow
  uvec4 Policy;      // few rays: as many pixels a ray; pixels that a ray has for each block it looks ahead
  ivec4 Surface;     // number of isovalues, of clipping planes, bits of the regions that are drawn; bits per
                     // block of the stream that gives the colours
  vec4 Isovalues[MAX_ISOVALUES]; // in the units of the stream, each as a sum of two floats
  mat4 NormalMatrix; // index-space gradient to view-space normal (3x3)
  vec4 DepthTerms; // clip-space z and w as functions of t: z = x + y t, w = z + w t
  vec4 Colors[MAX_ISOVALUES]; // of the isosurfaces; w: opacity
  vec4 Material;   // ambient, diffuse, specular, specular power
  ivec4 Lighting;  // number of lights (0: unlit); 1: an isosurface is translucent; 1: opaque geometry hides it;
                   // how the sides
                   // are lit
  Light Lights[MAX_LIGHTS];
}
scene;

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
