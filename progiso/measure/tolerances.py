"""Hold every tolerance of tests, benchmarks and verification, each with its reason."""

from ..oracle.caster import Slack

# --- depth against the double-precision caster ----------------------------------------------------

#: |dt| that the issue grants where a ray's profile clears the isovalue, in voxels along the ray.
DEPTH_VOXELS = 1e-4

#: The depth image is float32: half a unit in its last place, relative to the depth itself, comes on
#: top of `DEPTH_VOXELS`.
DEPTH_RELATIVE = 2.0**-24

#: What rounding may do to a sample: its value by this many units in the last place (float32) of the
#: largest difference from the isovalue at hand (the interpolant is a sum of eight products), its
#: place by this many voxels (rays are double, coordinates within a cell are float32: 6e-8; the rest
#: is room for a ray's own 32 bits over 512 voxels). `Cast.early` and `Cast.late` follow.
SLACK = Slack(value=8.0, position=1e-6)

#: A ray is clear, and held to `DEPTH_VOXELS`, where the slack moves its hit by at most this many
#: voxels between early and late. Any other ray grazes: its depth must lie between early and late,
#: give or take `DEPTH_VOXELS`.
CLEAR_VOXELS = 1e-3

#: So that the exemption cannot swallow a defect: at most this part of the rays that can hit may
#: graze, on scans and smooth fields ...
GRAZING_FRACTION = 0.02

#: ... and on white noise, where every other cell holds a tangent.
GRAZING_FRACTION_NOISE = 0.10

#: ... and where a view looks at nothing but a singular point of the field: rays through roots of
#: second and third order. Those within a hundredth of a voxel of it cannot be told from it.
GRAZING_FRACTION_SINGULAR = 0.03

# --- normals --------------------------------------------------------------------------------------

#: Angle to the gradient of a field whose central differences are its gradient, in degrees: 0.0037
#: for the packing into 2 x 16 bits (Cigolle et al. 2014), the rest for float32.
NORMAL_DEGREES = 0.004

#: In white noise, against central differences in double precision: the same where the gradient is
#: strong, and where it is weak ...
NORMAL_NOISE_DEGREES = 0.01

#: ... down to this part of the strongest one seen; below, rounding gives the direction.
WEAK_GRADIENT = 0.01

#: Angle to the radius, times the square of the radius in voxels. The third derivatives of a
#: distance are at most 1.2 / r^2: a central difference is off by a sixth of them, its interpolation
#: between samples by an eighth for each axis, and r is smaller by up to two voxels where the
#: differences are taken. In degrees.
NORMAL_SPHERE_DEGREES = 57.3 * 1.2 * (1 / 6 + 3 / 8) * 1.5

# --- values ---------------------------------------------------------------------------------------

#: What float32 and 32 bits of zfp leave of values in units of the stream's, against their range.
UNITS_RELATIVE = 2.0**-22

#: Hits and gradients of a field of about -1 to 1, some tens of voxels wide, in two units, at 32
#: bits: 1e-7 of the range at a slope of a hundredth of it a voxel, or less where a ray grazes.
UNITS_DEPTH = 1e-4

# --- the caster itself ----------------------------------------------------------------------------

#: Double precision against a closed form, in world units of a volume some ten units wide.
ORACLE_EXACT = 1e-10

#: A sphere of radius 20 voxels sampled as a distance: the trilinear surface lies within h^2 / (8 r)
#: * 3 of it.
ORACLE_SPHERE_VOXELS = 3 / (8 * 20.0)

# --- camera and geometry --------------------------------------------------------------------------

#: Camera rays against VTK's own matrices, which are inverted on the way.
CAMERA_RELATIVE = 1e-9

# --- images ---------------------------------------------------------------------------------------

#: Against a baseline: part of the pixels that may differ by more than `IMAGE_LEVELS` grey levels in
#: some channel. Silhouettes move by a pixel between drivers; a missing block or a wrong normal
#: changes far more.
IMAGE_PIXELS = 0.005
IMAGE_LEVELS = 12

#: Mean difference over the whole image, in grey levels.
IMAGE_MEAN = 0.5

#: The image that several processes make of their pieces against that of one: they decode the same
#: values and find the same hits but for the last bits of a ray's coordinates, which count from each
#: piece's own corner. So every pixel is within a rounding of its colour ...
PROCESSES_LEVELS = 2

#: ... but for this part of them, where a ray grazes the surface at a seam.
PROCESSES_PIXELS = 5e-5

#: The area of the triangles of all processes against that of one's, relative: coordinates are
#: float32.
PROCESSES_AREA = 1e-6

#: The picture of the same samples stored along other axes, or at another place within the blocks:
#: hits and normals are the same but for the last bits of coordinates, colours for a rounding, in
#: grey levels.
LIE_LEVELS = 2

#: Our picture against that of VTK's mapper, of the same samples: part of the pixels that may differ
#: by more than `VTK_LEVELS` grey levels in some channel. Its hits are late by up to a twentieth of
#: a voxel (helpers.comparison.STEP), and it misses what is thinner: silhouettes and the edges of
#: cuts move by a pixel, those of every one of several translucent surfaces. Triangles move them as
#: much.
VTK_PIXELS = 0.02
VTK_LEVELS = 10

#: Mean difference over the whole picture, in grey levels: one pixel in a hundred from surface to
#: background is as much. Within a surface colours, opacities and light are the same but for
#: roundings.
VTK_MEAN = 1.3

#: A picture of layers against the caster's, blended in double precision, in grey levels: the layers
#: are kept in 16 bits a channel.
LAYERS_LEVELS = 2

#: Part of the pixels where that may be off: a ray that grazes a surface has a layer, or two, more
#: or less. On white noise a cell in two holds such a tangent.
LAYERS_PIXELS = 1e-3

#: A picture that went to a browser as JPEG against the picture, mean grey levels: at a quality of
#: 98 or 100 it is off by about 0.5; an image of one pass alone by tens.
JPEG_MEAN = 2

# --- memory ---------------------------------------------------------------------------------------

#: GPU memory beside the compressed payload and the cache, as the issue bounds it.
BYTES_PER_BLOCK = 3
BYTES_PER_PIXEL = 40

# --- scenes ---------------------------------------------------------------------------------------

#: The depth buffer has 24 bits; two of them go to the conversions.
DEPTH_BUFFER = 2.0**-22

#: Light on a sampled sphere of 18 voxels' radius against that on the sphere: grey levels. Normals
#: taken within cells are off by up to half a voxel in 18, 7 levels, at every face; normals that
#: jump at blocks are worse.
SHADING_LEVELS = 4

#: The same surface beside its mesh, whose light is interpolated across triangles half a voxel wide:
#: mean grey levels.
MESH_LIGHT_MEAN = 5

# --- benchmarks -----------------------------------------------------------------------------------

#: Depths of VTK's pictures, in voxels: a plane's mesh lies on it but for single precision; the
#: volume mapper's samples come from texture hardware that interpolates in steps of 1/256 of a
#: voxel.
MESH_DEPTH_VOXELS = 1e-3
TEXTURE_VOXELS = 1e-2

# --- long use -------------------------------------------------------------------------------------

#: Bytes that the process grows by with each mapper that came and went, of the megabyte that it
#: held: the heap's fragments, and what a software renderer keeps. 350 were measured.
GROWTH_BYTES = 2000
