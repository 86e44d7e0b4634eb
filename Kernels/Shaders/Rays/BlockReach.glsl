// The cells of a block's dual grid reach into the next block where they are the last on an axis. Does the ray
// pass through such ones, between parameters t0 and t1? Only then is the neighbour needed (section 3.4).
ivec3 DualGridReach(Ray ray, ivec3 block, double t0, double t1)
{
  dvec3 last = PlanesT(ray, 4 * block + 3);
  bvec3 forward = greaterThan(ray.Step, ivec3(0));
  ivec3 reached = ivec3(lessThanEqual(last, dvec3(t1))) * ivec3(forward) +
    ivec3(greaterThan(last, dvec3(t0))) * ivec3(not(forward));
  return min(reached, volume.Blocks - 1 - block);
}
