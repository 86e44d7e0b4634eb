// Macrocell grid traversal (section 3.3): the walk of a ray over macrocells and their blocks, after Amanatides and
// Woo, to the next block whose range holds the isovalue. A ray's position at parameter T is: every plane with t <= T
// is crossed. Stepping a block, skipping a macrocell and starting inside the volume all obey this one rule, hence agree.

// Blocks that hold cells; a last block of a single sample holds none.
ivec3 LastCellBlock()
{
  return (volume.Samples - 2) / 4;
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
bool Straddles(float low, float high, int surface)
{
  Isovalue isovalue = view.Isovalues[surface];
  precise float below = (low - isovalue.High) - isovalue.Low;
  precise float above = (high - isovalue.High) - isovalue.Low;
  return below < 0.0 && above >= 0.0;
}

// The same for any of the isovalues.
bool Straddles(float low, float high)
{
#ifdef SEVERAL_ISOVALUES
  for (int i = 0; i < view.NumberOfIsovalues; ++i)
  {
    if (Straddles(low, high, i))
    {
      return true;
    }
  }
  return false;
#else
  return Straddles(low, high, 0);
#endif
}

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

// Leaves the macrocell that holds `block`; false where the ray has left the volume.
bool SkipMacrocell(Ray ray, inout ivec3 block)
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
  // on the axes where it leaves the macrocell it comes to the first block behind it
  ivec3 behind = 4 * coarse - 1 + 5 * (1 + ray.Step) / 2;
  block = within + (behind - within) * ivec3(lessThanEqual(exits, dvec3(t)));
  return InGrid(block);
}

#ifdef CROPPED
// Number of the cropping region that a point lies in, in vtkVolumeMapper's order.
int CroppingRegion(dvec3 point)
{
  ivec3 side =
    ivec3(greaterThan(point, view.CroppingLow)) + ivec3(greaterThan(point, view.CroppingHigh));
  return side.x + 3 * side.y + 9 * side.z;
}

bool Drawn(int region)
{
  return (view.DrawnRegions >> region & 1) != 0;
}

// Does a block lie in one region, as a whole, which is not drawn?
bool OutOfSight(ivec3 block)
{
  int region = CroppingRegion(dvec3(4 * block));
  return region == CroppingRegion(dvec3(4 * block + 4)) && !Drawn(region);
}
#endif

// The macrocell that the ray is in.
struct GridCursor
{
  ivec3 Coarse;
  uint Index;
  vec2 Range;
  bool Active; // its range holds the isovalue
};

GridCursor OutsideGrid()
{
  return GridCursor(ivec3(-1), 0u, vec2(0.0), false);
}

void MoveCursor(inout GridCursor at, ivec3 coarse)
{
  at.Coarse = coarse;
  at.Index = MacrocellIndex(coarse);
  at.Range = vec2(macrocells[at.Index].Low, macrocells[at.Index].High);
  at.Active = Straddles(at.Range.x, at.Range.y);
}

bool BlockActive(GridCursor at, ivec3 block)
{
#ifdef CROPPED
  if (OutOfSight(block))
  {
    return false;
  }
#endif
  uint local = LocalIndex(block);
  uint word = macrocells[at.Index].Ranges[local >> 1];
  uint range = (local & 1u) == 0u ? word & 0xFFFFu : word >> 16;
  uint low = range & 0xFFu;
  uint high = range >> 8;
  return low <= high && Straddles(RangeLow(at.Range, low), RangeHigh(at.Range, high));
}

// Walks on from `block`, itself included; false where the ray leaves the volume first.
bool FindActiveBlock(Ray ray, inout ivec3 block, inout GridCursor at)
{
  bool inside = true;
  while (inside)
  {
    if ((block >> 2) != at.Coarse)
    {
      MoveCursor(at, block >> 2);
    }
    if (!at.Active)
    {
      inside = SkipMacrocell(ray, block);
      continue;
    }
    if (BlockActive(at, block))
    {
      return true;
    }
    inside = NextBlock(ray, block);
  }
  return false;
}
