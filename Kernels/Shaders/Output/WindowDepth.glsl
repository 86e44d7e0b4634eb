// Where a fragment is in the image, and how deep in the window.

uint FragmentPixel()
{
  ivec2 xy = ivec2(gl_FragCoord.xy) - scene.Image.zw;
  return uint(xy.y * scene.Image.x + xy.x);
}

float WindowDepth(float t)
{
  float z = (scene.DepthTerms.x + t * scene.DepthTerms.y) / (scene.DepthTerms.z + t * scene.DepthTerms.w);
  return clamp(0.5 * z + 0.5, 0.0, 1.0);
}
