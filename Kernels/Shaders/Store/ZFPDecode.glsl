// Decodes a 4^3 block of floats of a fixed-rate ZFP stream, bit for bit as libzfp 1.0 does
// (template/decode.c, decode3.c, codecf.c). One lane decodes one block. Its bit planes, then its
// coefficients, lie in shared memory, a column for each lane: what is indexed by a variable cannot
// stay in registers, and loops that are not unrolled compile in a fraction of the time.

#include "Store/BlockStore.glsl"

#define ZFP_EXPONENT_BITS 8u
#define ZFP_EXPONENT_BIAS 127
#define ZFP_NEGABINARY 0xAAAAAAAAu

shared uint zfpWords[uint(SAMPLES_PER_BLOCK) * GROUP_SIZE];

// Place of word k of a lane's block: bit plane k of the first 32 coefficients, or k - 32 of the
// others; later coefficient k.
uint WordIndex(uint k, uint lane)
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
    zfpWords[WordIndex(k, lane)] = low;
    zfpWords[WordIndex(32u + k, lane)] = high;
  }
}

// 32 words of 32 bits.
struct BitMatrix
{
  uvec4 Word[8];
};

#define FOR_WORDS(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

uvec4 LoadPlanes(uint k, uint lane)
{
  return uvec4(zfpWords[WordIndex(k, lane)], zfpWords[WordIndex(k + 1u, lane)],
    zfpWords[WordIndex(k + 2u, lane)], zfpWords[WordIndex(k + 3u, lane)]);
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

ivec4 FromNegabinary(uvec4 bits)
{
  return ivec4((bits ^ ZFP_NEGABINARY) - ZFP_NEGABINARY);
}

void StoreCoefficients(uint k, uint lane, uvec4 bits)
{
  uvec4 words = uvec4(FromNegabinary(bits));
  zfpWords[WordIndex(k, lane)] = words.x;
  zfpWords[WordIndex(k + 1u, lane)] = words.y;
  zfpWords[WordIndex(k + 2u, lane)] = words.z;
  zfpWords[WordIndex(k + 3u, lane)] = words.w;
}

// Makes 32 coefficients of their bit planes: transposes a matrix of 32 x 32 bits by swapping
// halves.
void TransposePlanes(uint first, uint lane)
{
  BitMatrix m;
#define LOAD_PLANES(i) m.Word[i] = LoadPlanes(first + 4u * uint(i), lane);
  FOR_WORDS(LOAD_PLANES)
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
#define FINISH_COEFFICIENTS(i)                                                                     \
  SwapBitsWithin(m.Word[i]);                                                                       \
  StoreCoefficients(first + 4u * uint(i), lane, m.Word[i]);
  FOR_WORDS(FINISH_COEFFICIENTS)
}

// Which coefficients a block's rows in x direction have, a byte each, the first one lowest: zfp
// sorts them by sequency (perm_3). A row has the number y + 4 z.
const uint PLACES[16] = uint[16](
  0x11070100u, 0x1A0B0602u, 0x26190E08u, 0x35291D12u,
  0x1B0C0503u, 0x23140A04u, 0x2D22150Du, 0x3B30241Cu,
  0x27180F09u, 0x2E211610u, 0x362C2017u, 0x3E372F28u,
  0x342A1E13u, 0x3A31251Fu, 0x3D38322Bu, 0x3F3C3933u);

uvec4 WordsOfRow(uint row, uint lane)
{
  uvec4 coefficients = (uvec4(PLACES[row]) >> uvec4(0u, 8u, 16u, 24u)) & 0xFFu;
  return coefficients * GROUP_SIZE + lane;
}

ivec4 LoadRow(uvec4 words)
{
  return ivec4(zfpWords[words.x], zfpWords[words.y], zfpWords[words.z], zfpWords[words.w]);
}

void StoreRow(uvec4 words, ivec4 row)
{
  zfpWords[words.x] = uint(row.x);
  zfpWords[words.y] = uint(row.y);
  zfpWords[words.z] = uint(row.z);
  zfpWords[words.w] = uint(row.w);
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

// The transform along z, which libzfp inverts first (inv_xform): in place.
void InverseTransformZ(uint lane)
{
  for (uint y = 0u; y < uint(BLOCK_SIDE); ++y)
  {
    uvec4 at0 = WordsOfRow(y, lane), at1 = WordsOfRow(y + 4u, lane);
    uvec4 at2 = WordsOfRow(y + 8u, lane), at3 = WordsOfRow(y + 12u, lane);
    ivec4 a = LoadRow(at0), b = LoadRow(at1), c = LoadRow(at2), d = LoadRow(at3);
    InverseLift(a, b, c, d);
    StoreRow(at0, a);
    StoreRow(at1, b);
    StoreRow(at2, c);
    StoreRow(at3, d);
  }
}

// All bits where a component is true.
uvec4 MaskOf(bvec4 chosen)
{
  return uvec4(0u) - uvec4(chosen);
}

// The bits of the floats i * 2^exponent for exponents below -126, where GPUs may flush the scale or
// the result to zero. A subnormal float is a whole multiple of 2^-149: an integer in its mantissa.
uvec4 DequantizeTiny(ivec4 i, int exponent)
{
  uvec4 bits = floatBitsToUint(vec4(i));
  uvec4 mantissa = bits & 0x007FFFFFu;
  ivec4 biased = ivec4((bits >> 23) & 0xFFu) + exponent;
  uvec4 normal = mantissa | uvec4(biased) << 23;
  uvec4 subnormal = (mantissa | 0x00800000u) >> clamp(1 - biased, 0, 31);
  uvec4 isNormal = MaskOf(greaterThan(biased, ivec4(0)));
  uvec4 magnitude = (normal & isNormal) | (subnormal & ~isNormal);
  magnitude &= MaskOf(notEqual(i, ivec4(0)));
  bool underflows = exponent < -149; // libzfp's scale is zero
  return (bits & 0x80000000u) | (underflows ? uvec4(0u) : magnitude);
}

uvec4 DequantizeRow(ivec4 i, int exponent)
{
  if (exponent < -126)
  {
    return DequantizeTiny(i, exponent);
  }
  precise vec4 values = vec4(i) * uintBitsToFloat(uint(exponent + 127) << 23);
  return floatBitsToUint(values);
}

// Decodes a block but for the transform along y and x, which SamplesOfSlice makes. Returns the
// exponent of its integers. A block of zeros has no bits.
int DecodeBlock(uint block, uint lane)
{
  BitCursor bits = OpenBlock(block);
  bool hasBits = ReadBits(bits, 1u) != 0u;
  int exponent = int(ReadBits(bits, ZFP_EXPONENT_BITS)) - ZFP_EXPONENT_BIAS - 30;
  DecodePlanes(bits, hasBits ? segment.BlockBits - 1u - ZFP_EXPONENT_BITS : 0u, lane);
  for (uint part = 0u; part < 2u; ++part)
  {
    TransposePlanes(32u * part, lane);
  }
  InverseTransformZ(lane);
  return exponent;
}

// The bits of the floats of a block's slice: rows in x direction.
struct DecodedSlice
{
  uvec4 Row[BLOCK_SIDE];
};

DecodedSlice SamplesOfSlice(uint z, int exponent, uint lane)
{
  ivec4 a = LoadRow(WordsOfRow(4u * z, lane)), b = LoadRow(WordsOfRow(4u * z + 1u, lane));
  ivec4 c = LoadRow(WordsOfRow(4u * z + 2u, lane)), d = LoadRow(WordsOfRow(4u * z + 3u, lane));
  InverseLift(a, b, c, d);
  InverseLiftRows(a, b, c, d);
  return DecodedSlice(uvec4[BLOCK_SIDE](DequantizeRow(a, exponent), DequantizeRow(b, exponent),
    DequantizeRow(c, exponent), DequantizeRow(d, exponent)));
}
