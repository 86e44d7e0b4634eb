// The two-level macrocell grid (section 3.1) and the walk of Amanatides and Woo over it (section 3.3).
// A ray's position at parameter T is: every plane with t <= T is crossed. Stepping a block, skipping a
// coarse cell and starting inside the volume all obey this one rule, hence agree.

ivec3 BlockCoordinates(uint block)
{
  uint slice = uint(scene.Blocks.x) * uint(scene.Blocks.y);
  uint inSlice = block % slice;
  return ivec3(inSlice % uint(scene.Blocks.x), inSlice / uint(scene.Blocks.x), block / slice);
}

uint BlockIndex(ivec3 b)
{
  return uint(b.x) + uint(scene.Blocks.x) * (uint(b.y) + uint(scene.Blocks.y) * uint(b.z));
}

bool InGrid(ivec3 b)
{
  return all(greaterThanEqual(b, ivec3(0))) && all(lessThan(b, scene.Blocks.xyz));
}

// Blocks that hold cells; a last block of a single sample holds none.
ivec3 LastCellBlock()
{
  return (scene.Samples.xyz - 2) / 4;
}

// Planes through which the ray enters and leaves element `e` of a grid of `size` voxels an element.
ivec3 EntryPlanes(Ray ray, ivec3 e, int size)
{
  return (e + (1 - ray.Step) / 2) * size;
}

ivec3 ExitPlanes(Ray ray, ivec3 e, int size)
{
  return (e + (1 + ray.Step) / 2) * size;
}

double BlockEntry(Ray ray, ivec3 block)
{
  return max(ray.Enter, LargestOf(PlanesT(ray, EntryPlanes(ray, block, 4))));
}

double BlockExit(Ray ray, ivec3 block)
{
  return min(ray.Leave, SmallestOf(PlanesT(ray, ExitPlanes(ray, block, 4))));
}

// Does a range hold both a value below the isovalue and one that is not?
bool Straddles(float low, float high)
{
  precise float below = (low - scene.Isovalue.x) - scene.Isovalue.y;
  precise float above = (high - scene.Isovalue.x) - scene.Isovalue.y;
  return below < 0.0 && above >= 0.0;
}

#ifdef BINDING_COARSE_RANGES
uint CoarseIndex(ivec3 c)
{
  return uint(c.x) + uint(scene.CoarseCells.x) * (uint(c.y) + uint(scene.CoarseCells.y) * uint(c.z));
}

// A block's range is kept in 8 + 8 bits, as steps within its coarse cell's range, rounded outwards.
float RangeLow(vec2 coarse, uint q)
{
  precise float low = coarse.x + float(q) * (coarse.y / 255.0 - coarse.x / 255.0);
  return q == 0u ? coarse.x : low;
}

float RangeHigh(vec2 coarse, uint q)
{
  precise float high = coarse.x + float(q) * (coarse.y / 255.0 - coarse.x / 255.0);
  return q == 255u ? coarse.y : high;
}

#ifdef BINDING_BLOCK_RANGES
bool BlockStraddles(vec2 coarse, uint coarseIndex, ivec3 block)
{
  uint local = uint(block.x & 3) + 4u * uint(block.y & 3) + 16u * uint(block.z & 3);
  uint word = blockRanges[coarseIndex * 32u + (local >> 1)];
  uint range = (local & 1u) == 0u ? word & 0xFFFFu : word >> 16;
  uint low = range & 0xFFu;
  uint high = range >> 8;
  return low <= high && Straddles(RangeLow(coarse, low), RangeHigh(coarse, high));
}
#endif
#endif

// Where the ray crosses the plane behind which it leaves `block`, at or before parameter t, it moves on.
ivec3 Crossed(Ray ray, ivec3 block, double t)
{
  return ivec3(lessThanEqual(PlanesT(ray, ExitPlanes(ray, block, 4)), dvec3(t))) * ray.Step;
}

// The block the ray is in when it enters the volume: a rounded guess, which the planes put right.
ivec3 FirstBlock(Ray ray)
{
  ivec3 last = LastCellBlock();
  dvec3 p = ray.Origin + ray.Enter * ray.Direction;
  ivec3 block = ivec3(clamp(floor(p / 4.0LF), dvec3(0.0LF), dvec3(last)));
  for (int i = 0; i < 2; ++i)
  {
    block -= ivec3(greaterThan(PlanesT(ray, EntryPlanes(ray, block, 4)), dvec3(ray.Enter))) * ray.Step;
  }
  for (int i = 0; i < 2; ++i)
  {
    block += Crossed(ray, block, ray.Enter);
  }
  return clamp(block, ivec3(0), last);
}

// One step of the walk over blocks; false where the ray has left the volume.
bool NextBlock(Ray ray, inout ivec3 block)
{
  dvec3 exits = PlanesT(ray, ExitPlanes(ray, block, 4));
  double t = SmallestOf(exits);
  if (t >= ray.Leave)
  {
    return false;
  }
  block += ivec3(lessThanEqual(exits, dvec3(t))) * ray.Step;
  return InGrid(block);
}

// Leaves the coarse cell that holds `block`; false where the ray has left the volume.
bool SkipCoarseCell(Ray ray, inout ivec3 block)
{
  ivec3 coarse = block >> 2;
  dvec3 exits = PlanesT(ray, ExitPlanes(ray, coarse, 16));
  double t = SmallestOf(exits);
  if (t >= ray.Leave)
  {
    return false;
  }
  ivec3 within = block;
  for (int i = 0; i < 3; ++i)
  {
    within += Crossed(ray, within, t);
  }
  // on the axes where it leaves the coarse cell it comes to the first block behind it
  ivec3 behind = 4 * coarse - 1 + 5 * (1 + ray.Step) / 2;
  block = within + (behind - within) * ivec3(lessThanEqual(exits, dvec3(t)));
  return InGrid(block);
}
