// Integers of 64 bits in two words, for what rays are made of: every GPU adds and multiplies them
// exactly and alike, and none needs double precision for it. Sums and products wrap.

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

// Times a number that is not negative.
Wide3 Product(Wide3 a, uvec3 b)
{
  uvec3 high, low;
  umulExtended(a.Low, b, high, low);
  return Wide3(ivec3(high + uvec3(a.High) * b), low);
}

// Comparisons are of numbers whose difference does not wrap.
bool IsLess(Wide a, Wide b)
{
  return Difference(a, b).High < 0;
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

// a, or b where `choice`, a component -1 or 0, tells.
ivec3 Choose(ivec3 a, ivec3 b, ivec3 choice)
{
  return a ^ ((a ^ b) & choice);
}

Wide3 Choose(Wide3 a, Wide3 b, ivec3 choice)
{
  return Wide3(Choose(a.High, b.High, choice), a.Low ^ ((a.Low ^ b.Low) & uvec3(choice)));
}

Wide3 SmallerOf(Wide3 a, Wide3 b)
{
  return Choose(b, a, Difference(a, b).High >> 31);
}

Wide3 LargerOf(Wide3 a, Wide3 b)
{
  return Choose(a, b, Difference(a, b).High >> 31);
}

// Negated where `negative`, a component -1 or 0, tells.
Wide3 Negated(Wide3 a, ivec3 negative)
{
  Wide3 flipped = Wide3(a.High ^ negative, a.Low ^ uvec3(negative));
  return Difference(flipped, Wide3(negative, uvec3(negative)));
}

const float TWO_TO_32 = 4294967296.0;

float ToFloat(Wide a)
{
  return float(a.High) * TWO_TO_32 + float(a.Low);
}

vec3 ToFloat(Wide3 a)
{
  return vec3(a.High) * TWO_TO_32 + vec3(a.Low);
}

// Of a number that is not negative.
Wide ToWide(float a)
{
  float high = floor(a * (1.0 / TWO_TO_32));
  return Wide(int(high), uint(a - high * TWO_TO_32));
}

// Bits that are zero above the highest that is not, of numbers that are positive.
ivec3 LeadingZeros(Wide3 a)
{
  ivec3 inHigh = 31 - findMSB(a.High);
  return Choose(inHigh, 63 - findMSB(a.Low), -ivec3(equal(a.High, ivec3(0))));
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

// Times 2^bits, for 1 to 31 bits.
Wide3 Doubled(Wide3 a, int bits)
{
  return Wide3(a.High << bits | ivec3(a.Low >> (32 - bits)), a.Low << bits);
}

// Divided by 2^bits, for 1 to 31 bits, of numbers that are not negative.
Wide3 Halved(Wide3 a, int bits)
{
  return Wide3(a.High >> bits, a.Low >> bits | uvec3(a.High) << (32 - bits));
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

// The product of two numbers without a sign, over 2^64; up to two less.
Wide3 HighProduct(Wide3 a, Wide3 b)
{
  uvec3 high, low, highLow, lowHigh, unused, carry;
  umulExtended(uvec3(a.High), uvec3(b.High), high, low);
  umulExtended(uvec3(a.High), b.Low, highLow, unused);
  umulExtended(a.Low, uvec3(b.High), lowHigh, unused);
  low = uaddCarry(low, highLow, carry);
  high += carry;
  low = uaddCarry(low, lowHigh, carry);
  return Wide3(ivec3(high + carry), low);
}

// r a / 2^32
Wide3 ProductWithFraction(uvec3 r, Wide3 a)
{
  uvec3 high, low, rest, unused, carry;
  umulExtended(r, uvec3(a.High), high, low);
  umulExtended(r, a.Low, rest, unused);
  low = uaddCarry(low, rest, carry);
  return Wide3(ivec3(high + carry), low);
}

// 2^126 / a to some 60 bits, of numbers without a sign whose highest bit is set. By Newton's
// method, from 15 bits: r' = r (2 - r a).
Wide3 Reciprocal(Wide3 a)
{
  uvec3 leading = uvec3(a.High);
  uvec3 r = (0xFFFFFFFFu / (leading >> 16u)) << 15u; // 2^63 / leading
  uvec3 high, low, unused;
  umulExtended(r, leading, high, unused);
  umulExtended(r, 0u - high, high, low);
  r = high << 1u | low >> 31u;
  Wide3 product = ProductWithFraction(r, a); // 2^63, nearly
  return ProductWithFraction(r, Difference(Wide3(ivec3(0), uvec3(0u)), product));
}
