// Decodes a 4^3 block of floats of a fixed-rate ZFP stream, bit for bit as libzfp 1.0 does
// (template/decode.c, decode3.c, codecf.c). One lane decodes one block. Bit planes lie in shared
// memory, a column for each lane, because they are indexed by a variable; everything else stays in
// registers, where nothing may be.

#include "Store/BlockStore.glsl"

#define ZFP_EXPONENT_BITS 8u
#define ZFP_EXPONENT_BIAS 127
#define ZFP_NEGABINARY 0xAAAAAAAAu

shared uint zfpPlanes[64u * GROUP_SIZE];

// Place of bit plane k of the first 32 coefficients; that of the other 32 is at 32 + k.
uint PlaneIndex(uint k, uint lane)
{
  return k * GROUP_SIZE + lane;
}

// Decodes a step of a plane's run-length coded part. A zero ends the plane: returns false. A one is
// followed by a run of zeros and the one that ends it, which is implied for the last coefficient.
// `n` counts the coefficients that are significant so far.
bool DecodeRun(
  inout BitCursor bits, inout uint budget, inout uint n, inout uint low, inout uint high)
{
  uint window = PeekBits(bits);
  if ((window & 1u) == 0u)
  {
    SkipBits(bits, 1u);
    --budget;
    return false;
  }
  uint limit = min(budget - 1u, 63u - n);
  uint zeros = uint(findLSB((window >> 1) | 0x80000000u));
  uint used = 1u;
  if (zeros == 31u && limit > 31u) // longer than the window
  {
    SkipBits(bits, 32u);
    budget -= 32u;
    n += 31u;
    limit -= 31u;
    window = PeekBits(bits);
    zeros = window == 0u ? 32u : uint(findLSB(window));
    used = 0u;
  }
  used += zeros < limit ? zeros + 1u : limit;
  n += min(zeros, limit);
  SkipBits(bits, used);
  budget -= used;
  low |= n < 32u ? 1u << n : 0u;
  high |= n < 32u ? 0u : 1u << (n - 32u);
  ++n;
  return true;
}

// Decodes bit planes from the most significant one on until the block's budget of bits is spent:
// each is a verbatim part of n bits and a run-length coded remainder.
void DecodePlanes(inout BitCursor bits, uint budget, uint lane)
{
  uint n = 0u;
  for (uint k = 32u; k-- > 0u;)
  {
    uint m = min(n, budget);
    budget -= m;
    uint low = ReadBits(bits, min(m, 32u));
    uint high = m > 32u ? ReadBits(bits, m - 32u) : 0u;
    while (budget > 0u && n < 64u && DecodeRun(bits, budget, n, low, high))
    {
    }
    zfpPlanes[PlaneIndex(k, lane)] = low;
    zfpPlanes[PlaneIndex(32u + k, lane)] = high;
  }
}

// 32 words of 32 bits.
struct BitMatrix
{
  uvec4 Word[8];
};

uvec4 LoadPlanes(uint k, uint lane)
{
  return uvec4(zfpPlanes[PlaneIndex(k, lane)], zfpPlanes[PlaneIndex(k + 1u, lane)],
    zfpPlanes[PlaneIndex(k + 2u, lane)], zfpPlanes[PlaneIndex(k + 3u, lane)]);
}

void SwapBits(inout uvec4 a, inout uvec4 b, uint shift, uint mask)
{
  uvec4 t = ((a >> shift) ^ b) & mask;
  a ^= t << shift;
  b ^= t;
}

// The last two rounds of the transposition, among the four words of a vector.
void SwapBitsWithin(inout uvec4 a)
{
  uvec2 t = ((a.xy >> 2) ^ a.zw) & 0x33333333u;
  a = uvec4(a.xy ^ t << 2, a.zw ^ t);
  t = ((a.xz >> 1) ^ a.yw) & 0x55555555u;
  a ^= uvec4(t.x << 1, t.x, t.y << 1, t.y);
}

