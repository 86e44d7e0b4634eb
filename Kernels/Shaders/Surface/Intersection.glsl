// Intersects a ray with the trilinear isosurface inside a cell. Along the ray the trilinear
// interpolant is a cubic. As in Marmitt et al. (2004) its roots are first isolated, then refined,
// but on its Bernstein coefficients: values of the interpolant at corners of the box that the ray's
// way through the cell spans (the cubic's polar form). They are convex combinations of the values
// at the cell's corners: signs are decided without cancellation, and alike on both sides of a face.
// All arithmetic is `precise` because two stages have to find the same bits. A point is inside if
// value - isovalue >= 0; the surface is where inside and outside meet.

#include "Shared/Scene.glsl"

float Lerp(float a, float b, float s)
{
  precise float value = a * (1.0 - s) + b * s; // exactly a at s = 0 and b at s = 1
  return value;
}

vec2 Lerp(vec2 a, vec2 b, float s)
{
  precise vec2 value = a * (1.0 - s) + b * s;
  return value;
}

vec4 Lerp(vec4 a, vec4 b, float s)
{
  precise vec4 value = a * (1.0 - s) + b * s;
  return value;
}

// Values - isovalue at the corners of a cell's lower and upper z face, x fastest.
struct Corners
{
  vec4 Low, High;
};

// Bernstein coefficients along the segment from u0 to u1 in the cell's unit cube.
vec4 CubicAlong(Corners w, vec3 u0, vec3 u1)
{
  // on the four edges in x direction, y fastest, at the x of either end
  vec4 x0 = Lerp(vec4(w.Low.xz, w.High.xz), vec4(w.Low.yw, w.High.yw), u0.x);
  vec4 x1 = Lerp(vec4(w.Low.xz, w.High.xz), vec4(w.Low.yw, w.High.yw), u1.x);
  // on the lower and upper z face, at (x of one end, y of one end)
  vec2 f00 = Lerp(x0.xz, x0.yw, u0.y);
  vec2 f10 = Lerp(x1.xz, x1.yw, u0.y);
  vec2 f01 = Lerp(x0.xz, x0.yw, u1.y);
  vec2 f11 = Lerp(x1.xz, x1.yw, u1.y);
  precise float b1 = Lerp(f10.x, f10.y, u0.z) + Lerp(f01.x, f01.y, u0.z) + Lerp(f00.x, f00.y, u1.z);
  precise float b2 = Lerp(f11.x, f11.y, u0.z) + Lerp(f10.x, f10.y, u1.z) + Lerp(f01.x, f01.y, u1.z);
  return vec4(Lerp(f00.x, f00.y, u0.z), b1 / 3.0, b2 / 3.0, Lerp(f11.x, f11.y, u1.z));
}

// Value of the cubic at s, by de Casteljau's algorithm.
float CubicValue(vec4 b, float s)
{
  vec3 q = vec3(Lerp(b.x, b.y, s), Lerp(b.y, b.z, s), Lerp(b.z, b.w, s));
  vec2 l = vec2(Lerp(q.x, q.y, s), Lerp(q.y, q.z, s));
  return Lerp(l.x, l.y, s);
}

// A third of the derivative of the cubic at s.
float CubicSlope(vec4 b, float s)
{
  vec3 d = b.yzw - b.xyz;
  return Lerp(Lerp(d.x, d.y, s), Lerp(d.y, d.z, s), s);
}

bool Inside(float value)
{
  return value >= 0.0;
}

