"""Hold every tolerance of tests, benchmarks and verification, each with its reason."""

from ..oracle.caster import Slack

# --- depth against the double-precision caster ----------------------------------------------------

#: Largest error of a clear ray's hit, in voxels along the ray.
DEPTH_VOXELS = 1e-4

#: Error relative to the depth, on top of `DEPTH_VOXELS`: the depth image is float32, and this is
#: half a unit in its last place.
DEPTH_RELATIVE = 2.0**-24

#: Error in voxels of the axis with the largest spacing, on top of both: rays are made of places in
#: steps of 2^-32 voxels, and of some sums and products of them. Where spacings differ a million
#: times it is a thousandth of a voxel of the smallest one, elsewhere nothing.
PLACE_VOXELS = 2.0**-29

#: What rounding may do to a sample. Its value may be off by this many units in the last place
#: (float32) of the largest difference from the isovalue, because the interpolant is a sum of eight
#: products. Its place may be off by this many voxels: rays are double, but coordinates within a
#: cell are float32 (6e-8), and a ray has 32 bits over 512 voxels. `Cast.early` and `Cast.late`
#: follow from both.
SLACK = Slack(value=8.0, position=1e-6)

#: A ray is clear, and must keep `DEPTH_VOXELS`, where the slack moves its hit by at most this many
#: voxels between early and late. Any other ray grazes: its depth must lie between early and late,
#: within `DEPTH_VOXELS`.
CLEAR_VOXELS = 1e-3

#: Largest part of the rays that may graze, so that grazing cannot hide a defect: of scans and
#: smooth fields ...
GRAZING_FRACTION = 0.02

#: ... of white noise, where every other cell holds a tangent ...
GRAZING_FRACTION_NOISE = 0.10

#: ... and where a view shows nothing but a singular point: rays through roots of second and third
#: order, which rounding cannot tell apart within a hundredth of a voxel.
GRAZING_FRACTION_SINGULAR = 0.03

# --- normals --------------------------------------------------------------------------------------

#: Largest angle to the gradient, in degrees, of a field whose central differences are its gradient:
#: 0.0037 are due to the packing into 2 x 16 bits (Cigolle et al. 2014), the rest to float32.
NORMAL_DEGREES = 0.004

#: Largest angle to central differences in double precision, in white noise ...
NORMAL_NOISE_DEGREES = 0.01

#: ... where the gradient is at least this part of the strongest one; below, rounding decides its
#: direction.
WEAK_GRADIENT = 0.01

#: Largest angle to the radius in degrees, times the square of the radius in voxels. The third
#: derivatives of a distance are at most 1.2 / r^2: a central difference is off by a sixth of them,
#: its interpolation between samples by an eighth for each axis, and r is smaller by up to two
#: voxels where the differences are taken.
NORMAL_SPHERE_DEGREES = 57.3 * 1.2 * (1 / 6 + 3 / 8) * 1.5

# --- values ---------------------------------------------------------------------------------------

#: Largest error of values in custom units, relative to their range, by float32 and 32 bits of zfp.
UNITS_RELATIVE = 2.0**-22

#: Largest difference of hits and gradients between two units, at 32 bits, of a field of about -1 to
#: 1 some tens of voxels wide: 1e-7 of the range at a slope of a hundredth of it a voxel, or less
#: where a ray grazes.
UNITS_DEPTH = 1e-4

# --- the caster itself ----------------------------------------------------------------------------

#: Largest error of double precision against a closed form, in world units, of a volume some ten
#: units wide.
ORACLE_EXACT = 1e-10

#: Largest distance in voxels from a sphere of radius 20 voxels, sampled as a distance: the
#: trilinear surface lies within h^2 / (8 r) * 3 of it.
ORACLE_SPHERE_VOXELS = 3 / (8 * 20.0)

# --- camera and geometry --------------------------------------------------------------------------

