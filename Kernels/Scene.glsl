// What every stage knows about the image, the camera, the volume and the isovalue: one uniform block,
// written once per Render by vtkProgressiveIsosurfacePipeline (struct SceneBlock, same order).

#define NONE 0xFFFFFFFFu      // no block, no entry, no slot
#define CLAIMED 0xFFFFFFFEu   // an entry whose cache slot is being assigned in this very dispatch
#define UNGROUPED 0xFFFFFFFEu // run of a block whose rays are intersected one by one
#define EXITED 0xFFFFFFFFu    // state of a ray that needs no further block
#define NO_HIT 0xFFFFFFFFu    // hit key of a ray that has met no surface
#define MAX_GROUPS 65535u     // OpenGL 4.3's guaranteed number of work groups on an axis
#define MAX_LIGHTS 16

struct Light
{
  vec4 Place; // view coordinates: position (w = 1) or direction towards the light (w = 0)
  vec4 Color; // colour times intensity
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
  ivec4 Samples;     // samples per axis
  ivec4 Blocks;      // ZFP blocks per axis; w: their number
  ivec4 CoarseCells; // macrocells of 4^3 blocks per axis; w: their number
  ivec4 Image;       // width and height of the viewport, its origin in the window
  uvec4 Payload;     // bits per block, 32-bit words of payload, rays per work item and from how many on a block gets one
  uvec4 Cache;       // slots, entries of the block map, speculation limit
  vec4 Isovalue;     // the isovalue as a sum of two floats
  mat4 NormalMatrix; // index-space gradient to view-space normal (3x3)
  vec4 DepthTerms; // clip-space z and w as functions of t: z = x + y t, w = z + w t
  vec4 Color;      // of the isosurface; w unused
  vec4 Material;   // ambient, diffuse, specular, specular power
  ivec4 Lighting;  // number of lights (0: unlit)
  Light Lights[MAX_LIGHTS];
}
scene;
