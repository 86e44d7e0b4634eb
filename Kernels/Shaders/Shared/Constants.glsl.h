// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Constants that GLSL (Scene.glsl) and C++ (Glsl.h) both read.

// Bindings of the uniform blocks.
#define VIEW_BINDING 0
#define LOOK_BINDING 1
#define VOLUME_BINDING 2
#define CACHE_BINDING 3
#define PALETTE_BINDING 4

// Limits of the scene.
const int MAX_LIGHTS = 16;
const int MAX_ISOVALUES = 256;
const int MAX_CLIPPING_PLANES = 16;
const int MAX_LEVELS = 12;             // of detail, the volume itself among them
const int ALL_REGIONS = (1 << 27) - 1; // a bit for each cropping region
const int PALETTE_SIZE = 768;          // nodes: with all else 16 KiB, as OpenGL 4.3 guarantees

// Values of Look.LitSides: a light reaches a surface from where the values are lower, from either
// side, or only the side that is seen, as VTK's meshes are lit.
const int ONE_SIDED = 0;
const int TWO_SIDED = 1;
const int LIT_LIKE_MESHES = 2;

// The grid: ZFP's blocks of samples, and macrocells of blocks.
const int BLOCK_SIDE_LOG2 = 2;
const int BLOCK_SIDE = 1 << BLOCK_SIDE_LOG2;
const int ROWS_PER_BLOCK = BLOCK_SIDE * BLOCK_SIDE; // of samples in x direction
const int SAMPLES_PER_BLOCK = BLOCK_SIDE * BLOCK_SIDE * BLOCK_SIDE;
const int MACROCELL_SIDE_LOG2 = 2; // in blocks
const int MACROCELL_SIDE = 1 << MACROCELL_SIDE_LOG2;
const int BLOCKS_PER_MACROCELL = MACROCELL_SIDE * MACROCELL_SIDE * MACROCELL_SIDE;

// What stands in a buffer in place of a number.
const uint NONE = 0xFFFFFFFFu;      // no block, no slot, no map page, no pixel
const uint CLAIMED = 0xFFFFFFFEu;   // in this dispatch a macrocell's map page is being assigned
const uint NO_HIT = 0xFFFFFFFFu;    // hit key of a ray that has met no surface
const uint NO_NORMAL = 0x80008000u; // not found yet; no packed normal has these bits

// A ray's parameter counts from 0, where rays begin to be drawn, to 2^WAY_BITS, where they end.
// Seven bits are left above for planes beyond, and a hit's key has the upper KEY_BITS.
const int WAY_BITS = 57;
const int KEY_BITS = 32;

// Rays ask for blocks ahead of them: a ray for at most so many in a pass, and for one more for each
// so many pixels that it has to itself; the rays of a work group for at most so many together.
const int MAX_SPECULATION = 64;
const uint PIXELS_PER_BLOCK_AHEAD = 4u;
const uint GROUP_BLOCKS_AHEAD = 256u;

// Pixels whose rays take part in a pass, at least: the smallest cache has room for all that these
// need at once.
const uint LEAST_WINDOW = 64u;

const uint MAX_GROUPS = 65535u; // work groups on an axis, as OpenGL 4.3 guarantees
const uint PASS_RECORDS = 64u;  // ring of the last passes' statistics
const uint PASS_AGES = 256u;    // ages, in passes, that the cache tells apart
