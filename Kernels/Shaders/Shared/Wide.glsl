// Integers of 64 bits, for what rays are made of: every GPU adds and multiplies them exactly and
// alike, and none needs double precision for it. Sums and products wrap. They are the GPU's own
// where it has them (NATIVE_INT64), which is less code; else pairs of words. Both give the same.

#ifdef NATIVE_INT64
#define Wide int64_t
#define Wide3 i64vec3

// Of constants.
#define WIDE(high, low) (int64_t(high) << 32 | int64_t(low))

Wide WideOf(int high, uint low)
{
  return packInt2x32(ivec2(int(low), high));
}

Wide3 WideOf(ivec3 high, uvec3 low)
{
  return Wide3(WideOf(high.x, low.x), WideOf(high.y, low.y), WideOf(high.z, low.z));
}

int HighOf(Wide a)
{
  return unpackInt2x32(a).y;
}

uint LowOf(Wide a)
{
  return uint(unpackInt2x32(a).x);
}

ivec3 HighOf(Wide3 a)
{
  return ivec3(HighOf(a.x), HighOf(a.y), HighOf(a.z));
}

uvec3 LowOf(Wide3 a)
{
  return uvec3(LowOf(a.x), LowOf(a.y), LowOf(a.z));
}

Wide3 AllOf(Wide a)
{
  return Wide3(a);
}

Wide Sum(Wide a, Wide b)
{
  return a + b;
}

Wide3 Sum(Wide3 a, Wide3 b)
{
  return a + b;
}

Wide Difference(Wide a, Wide b)
{
  return a - b;
}

Wide3 Difference(Wide3 a, Wide3 b)
{
  return a - b;
}

// Comparisons are of numbers whose difference does not wrap.
bool IsLess(Wide a, Wide b)
{
  return a < b;
}

bvec3 AreLess(Wide3 a, Wide3 b)
{
  return lessThan(a, b);
}

bvec3 AreEqual(Wide3 a, Wide b)
{
  return equal(a, Wide3(b));
}

// -1 where a component is not greater, else 0.
ivec3 AreReached(Wide3 a, Wide b)
{
  return -ivec3(lessThanEqual(a, Wide3(b)));
}

// a, or b where `choice`, a component -1 or 0, tells.
Wide3 Choose(Wide3 a, Wide3 b, ivec3 choice)
{
  return mix(a, b, notEqual(choice, ivec3(0)));
}

// 0 where `kept`, a component -1 or 0, is 0.
Wide3 Masked(Wide3 a, ivec3 kept)
{
  return a & Wide3(kept);
}

// With those bits of a changed that b has.
Wide3 Flipped(Wide3 a, Wide3 b)
{
  return a ^ b;
}

Wide SmallerOf(Wide a, Wide b)
{
  return a < b ? a : b;
}

Wide3 SmallerOf(Wide3 a, Wide3 b)
{
  return mix(b, a, lessThan(a, b));
}

Wide LargerOf(Wide a, Wide b)
{
  return a < b ? b : a;
}

Wide3 LargerOf(Wide3 a, Wide3 b)
{
  return mix(a, b, lessThan(a, b));
}

Wide SmallestOf(Wide3 a)
{
  return SmallerOf(a.x, SmallerOf(a.y, a.z));
}

Wide LargestOf(Wide3 a)
{
  return LargerOf(a.x, LargerOf(a.y, a.z));
}

// Times 2^bits, for 1 to 31 bits.
Wide Doubled(Wide a, int bits)
{
  return a << bits;
}

Wide3 Doubled(Wide3 a, int bits)
{
  return a << bits;
}

// Divided by 2^bits, for 1 to 31 bits, of numbers that are not negative.
Wide3 Halved(Wide3 a, int bits)
{
  return a >> bits;
}

// Times 2^bits, for 0 to 63 bits.
Wide3 ShiftLeft(Wide3 a, ivec3 bits)
{
  return a << bits;
}

// Of numbers without a sign, by 0 to 63 bits.
Wide3 ShiftRight(Wide3 a, ivec3 bits)
{
  return Wide3(u64vec3(a) >> bits);
}
#else
struct Wide
{
  int High;
  uint Low;
};

struct Wide3
{
  ivec3 High;
  uvec3 Low;
};

// Of constants.
#define WIDE(high, low) Wide(high, low)

Wide WideOf(int high, uint low)
{
  return Wide(high, low);
}

