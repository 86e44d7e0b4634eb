// Draws for a vtkHardwareSelector: identifiers of the prop or of the cells that were hit.

#include "Shared/Scene.glsl"
#include "Shared/Buffers.glsl"
#include "Rays/Rays.glsl"
#include "Surface/Hits.glsl"
#include "Output/WindowDepth.glsl"

uniform vec3 propColor;
uniform int cellIdPart; // 0: the prop's colour is drawn; 1, 2: low and high bits of a cell's id

layout(location = 0) out vec4 fragmentColor;

// 24 of the bits of VTK's number of the cell that holds the point at parameter t.
vec3 CellColor(uint pixel, float t, int part)
{
  ivec3 cells = volume.Samples - 1;
  ivec3 at = PlaceAt(LineOf(pixel), AtDepth(t)).High;
  uvec3 cell = uvec3(clamp(at, ivec3(0), cells - 1));
  uint row = cell.y + uint(cells.y) * cell.z;
  uint high, low, carry;
  umulExtended(row, uint(cells.x), high, low);
  low = uaddCarry(low, cell.x, carry);
  high += carry;
  uint bits = part == 1 ? low & 0xFFFFFFu : low >> 24 | (high & 0xFFFFu) << 8;
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
  fragmentColor = vec4(cellIdPart == 0 ? propColor : CellColor(pixel, t, cellIdPart), 1.0);
}
