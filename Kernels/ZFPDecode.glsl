// Decoder of one 4^3 float block of a fixed-rate ZFP stream, bit for bit as libzfp 1.0 does it
// (template/decode.c, decode3.c, codecf.c). One lane decodes one block, in its own column of shared
// memory; columns are skewed so that a group can also read one block's 64 values without conflicts.

#define ZFP_LANES 32u
#define ZFP_EXPONENT_BITS 8u
#define ZFP_EXPONENT_BIAS 127
#define ZFP_NEGABINARY 0xAAAAAAAAu

shared uint zfpColumns[64u * ZFP_LANES];

// Position of coefficient i of lane's block.
uint ColumnIndex(uint i, uint lane)
{
  return i * ZFP_LANES + (lane ^ (i & (ZFP_LANES - 1u)));
}

// Coefficients in order of increasing sequency (perm_3), as positions x + 4 y + 16 z.
const uint ZFP_ORDER[64] = uint[64](0u, 1u, 4u, 16u, 20u, 17u, 5u, 2u, 8u, 32u, 21u, 6u, 18u, 24u, 9u,
  33u, 36u, 3u, 12u, 48u, 22u, 25u, 37u, 40u, 34u, 10u, 7u, 19u, 28u, 13u, 49u, 52u, 41u, 38u, 26u, 23u,
  29u, 53u, 11u, 35u, 44u, 14u, 50u, 56u, 42u, 27u, 39u, 45u, 30u, 54u, 57u, 60u, 51u, 15u, 43u, 46u,
  58u, 61u, 55u, 31u, 62u, 59u, 47u, 63u);

// Length of the run of zeros at the cursor, up to and without the next one; at most `limit` <= 63 bits
// are looked at, and what was looked at is skipped.
uint TakeZeros(inout BitCursor bits, inout uint budget, uint limit)
{
  uint run = 0u;
  while (limit > 0u)
  {
    uint window = NextBits(bits);
    uint zeros = window == 0u ? 32u : uint(findLSB(window));
    bool found = zeros < limit && zeros < 32u;
    zeros = min(zeros, limit);
    uint used = zeros + (found ? 1u : 0u);
    SkipBits(bits, used);
    budget -= used;
    run += zeros;
    limit = found ? 0u : limit - zeros;
  }
  return run;
}

// Adds bit k to the coefficients, from `first` on, whose bit is set in `plane`.
void DepositPlane(uint plane, uint first, uint k, uint lane)
{
  for (; plane != 0u; plane &= plane - 1u)
  {
    uint i = first + uint(findLSB(plane));
    zfpColumns[ColumnIndex(ZFP_ORDER[i], lane)] |= 1u << k;
  }
}

// Embedded coding: bit planes from the most significant one, each a verbatim part of n bits and a
// run-length coded remainder, until the block's budget of bits is spent.
void DecodePlanes(inout BitCursor bits, uint budget, uint lane)
{
  uint n = 0u;
  for (uint k = 32u; k-- > 0u && budget > 0u;)
  {
    uint m = min(n, budget);
    budget -= m;
    uint low = TakeBits(bits, min(m, 32u));
    uint high = m > 32u ? TakeBits(bits, m - 32u) : 0u;
    while (budget > 0u && n < 64u)
    {
      --budget;
      if (TakeBits(bits, 1u) == 0u)
      {
        break; // no further one in this plane
      }
      n += TakeZeros(bits, budget, min(budget, 63u - n)); // the last coefficient's one is implied
      low |= n < 32u ? 1u << n : 0u;
      high |= n < 32u ? 0u : 1u << (n - 32u);
      ++n;
    }
    DepositPlane(low, 0u, k, lane);
    DepositPlane(high, 32u, k, lane);
  }
}

// Inverse of the lifted decorrelating transform along one line of four.
void InverseLift(uint first, uint stride, uint lane)
{
  uint ix = ColumnIndex(first, lane);
  uint iy = ColumnIndex(first + stride, lane);
  uint iz = ColumnIndex(first + 2u * stride, lane);
  uint iw = ColumnIndex(first + 3u * stride, lane);
  int x = int(zfpColumns[ix]), y = int(zfpColumns[iy]), z = int(zfpColumns[iz]), w = int(zfpColumns[iw]);
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
  zfpColumns[ix] = uint(x);
  zfpColumns[iy] = uint(y);
  zfpColumns[iz] = uint(z);
  zfpColumns[iw] = uint(w);
}

// The float i * 2^exponent as bits, exact also where it or the scale is subnormal: GPUs may flush those.
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
  // subnormal result: a whole multiple of 2^-149, hence an integer in the mantissa
  uint magnitude = (bits & 0x007FFFFFu) | 0x00800000u;
  int shift = 1 - biased;
  return (bits & 0x80000000u) | (shift < 24 ? magnitude >> shift : 0u);
}

// Decodes `block` into lane's column, as float bits at position x + 4 y + 16 z.
void DecodeBlock(uint block, uint lane)
{
  for (uint i = 0u; i < 64u; ++i)
  {
    zfpColumns[ColumnIndex(i, lane)] = 0u;
  }
  BitCursor bits = OpenBlock(block);
  if (TakeBits(bits, 1u) == 0u)
  {
    return; // a block of zeros
  }
  int exponent = int(TakeBits(bits, ZFP_EXPONENT_BITS)) - ZFP_EXPONENT_BIAS - 30;
  DecodePlanes(bits, uint(scene.Samples.w) - 1u - ZFP_EXPONENT_BITS, lane);
  for (uint i = 0u; i < 64u; ++i)
  {
    uint at = ColumnIndex(i, lane);
    zfpColumns[at] = (zfpColumns[at] ^ ZFP_NEGABINARY) - ZFP_NEGABINARY;
  }
  for (uint i = 0u; i < 16u; ++i)
  {
    InverseLift(i, 16u, lane); // along z
  }
  for (uint i = 0u; i < 16u; ++i)
  {
    InverseLift((i & 3u) + 16u * (i >> 2), 4u, lane); // along y
  }
  for (uint i = 0u; i < 16u; ++i)
  {
    InverseLift(4u * i, 1u, lane); // along x
  }
  for (uint i = 0u; i < 64u; ++i)
  {
    uint at = ColumnIndex(i, lane);
    zfpColumns[at] = Dequantize(int(zfpColumns[at]), exponent);
  }
}