#: Largest relative difference of camera rays from VTK's own matrices, which are inverted on the
#: way.
CAMERA_RELATIVE = 1e-9

# --- images ---------------------------------------------------------------------------------------

#: Largest part of the pixels that may differ from a baseline by more than `IMAGE_LEVELS` grey
#: levels in some channel. Silhouettes move by a pixel between drivers; a missing block or a wrong
#: normal changes far more.
IMAGE_PIXELS = 0.005
IMAGE_LEVELS = 12

#: Largest mean difference over the whole image, in grey levels.
IMAGE_MEAN = 0.5

#: Largest difference between the images of several processes and of one. They decode the same
#: values and find the same hits, except for the last bits of a ray's coordinates, which count from
#: each piece's own corner. So every pixel is within a rounding of its colour ...
PROCESSES_LEVELS = 2

#: ... except for this part of the pixels, where a ray grazes the surface at a seam.
PROCESSES_PIXELS = 5e-5

#: Largest relative difference between the area of all processes' triangles and of one's:
#: coordinates are float32.
PROCESSES_AREA = 1e-6

#: Largest difference, in grey levels, between pictures of the same samples stored along other axes
#: or at another place within the blocks: hits and normals differ in the last bits of coordinates,
#: colours by a rounding.
LIE_LEVELS = 2

#: Largest part of the pixels that may differ from VTK's mapper by more than `VTK_LEVELS` grey
#: levels in some channel. Its hits are late by up to a twentieth of a voxel
#: (helpers.comparison.STEP), and it misses what is thinner: silhouettes and the edges of cuts move
#: by a pixel, for each of several translucent surfaces. With triangles they move as much.
VTK_PIXELS = 0.02
VTK_LEVELS = 10

#: Largest mean difference over the whole picture, in grey levels: one pixel in a hundred that
#: changes from surface to background is as much. Within a surface only roundings differ.
VTK_MEAN = 1.3

#: Largest difference, in grey levels, from the caster's layers, blended in double precision: ours
#: are kept in 16 bits a channel.
LAYERS_LEVELS = 2

#: Largest part of the pixels that may differ more: a ray that grazes a surface has a layer or two
#: more or less. In white noise every other cell holds such a tangent.
LAYERS_PIXELS = 1e-3

#: Largest mean difference, in grey levels, of a picture that went to a browser as JPEG: about 0.5
#: at a quality of 98 or 100; an image of a single pass is off by tens.
JPEG_MEAN = 2

# --- memory ---------------------------------------------------------------------------------------

#: Largest GPU memory beside the compressed stream and the cache.
BYTES_PER_BLOCK = 3
BYTES_PER_PIXEL = 40

# --- scenes ---------------------------------------------------------------------------------------

#: The depth buffer has 24 bits; two of them are lost in conversions.
DEPTH_BUFFER = 2.0**-22

#: Largest difference, in grey levels, of the light on a sampled sphere of 18 voxels' radius.
#: Normals taken within cells would be off by up to half a voxel in 18, 7 levels, at every face;
#: normals that jump at blocks would be worse.
SHADING_LEVELS = 4

#: Largest mean difference, in grey levels, from the surface's mesh, whose light is interpolated
#: across triangles half a voxel wide.
MESH_LIGHT_MEAN = 5

# --- benchmarks -----------------------------------------------------------------------------------

#: Largest errors of the depths of VTK's pictures, in voxels. A plane's mesh lies on it except for
#: single precision; the volume mapper's samples come from texture hardware that interpolates in
#: steps of 1/256 of a voxel.
MESH_DEPTH_VOXELS = 1e-3
TEXTURE_VOXELS = 1e-2

# --- long use -------------------------------------------------------------------------------------

#: Bytes that the process may grow by with each mapper that came and went, of the megabyte that it
#: held: fragments of the heap, and what a software renderer keeps. 350 were measured.
GROWTH_BYTES = 2000