// Makes coefficients of bit planes: transposes a matrix of 32 x 32 bits by swapping halves.
BitMatrix TransposePlanes(uint first, uint lane)
{
  BitMatrix m;
  m.Word[0] = LoadPlanes(first, lane);
  m.Word[1] = LoadPlanes(first + 4u, lane);
  m.Word[2] = LoadPlanes(first + 8u, lane);
  m.Word[3] = LoadPlanes(first + 12u, lane);
  m.Word[4] = LoadPlanes(first + 16u, lane);
  m.Word[5] = LoadPlanes(first + 20u, lane);
  m.Word[6] = LoadPlanes(first + 24u, lane);
  m.Word[7] = LoadPlanes(first + 28u, lane);
  SwapBits(m.Word[0], m.Word[4], 16u, 0x0000FFFFu);
  SwapBits(m.Word[1], m.Word[5], 16u, 0x0000FFFFu);
  SwapBits(m.Word[2], m.Word[6], 16u, 0x0000FFFFu);
  SwapBits(m.Word[3], m.Word[7], 16u, 0x0000FFFFu);
  SwapBits(m.Word[0], m.Word[2], 8u, 0x00FF00FFu);
  SwapBits(m.Word[1], m.Word[3], 8u, 0x00FF00FFu);
  SwapBits(m.Word[4], m.Word[6], 8u, 0x00FF00FFu);
  SwapBits(m.Word[5], m.Word[7], 8u, 0x00FF00FFu);
  SwapBits(m.Word[0], m.Word[1], 4u, 0x0F0F0F0Fu);
  SwapBits(m.Word[2], m.Word[3], 4u, 0x0F0F0F0Fu);
  SwapBits(m.Word[4], m.Word[5], 4u, 0x0F0F0F0Fu);
  SwapBits(m.Word[6], m.Word[7], 4u, 0x0F0F0F0Fu);
  SwapBitsWithin(m.Word[0]);
  SwapBitsWithin(m.Word[1]);
  SwapBitsWithin(m.Word[2]);
  SwapBitsWithin(m.Word[3]);
  SwapBitsWithin(m.Word[4]);
  SwapBitsWithin(m.Word[5]);
  SwapBitsWithin(m.Word[6]);
  SwapBitsWithin(m.Word[7]);
  return m;
}

// A block's coefficients, then its samples: rows in x direction, with number y + 4 z.
struct IntegerBlock
{
  ivec4 Row[16];
};

ivec4 FromNegabinary(uvec4 bits)
{
  return ivec4((bits ^ ZFP_NEGABINARY) - ZFP_NEGABINARY);
}

// Sorts coefficients from the order of increasing sequency (zfp's perm_3) into that of the grid.
IntegerBlock Reorder(BitMatrix low, BitMatrix high)
{
  IntegerBlock block;
  block.Row[0] =
    FromNegabinary(uvec4(low.Word[0].x, low.Word[0].y, low.Word[1].w, low.Word[4].y));
  block.Row[1] =
    FromNegabinary(uvec4(low.Word[0].z, low.Word[1].z, low.Word[2].w, low.Word[6].z));
  block.Row[2] =
    FromNegabinary(uvec4(low.Word[2].x, low.Word[3].z, low.Word[6].y, high.Word[1].z));
  block.Row[3] =
    FromNegabinary(uvec4(low.Word[4].z, low.Word[7].y, high.Word[2].y, high.Word[5].y));
  block.Row[4] =
    FromNegabinary(uvec4(low.Word[0].w, low.Word[1].y, low.Word[3].x, low.Word[6].w));
  block.Row[5] =
    FromNegabinary(uvec4(low.Word[1].x, low.Word[2].z, low.Word[5].x, high.Word[0].w));
  block.Row[6] =
    FromNegabinary(uvec4(low.Word[3].y, low.Word[5].y, high.Word[0].z, high.Word[3].y));
  block.Row[7] =
    FromNegabinary(uvec4(low.Word[7].x, high.Word[1].x, high.Word[4].x, high.Word[6].w));
  block.Row[8] =
    FromNegabinary(uvec4(low.Word[2].y, low.Word[3].w, low.Word[6].x, high.Word[1].w));
  block.Row[9] =
    FromNegabinary(uvec4(low.Word[4].x, low.Word[5].z, high.Word[0].y, high.Word[3].z));
  block.Row[10] =
    FromNegabinary(uvec4(low.Word[5].w, high.Word[0].x, high.Word[3].x, high.Word[5].z));
  block.Row[11] =
    FromNegabinary(uvec4(high.Word[2].x, high.Word[3].w, high.Word[5].w, high.Word[7].z));
  block.Row[12] =
    FromNegabinary(uvec4(low.Word[4].w, low.Word[7].z, high.Word[2].z, high.Word[5].x));
  block.Row[13] =
    FromNegabinary(uvec4(low.Word[7].w, high.Word[1].y, high.Word[4].y, high.Word[6].z));
  block.Row[14] =
    FromNegabinary(uvec4(high.Word[2].w, high.Word[4].z, high.Word[6].x, high.Word[7].y));
  block.Row[15] =
    FromNegabinary(uvec4(high.Word[4].w, high.Word[6].y, high.Word[7].x, high.Word[7].w));
  return block;
}

// Inverts the lifted decorrelating transform (zfp's inv_lift) on four lines of four at once.
void InverseLift(inout ivec4 x, inout ivec4 y, inout ivec4 z, inout ivec4 w)
{
  y += w >> 1;
  w -= y >> 1;
  y += w;
  w <<= 1;
  w -= y;
  z += x;
  x <<= 1;
  x -= z;
  y += z;
  z <<= 1;
  z -= y;
  w += x;
  x <<= 1;
  x -= w;
}

