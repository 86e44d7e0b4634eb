// What eviction knows of a page of the block map that is in use.

#include "Shared/Buffers.glsl"

// Passes since the page was used last; larger ages count as the largest.
uint AgeOf(uint page)
{
  return min(control.PassSerial - 1u - mapPages[page].Stamp, PASS_AGES - 1u);
}

// What evicting the page yields: a page if pages are short, else its slots.
uint UnitsOf(uint page)
{
  return control.EvictByPages != 0u ? 1u : mapPages[page].Used;
}