// Isolates roots: the parameters at which the cubic turns, in order, 1 for those that it lacks.
vec2 Extrema(vec4 b)
{
  vec3 d = b.yzw - b.xyz; // the derivative's Bernstein coefficients,
  d /= max(max(abs(d.x), abs(d.y)), abs(d.z)); // scaled so that no square overflows or vanishes
  float a = d.x - 2.0 * d.y + d.z;
  float h = d.y - d.x;
  float discriminant = h * h - a * d.x;
  if (!(discriminant > 0.0))
  {
    return vec2(1.0);
  }
  precise float q = -(h + (h < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
  float r0 = a != 0.0 ? q / a : 2.0;
  float r1 = q != 0.0 ? d.x / q : 2.0;
  r0 = r0 > 0.0 && r0 < 1.0 ? r0 : 1.0; // false also for NaN
  r1 = r1 > 0.0 && r1 < 1.0 ? r1 : 1.0;
  return vec2(min(r0, r1), max(r0, r1));
}

const float ROOT_RESOLUTION = 1.2e-7; // a float's, just below 1

// Refines the root in [low, high], where the sign changes, by Newton's method, from where the chord
// of the whole cubic vanishes within it, or else the middle: at an end that is zero the sign need
// not change. Bisects where a step would leave the bracket.
float RefineRoot(vec4 b, float low, float high, bool lowInside)
{
  precise float chord = b.x / (b.x - b.w);
  bool starts = high - low == 1.0 && chord > 0.0 && chord < 1.0;
  float s = starts ? chord : 0.5 * (low + high);
  for (int i = 0; i < 32; ++i)
  {
    float value = CubicValue(b, s);
    if (Inside(value) == lowInside)
    {
      low = s;
    }
    else
    {
      high = s;
    }
    precise float next = s - value / (3.0 * CubicSlope(b, s));
    bool stays = next >= low && next <= high; // a step that has converged ends at an end
    next = stays ? next : 0.5 * (low + high);
    if ((stays && abs(next - s) <= ROOT_RESOLUTION) || high - low <= ROOT_RESOLUTION)
    {
      return next;
    }
    s = next;
  }
  return s;
}

// The cubic's three monotonic pieces, parted by its extrema, and which of their ends are inside. If
// its coefficients change sides but once, it has one root, by Descartes' rule of signs: then all of
// it is the first piece, and the others are empty.
struct Pieces
{
  vec2 Turn;
  bvec4 Inside;
};

// False if the whole cubic is on one side, as its coefficients tell: it stays within their hull.
bool FindPieces(vec4 b, out Pieces pieces)
{
  bvec4 inside = greaterThanEqual(b, vec4(0.0));
  if (all(inside) || !any(inside))
  {
    return false;
  }
  bool once = inside.x != inside.w && (inside.y == inside.x || inside.z == inside.w);
  vec2 turn = once ? vec2(1.0) : Extrema(b);
  pieces.Turn = turn;
  pieces.Inside.x = inside.x;
  pieces.Inside.y = turn.x < 1.0 ? Inside(CubicValue(b, turn.x)) : inside.w;
  pieces.Inside.z = turn.y < 1.0 ? Inside(CubicValue(b, turn.y)) : inside.w;
  pieces.Inside.w = inside.w;
  return true;
}

// The first s in [0, 1] at which the surface is; negative if there is none.
float FirstTransition(vec4 b)
{
  Pieces at;
  if (!FindPieces(b, at))
  {
    return -1.0;
  }
  bvec4 inside = at.Inside;
  vec2 bracket = inside.y != inside.x ? vec2(0.0, at.Turn.x)
    : inside.z != inside.x                      ? at.Turn
                                                : vec2(at.Turn.y, 1.0);
  bool none = inside.y == inside.x && inside.z == inside.x && inside.w == inside.x;
  return none ? -1.0 : RefineRoot(b, bracket.x, bracket.y, inside.x);
}

#ifdef MANY_CROSSINGS
// The s on each of the three pieces; negative if there is none.
vec3 Transitions(vec4 b)
{
  vec3 s = vec3(-1.0);
  Pieces at;
  if (FindPieces(b, at))
  {
    bvec4 inside = at.Inside;
    s.x = inside.y != inside.x ? RefineRoot(b, 0.0, at.Turn.x, inside.x) : -1.0;
    s.y = inside.z != inside.y ? RefineRoot(b, at.Turn.x, at.Turn.y, inside.y) : -1.0;
    s.z = inside.w != inside.z ? RefineRoot(b, at.Turn.y, 1.0, inside.z) : -1.0;
  }
  return s;
}
#endif

// Tells whether the surface crosses the cell: some corners are inside, others are not.
bool StraddlesZero(Corners w)
{
  bvec4 low = greaterThanEqual(w.Low, vec4(0.0));
  bvec4 high = greaterThanEqual(w.High, vec4(0.0));
  return (any(low) || any(high)) && !(all(low) && all(high));
}
