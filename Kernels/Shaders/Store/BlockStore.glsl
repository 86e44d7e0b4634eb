// Where a block's bits lie, which no other file knows, and a cursor that reads them. Block i of a
// fixed-rate ZFP stream begins at bit i * BlockBits, which may need more than 32 bits and is not
// aligned. Each level of detail has a stream of its own. One that is longer than a buffer can be
// lies in segments of whole layers of macrocells; a dispatch sees one segment of one stream.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Store/Segment.glsl.h"

uniform Segment segment;

bool InSegment(uint block)
{
  return block - segment.FirstBlock < segment.Blocks;
}

// Word and bit at which a block begins.
uvec2 BlockStart(uint block)
{
  uint high, low, carry;
  umulExtended(block - segment.FirstBlock, segment.BlockBits, high, low);
  low = uaddCarry(low, segment.FirstBit, carry);
  high += carry;
  return uvec2((high << 27) | (low >> 5), low & 31u);
}

// A word of the stream; zeros beyond the end.
uint StreamWord(uint word)
{
  return word < segment.Words ? stream[word] : 0u;
}

// A place in a block's bits, with the two words around it.
struct BitCursor
{
  uint Low, High;
  uint Word;  // index of Low
  uint Shift; // bits of Low that have been read, 0 … 31
};

BitCursor OpenBlock(uint block)
{
  uvec2 start = BlockStart(block);
  return BitCursor(StreamWord(start.x), StreamWord(start.x + 1u), start.x, start.y);
}

// The next 32 bits; the cursor stays.
uint PeekBits(BitCursor bits)
{
  return (bits.Low >> bits.Shift) | ((bits.High << 1) << (31u - bits.Shift));
}

// Moves on by n <= 32 bits.
void SkipBits(inout BitCursor bits, uint n)
{
  bits.Shift += n;
  if (bits.Shift >= 32u)
  {
    bits.Shift -= 32u;
    bits.Low = bits.High;
    ++bits.Word;
    bits.High = StreamWord(bits.Word + 1u);
  }
}

// Reads n <= 32 bits.
uint ReadBits(inout BitCursor bits, uint n)
{
  uint value = n == 0u ? 0u : PeekBits(bits) & (0xFFFFFFFFu >> (32u - n));
  SkipBits(bits, n);
  return value;
}