Wide3 WideOf(ivec3 high, uvec3 low)
{
  return Wide3(high, low);
}

int HighOf(Wide a)
{
  return a.High;
}

uint LowOf(Wide a)
{
  return a.Low;
}

ivec3 HighOf(Wide3 a)
{
  return a.High;
}

uvec3 LowOf(Wide3 a)
{
  return a.Low;
}

Wide3 AllOf(Wide a)
{
  return Wide3(ivec3(a.High), uvec3(a.Low));
}

Wide Sum(Wide a, Wide b)
{
  uint carry;
  uint low = uaddCarry(a.Low, b.Low, carry);
  return Wide(a.High + b.High + int(carry), low);
}

Wide3 Sum(Wide3 a, Wide3 b)
{
  uvec3 carry;
  uvec3 low = uaddCarry(a.Low, b.Low, carry);
  return Wide3(a.High + b.High + ivec3(carry), low);
}

Wide Difference(Wide a, Wide b)
{
  uint borrow;
  uint low = usubBorrow(a.Low, b.Low, borrow);
  return Wide(a.High - b.High - int(borrow), low);
}

Wide3 Difference(Wide3 a, Wide3 b)
{
  uvec3 borrow;
  uvec3 low = usubBorrow(a.Low, b.Low, borrow);
  return Wide3(a.High - b.High - ivec3(borrow), low);
}

// Comparisons are of numbers whose difference does not wrap.
bool IsLess(Wide a, Wide b)
{
  return Difference(a, b).High < 0;
}

bvec3 AreLess(Wide3 a, Wide3 b)
{
  return lessThan(Difference(a, b).High, ivec3(0));
}

bvec3 AreEqual(Wide3 a, Wide b)
{
  return equal(uvec3(a.High ^ b.High) | (a.Low ^ b.Low), uvec3(0u));
}

// -1 where a component is not greater, else 0.
ivec3 AreReached(Wide3 a, Wide b)
{
  return ~(Difference(AllOf(b), a).High >> 31);
}

// a, or b where `choice`, a component -1 or 0, tells.
Wide3 Choose(Wide3 a, Wide3 b, ivec3 choice)
{
  return Wide3(
    a.High ^ ((a.High ^ b.High) & choice), a.Low ^ ((a.Low ^ b.Low) & uvec3(choice)));
}

// 0 where `kept`, a component -1 or 0, is 0.
Wide3 Masked(Wide3 a, ivec3 kept)
{
  return Wide3(a.High & kept, a.Low & uvec3(kept));
}

Wide3 Flipped(Wide3 a, Wide3 b)
{
  return Wide3(a.High ^ b.High, a.Low ^ b.Low);
}

Wide SmallerOf(Wide a, Wide b)
{
  bool less = IsLess(a, b);
  return Wide(less ? a.High : b.High, less ? a.Low : b.Low);
}

Wide LargerOf(Wide a, Wide b)
{
  bool less = IsLess(a, b);
  return Wide(less ? b.High : a.High, less ? b.Low : a.Low);
}

Wide SmallestOf(Wide3 a)
{
  return SmallerOf(Wide(a.High.x, a.Low.x),
    SmallerOf(Wide(a.High.y, a.Low.y), Wide(a.High.z, a.Low.z)));
}

Wide LargestOf(Wide3 a)
{
  return LargerOf(
    Wide(a.High.x, a.Low.x), LargerOf(Wide(a.High.y, a.Low.y), Wide(a.High.z, a.Low.z)));
}

Wide3 SmallerOf(Wide3 a, Wide3 b)
{
  return Choose(b, a, Difference(a, b).High >> 31);
}

Wide3 LargerOf(Wide3 a, Wide3 b)
{
  return Choose(a, b, Difference(a, b).High >> 31);
}

// Times 2^bits, for 1 to 31 bits.
Wide Doubled(Wide a, int bits)
{
  return Wide(a.High << bits | int(a.Low >> (32 - bits)), a.Low << bits);
}

Wide3 Doubled(Wide3 a, int bits)
{
  return Wide3(a.High << bits | ivec3(a.Low >> (32 - bits)), a.Low << bits);
}

// Divided by 2^bits, for 1 to 31 bits, of numbers that are not negative.
Wide3 Halved(Wide3 a, int bits)
{
  return Wide3(a.High >> bits, a.Low >> bits | uvec3(a.High) << (32 - bits));
}

