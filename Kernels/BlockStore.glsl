// The block store: the only place that knows where a block's bits live. Block i of a fixed-rate ZFP
// stream starts at bit i * blockbits, which may exceed 32 bits and need not be aligned.

// Word and bit of a block's first bit.
uvec2 BlockStart(uint block)
{
  uint high, low;
  umulExtended(block, scene.Payload.x, high, low);
  return uvec2((high << 27) | (low >> 5), low & 31u);
}

// 32 bits of the payload from bit `bit` after `start`; zeros beyond the end.
uint PeekBits(uvec2 start, uint bit)
{
  uint position = start.y + bit;
  uint word = start.x + (position >> 5);
  uint shift = position & 31u;
  uint last = scene.Payload.y - 1u;
  uint low = word <= last ? payload[word] : 0u;
  if (shift == 0u)
  {
    return low;
  }
  uint high = word < last ? payload[word + 1u] : 0u;
  return (low >> shift) | (high << (32u - shift));
}
