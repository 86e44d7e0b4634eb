// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The uniform blocks of all stages, one for each owner. GLSL (Scene.glsl) and C++ (Glsl.h) read
// this file. Padding is spelt out: std140 aligns a vector of three like one of four, but lets a
// scalar fill the gap.

// A vector that is Base + x PerX + y PerY at the pixel's centre (x, y) of the viewport.
struct PixelVector
{
  vec3 Base;
  float Padding0;
  vec3 PerX;
  float Padding1;
  vec3 PerY;
  float Padding2;
};

// The same in fixed point: Base and what is gained for each half pixel, of which the first pixel's
// centre has one. Words of 32 bits before the point and behind it; those of the gains go on, so
// that no sum of thousands is off.
struct FixedPixelVector
{
  ivec3 BaseHigh;
  int Padding0;
  uvec3 BaseLow;
  int Padding1;
  ivec3 PerXHigh;
  int Padding2;
  uvec3 PerXLow;
  int Padding3;
  uvec3 PerXLeast;
  int Padding4;
  ivec3 PerYHigh;
  int Padding5;
  uvec3 PerYLow;
  int Padding6;
  uvec3 PerYLeast;
  int Padding7;
};

// Where a plane cuts the axes of cells: the cell, and the place in it from 0 to 1.
struct CellPlanes
{
  ivec3 Cell;
  int Padding0;
  vec3 Place;
  float Padding1;
};

// A number as the sum of two floats.
struct FloatSum
{
  float High;
  float Low;
  float Padding0;
  float Padding1;
};

// Parameters of rays: up to which a level of detail is drawn, and from which on it goes over to the
// next, with the weights of that at both. Words of 32 bits.
struct LevelSpan
{
  int BlendHigh;
  uint BlendLow;
  int UntilHigh;
  uint UntilLow;
  float FirstWeight;
  float LastWeight;
  float Padding0;
  float Padding1;
};

// What decides which hits rays have: any change restarts the image. From the mapper.
UNIFORM_BLOCK(View, VIEW_BINDING)
{
  // In index space, where rays begin to be drawn, and their way from there to where they end.
  FixedPixelVector RayOrigin;
  FixedPixelVector RayWay;
  PixelVector EyeOrigin;    // view coordinates; a ray's depth along the view direction times
  PixelVector EyeDirection; // its direction leads from its origin to a point
  CellPlanes CroppingLow;   // the planes that part the volume into 3^3 regions
  CellPlanes CroppingHigh;
  // Distances from clipping planes, of the first three and so on, the components of a vector: at
  // the origins, and what is gained on the way. The surface is drawn where none is negative.
  FixedPixelVector ClippingOrigin[(MAX_CLIPPING_PLANES + 2) / 3];
  FixedPixelVector ClippingWay[(MAX_CLIPPING_PLANES + 2) / 3];
  ivec3 FirstDrawn; // samples between which the surface is drawn; beyond, they only give normals
  int NumberOfIsovalues;
  ivec3 LastDrawn;
  int NumberOfClippingPlanes;
  ivec2 ImageSize;        // of the rectangle of the viewport that has rays
  ivec2 FirstPixel;       // of the image, in the viewport
  ivec2 ViewportSize;     // in pixels, of which each is one of the window's or a rectangle of them
  ivec2 ViewportOrigin;   // in the window
  vec2 PixelsPerFragment; // on each axis, 1 or less
  int NumberOfLevels;     // of detail that are drawn
  int Padding0;
  int DrawnRegions; // a bit for each cropping region
  int HasRays;      // 0: no ray meets what is drawn
  float FirstDepth; // of the origins
  float DepthOfWay;
  LevelSpan Levels[MAX_LEVELS];
  FloatSum Isovalues[MAX_ISOVALUES]; // in the units of the stream
}
INSTANCE(view);

struct IsosurfaceColor
{
  vec3 Rgb;
  float Opacity;
};

// Colours are multiplied by the light's intensity, places are in view coordinates.
struct Light
{
  vec3 Position; // or the direction towards the light
  int IsPositional;
  vec3 Diffuse;
  float ConeExponent;
  vec3 ConeAxis;
  float ConeCosine; // of the angle between axis and border
  float ConstantAttenuation;
  float LinearAttenuation; // per unit of distance
  float QuadraticAttenuation;
  int IsSpot; // else the members of the cone do not count
  vec3 Specular;
  float Padding0;
};

// What decides how hits look: a change needs no new rays. From the mapper.
UNIFORM_BLOCK(Look, LOOK_BINDING)
{
  mat3 NormalMatrix; // from gradients in index space to normals in view space
  float ClipZ;       // clip coordinates z and w at t = 0, and what they gain with t
  float ClipZPerT;
  float ClipW;
  float ClipWPerT;
  float Ambient;
  float Diffuse;
  float Specular;
  float SpecularPower;
  int NumberOfLights; // 0: unlit
  int LitSides;
  int Padding0;
  int Padding1;
  IsosurfaceColor Colors[MAX_ISOVALUES];
  Light Lights[MAX_LIGHTS];
}
INSTANCE(look);

// The grid of a level of detail. Blocks and macrocells are numbered through all levels.
struct VolumeLevel
{
  ivec3 Samples;
  uint FirstBlock;
  ivec3 Blocks;
  uint FirstMacrocell;
  ivec3 Macrocells;
  int Padding0;
  ivec3 Halvings; // how often each axis has every second sample of the volume itself
  int Padding1;
};

// From the pipeline, once a volume.
UNIFORM_BLOCK(Volume, VOLUME_BINDING)
{
  ivec3 Samples;
  uint NumberOfBlocks; // of all levels
  ivec3 Blocks;
  uint NumberOfMacrocells; // likewise
  ivec3 Macrocells;
  int NumberOfLevels;
  VolumeLevel Levels[MAX_LEVELS]; // the volume itself first
}
INSTANCE(volume);

// From the pipeline: the cache's size, and how it is to be used.
UNIFORM_BLOCK(Cache, CACHE_BINDING)
{
  uint Slots;
  uint MapPages;
  uint CannotGrow;
  uint SpeculationLimit;   // blocks that a ray may ask for in a pass
  uint PixelsPerStraggler; // so few rays, or fewer, get a work group each; 0: never
  uint SlotCapacity;       // slots that the buffer of samples is laid out for, at least Slots
  uint FirstNewSlot;       // of those, and
  uint FirstNewPage;       // map pages, that the cache has grown by last
}
INSTANCE(cache);
