// Draws for a vtkHardwareSelector: a colour, or identifiers of the image's cells or points that
// were hit. A point is the corner nearest to the hit of the cell that holds it.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Surface/Hits.glsl"
#include "Output/WindowDepth.glsl"

uniform vec3 color;
uniform int idPart;        // 0: the colour is drawn; 1, 2: low and high bits of an id
uniform int ofPoints;      // 1: the id is a point's, 0: a cell's
uniform int isCentred;     // 1: samples lie in the centres of cells, 0: on points
uniform ivec3 firstSample; // the volume's, among the points or cells that have ids
uniform ivec3 ids;         // points or cells with ids on each axis

layout(location = 0) out vec4 fragmentColor;

// The point or cell of the image that belongs to parameter t of a pixel's ray.
uvec3 SelectedAt(uint pixel, float t)
{
  Wide3 place = PlaceAt(LineOf(pixel), AtDepth(t));
  // from the first point on
  ivec3 halves = 2 * HighOf(place) + ivec3(LowOf(place) >> 31) + isCentred;
  ivec3 at = firstSample + (halves + ofPoints >> 1);
  return uvec3(clamp(at, ivec3(0), ids - 1));
}

// 24 of the bits of VTK's number of it.
vec3 IdColor(uvec3 at)
{
  uint row = at.y + uint(ids.y) * at.z;
  uint high, low, carry;
  umulExtended(row, uint(ids.x), high, low);
  low = uaddCarry(low, at.x, carry);
  high += carry;
  uint bits = idPart == 1 ? low & 0xFFFFFFu : low >> 24 | (high & 0xFFFFu) << 8;
  return vec3(bits & 255u, bits >> 8 & 255u, bits >> 16 & 255u) / 255.0;
}

void main()
{
  uint pixel = FragmentPixel();
  if (HitKeyOf(pixel) == NO_HIT)
  {
    discard;
  }
  float t = DepthOf(pixel);
  gl_FragDepth = WindowDepth(t);
  fragmentColor = vec4(idPart == 0 ? color : IdColor(SelectedAt(pixel, t)), 1.0);
}