// Times 2^bits, for 0 to 63 bits.
Wide3 ShiftLeft(Wide3 a, ivec3 bits)
{
  Wide3 byWord = Wide3(ivec3(a.Low), uvec3(0u));
  Wide3 part = Choose(a, byWord, -(bits >> 5));
  uvec3 rest = uvec3(bits & 31);
  uvec3 high = uvec3(part.High) << rest | (part.Low >> 1u) >> (31u - rest);
  return Wide3(ivec3(high), part.Low << rest);
}

// Of numbers without a sign, by 0 to 63 bits.
Wide3 ShiftRight(Wide3 a, ivec3 bits)
{
  Wide3 byWord = Wide3(ivec3(0), uvec3(a.High));
  Wide3 part = Choose(a, byWord, -(bits >> 5));
  uvec3 rest = uvec3(bits & 31);
  uvec3 low = part.Low >> rest | (uvec3(part.High) << 1u) << (31u - rest);
  return Wide3(ivec3(uvec3(part.High) >> rest), low);
}
#endif

// a, or b where `choice`, a component -1 or 0, tells.
ivec3 Choose(ivec3 a, ivec3 b, ivec3 choice)
{
  return a ^ ((a ^ b) & choice);
}

// -1 where a component is negative, else 0.
ivec3 AreNegative(Wide3 a)
{
  return HighOf(a) >> 31;
}

// Negated where `negative`, a component -1 or 0, tells.
Wide3 Negated(Wide3 a, ivec3 negative)
{
  Wide3 ones = WideOf(negative, uvec3(negative));
  return Difference(Flipped(a, ones), ones);
}

// Times a number that is not negative.
Wide3 Product(Wide3 a, uvec3 b)
{
  uvec3 high, low;
  umulExtended(LowOf(a), b, high, low);
  return WideOf(ivec3(high + uvec3(HighOf(a)) * b), low);
}

const float TWO_TO_32 = 4294967296.0;

float ToFloat(Wide a)
{
  return float(HighOf(a)) * TWO_TO_32 + float(LowOf(a));
}

vec3 ToFloat(Wide3 a)
{
  return vec3(HighOf(a)) * TWO_TO_32 + vec3(LowOf(a));
}

// Of a number that is not negative.
Wide ToWide(float a)
{
  float high = floor(a * (1.0 / TWO_TO_32));
  return WideOf(int(high), uint(a - high * TWO_TO_32));
}

// Bits that are zero above the highest that is not, of numbers that are positive.
ivec3 LeadingZeros(Wide3 a)
{
  ivec3 inHigh = 31 - findMSB(HighOf(a));
  return Choose(inHigh, 63 - findMSB(LowOf(a)), -ivec3(equal(HighOf(a), ivec3(0))));
}

// The product of two numbers without a sign, over 2^64; up to two less.
Wide3 HighProduct(Wide3 a, Wide3 b)
{
  uvec3 high, low, highLow, lowHigh, unused, carry;
  umulExtended(uvec3(HighOf(a)), uvec3(HighOf(b)), high, low);
  umulExtended(uvec3(HighOf(a)), LowOf(b), highLow, unused);
  umulExtended(LowOf(a), uvec3(HighOf(b)), lowHigh, unused);
  low = uaddCarry(low, highLow, carry);
  high += carry;
  low = uaddCarry(low, lowHigh, carry);
  return WideOf(ivec3(high + carry), low);
}

// r a / 2^32
Wide3 ProductWithFraction(uvec3 r, Wide3 a)
{
  uvec3 high, low, rest, unused, carry;
  umulExtended(r, uvec3(HighOf(a)), high, low);
  umulExtended(r, LowOf(a), rest, unused);
  low = uaddCarry(low, rest, carry);
  return WideOf(ivec3(high + carry), low);
}

// 2^126 / a to some 60 bits, of numbers without a sign whose highest bit is set. By Newton's
// method, from 15 bits: r' = r (2 - r a).
Wide3 Reciprocal(Wide3 a)
{
  uvec3 leading = uvec3(HighOf(a));
  uvec3 r = (0xFFFFFFFFu / (leading >> 16u)) << 15u; // 2^63 / leading
  uvec3 high, low, unused;
  umulExtended(r, leading, high, unused);
  umulExtended(r, 0u - high, high, low);
  r = high << 1u | low >> 31u;
  Wide3 product = ProductWithFraction(r, a); // 2^63, nearly
  return ProductWithFraction(r, Difference(WideOf(ivec3(0), uvec3(0u)), product));
}
