// A box of blocks that lie decoded in the first slots, x fastest, while the ranges of their
// macrocells are found.

#include "Shared/Grid.glsl"
#include "Store/Box.glsl.h"

uniform BlockBox box;

uint BlocksInBox()
{
  return uint(box.Size.x) * uint(box.Size.y) * uint(box.Size.z);
}

// Number of the box's block in place i.
uint BlockInBox(uint i)
{
  uvec3 size = uvec3(box.Size);
  uvec3 at = uvec3(i % size.x, i / size.x % size.y, i / (size.x * size.y));
  return BlockIndex(box.First + ivec3(at));
}

// Place of a block that the box has.
uint PlaceInBox(ivec3 block)
{
  uvec3 at = uvec3(block - box.First);
  return at.x + uint(box.Size.x) * (at.y + uint(box.Size.y) * at.z);
}