// Along the four rows of a slice.
void InverseLiftRows(inout ivec4 a, inout ivec4 b, inout ivec4 c, inout ivec4 d)
{
  ivec4 x = ivec4(a.x, b.x, c.x, d.x);
  ivec4 y = ivec4(a.y, b.y, c.y, d.y);
  ivec4 z = ivec4(a.z, b.z, c.z, d.z);
  ivec4 w = ivec4(a.w, b.w, c.w, d.w);
  InverseLift(x, y, z, w);
  a = ivec4(x.x, y.x, z.x, w.x);
  b = ivec4(x.y, y.y, z.y, w.y);
  c = ivec4(x.z, y.z, z.z, w.z);
  d = ivec4(x.w, y.w, z.w, w.w);
}

// Along z, y and x, in libzfp's order (inv_xform).
void InverseTransform(inout IntegerBlock b)
{
  InverseLift(b.Row[0], b.Row[4], b.Row[8], b.Row[12]);
  InverseLift(b.Row[1], b.Row[5], b.Row[9], b.Row[13]);
  InverseLift(b.Row[2], b.Row[6], b.Row[10], b.Row[14]);
  InverseLift(b.Row[3], b.Row[7], b.Row[11], b.Row[15]);
  InverseLift(b.Row[0], b.Row[1], b.Row[2], b.Row[3]);
  InverseLift(b.Row[4], b.Row[5], b.Row[6], b.Row[7]);
  InverseLift(b.Row[8], b.Row[9], b.Row[10], b.Row[11]);
  InverseLift(b.Row[12], b.Row[13], b.Row[14], b.Row[15]);
  InverseLiftRows(b.Row[0], b.Row[1], b.Row[2], b.Row[3]);
  InverseLiftRows(b.Row[4], b.Row[5], b.Row[6], b.Row[7]);
  InverseLiftRows(b.Row[8], b.Row[9], b.Row[10], b.Row[11]);
  InverseLiftRows(b.Row[12], b.Row[13], b.Row[14], b.Row[15]);
}

// The bits of the float i * 2^exponent. Exact even if it or the scale is subnormal, where GPUs may
// flush floats to zero.
uint Dequantize(int i, int exponent)
{
  if (exponent >= -126)
  {
    precise float value = float(i) * uintBitsToFloat(uint(exponent + 127) << 23);
    return floatBitsToUint(value);
  }
  if (exponent < -149 || i == 0)
  {
    return i < 0 ? 0x80000000u : 0u; // libzfp's scale underflows to zero
  }
  uint bits = floatBitsToUint(float(i));
  int biased = int((bits >> 23) & 0xFFu) + exponent;
  if (biased > 0)
  {
    return (bits & 0x807FFFFFu) | (uint(biased) << 23);
  }
  // a subnormal result is a whole multiple of 2^-149: an integer in the mantissa
  uint magnitude = (bits & 0x007FFFFFu) | 0x00800000u;
  int shift = 1 - biased;
  return (bits & 0x80000000u) | (shift < 24 ? magnitude >> shift : 0u);
}

uvec4 DequantizeRow(ivec4 row, int exponent)
{
  return uvec4(Dequantize(row.x, exponent), Dequantize(row.y, exponent),
    Dequantize(row.z, exponent), Dequantize(row.w, exponent));
}

// The bits of a decoded block's floats: rows in x direction, with number y + 4 z.
struct DecodedBlock
{
  uvec4 Row[16];
};

#define FOR_ROWS(DO) \
  DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) \
  DO(8) DO(9) DO(10) DO(11) DO(12) DO(13) DO(14) DO(15)

DecodedBlock DecodeBlock(uint block, uint lane)
{
  DecodedBlock decoded;
  BitCursor bits = OpenBlock(block);
  if (ReadBits(bits, 1u) == 0u)
  {
#define ZERO_ROW(r) decoded.Row[r] = uvec4(0u);
    FOR_ROWS(ZERO_ROW)
    return decoded;
  }
  int exponent = int(ReadBits(bits, ZFP_EXPONENT_BITS)) - ZFP_EXPONENT_BIAS - 30;
  DecodePlanes(bits, BlockBits() - 1u - ZFP_EXPONENT_BITS, lane);
  IntegerBlock integers = Reorder(TransposePlanes(0u, lane), TransposePlanes(32u, lane));
  InverseTransform(integers);
#define DEQUANTIZE_ROW(r) decoded.Row[r] = DequantizeRow(integers.Row[r], exponent);
  FOR_ROWS(DEQUANTIZE_ROW)
  return decoded;
}
