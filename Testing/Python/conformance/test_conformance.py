"""The scenes of VTK's tests of its GPU volume mapper, as isosurfaces: our picture beside VTK's. See Testing/conformance.md."""

import re

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import reference, vtkAffineTypeFloat64Array
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction, vtkPlane, vtkUniformGrid
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkThreshold
from vtkmodules.vtkRenderingCore import vtkActor, vtkLightKit, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import (
    vtkCameraPass,
    vtkFramebufferPass,
    vtkLightsPass,
    vtkOpaquePass,
    vtkOpenGLFXAAPass,
    vtkOverlayPass,
    vtkRenderPassCollection,
    vtkRenderStepsPass,
    vtkSequencePass,
    vtkSSAAPass,
    vtkSSAOPass,
    vtkTextureObject,
    vtkTranslucentPass,
    vtkVolumetricPass,
)

import progiso
from helpers import TESTS
from helpers.comparison import (
    BACKGROUND,
    BLUE,
    GREEN,
    NESTED,
    OPAQUE,
    RED,
    SIZE,
    Stage,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    matrix_of,
    paint,
    picture_of,
    show,
)
from helpers.geometry import (
    CENTRE,
    MIRRORED,
    PLANES,
    REGIONS,
    SHAPE,
    STRETCHED,
    TURNED,
    ball,
    planes,
    wall,
)
from helpers.images import blobs, make_image, reference_volume
from helpers.layers import blend, capped, crossings_of
from helpers.messages import vtk_messages
from progiso.measure import tolerances
from progiso.oracle.caster import Camera


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs(SHAPE, 12, waves=2)), rate=16)


@pytest.fixture(scope="module")
def cube():
    """What is lit has as many samples along each axis: VTK's mapper stretches normals by their ratios, where a light is in the
    scene, and reaches for their differences one part in so many too far."""
    return progiso.compress(make_image(blobs((48, 48, 48), 12, waves=1)), rate=16)


# --- blanking ----------------------------------------------------------------------------------------------------------------


def blanked(kind):
    """An image in which much is hidden, by VTK's own means; `kind` is points, cells or cell data."""
    grid = vtkUniformGrid()
    grid.ShallowCopy(make_image(blobs(SHAPE, 12, waves=2), cells=kind == "cell data"))
    rng = np.random.default_rng(1)
    for corner in rng.integers(1, np.array(SHAPE[::-1]) - 6, (90, 3)):
        for offset in np.ndindex(5, 5, 5):
            if kind == "points":
                grid.BlankPoint(grid.ComputePointId(corner + offset))
            else:
                grid.BlankCell(grid.ComputeCellId(corner + offset))
    return grid


def visible_triangles(image):
    """VTK's triangles of the cells that VTK calls visible; of cell data, of those between the centres of such."""
    seen = np.array([image.IsCellVisible(i) for i in range(image.GetNumberOfCells())], bool)
    centres = image.GetCellData().GetArray("field")
    part = make_image(
        vtk_to_numpy(centres or image.GetPointData().GetArray("field")).reshape(SHAPE),
        origin=[bool(centres) / 2] * 3,
    )
    if centres:
        hidden = ~seen.reshape(SHAPE)
        corners = [
            hidden[tuple(slice(c, n - 1 + c) for c, n in zip(corner, SHAPE))]
            for corner in np.ndindex(2, 2, 2)
        ]
        seen = ~np.any(corners, axis=0).ravel()
    flags = numpy_to_vtk(seen.astype(float), deep=True)
    flags.SetName("visible")
    part.GetCellData().AddArray(flags)
    threshold, contour = vtkThreshold(), vtkContourFilter()
    threshold.SetInputData(part)
    threshold.SetInputArrayToProcess(0, 0, 0, 1, "visible")
    threshold.SetLowerThreshold(0.5)
    contour.SetInputConnection(threshold.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "field")
    contour.SetValue(0, 0.1)
    contour.Update()
    return contour.GetOutput()


@pytest.mark.parametrize("kind", ["points", "cells", "cell data"])
def test_blanking(kind):
    """VTK's mapper leaves out half a voxel more around what is hidden, so VTK's triangles are the reference."""
    grid = blanked(kind)
    ours, theirs = Stage(True), Stage(False)
    compressed = progiso.compress(grid, rate=24)
    show(ours, compressed)
    mapper, actor = vtkPolyDataMapper(), vtkActor()
    mapper.SetInputData(visible_triangles(grid))
    mapper.ScalarVisibilityOff()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(GREEN)
    actor.GetProperty().LightingOff()
    theirs.renderer.AddActor(actor)
    theirs.look_at(compressed)
    picture = ours.picture()
    check_like_vtk(picture, theirs.picture())
    whole = Stage(True)
    show(
        whole,
        progiso.compress(make_image(blobs(SHAPE, 12, waves=2), cells=kind == "cell data"), rate=24),
    )
    assert far_apart(picture, whole.picture())[0] > 2 * tolerances.VTK_PIXELS, (
        "hardly anything that is seen is hidden"
    )


def test_the_mapper_takes_a_uniform_grid_itself():
    grid = blanked("points")
    pictures = []
    for image in (grid, progiso.compress(grid, rate=24)):
        stage = Stage(True)
        stage.add(image, OPAQUE, Rate=24)
        stage.look_at(progiso.compress(grid, rate=24))
        pictures.append(stage.picture())
    assert np.array_equal(*pictures)


# --- isovalues, colours, opacities -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "surfaces",
    [
        {0.1: (*RED, 1.0)},
        {-0.4: (*RED, 1.0), 0.1: (*GREEN, 1.0)},
        {-0.4: (*RED, 0.2), 0.1: (*GREEN, 1.0), 0.6: (*BLUE, 0.6)},
        {-0.4: (*RED, 0.0), 0.1: (*GREEN, 0.5), 0.6: (*BLUE, 1.0)},
        {-0.6 + 0.2 * i: (i / 6, 0.5, 1 - i / 6, 0.1 + 0.1 * i) for i in range(7)},
    ],
)
def test_isovalues_and_opacities(image, surfaces):
    check_scene_like_vtk(lambda stage: show(stage, image, surfaces))


def test_isovalues_change(image):
    """One surface, none, three: as often as the property says."""
    stages = both(lambda stage: show(stage, image))
    for surfaces in (OPAQUE, NESTED, OPAQUE):
        for stage in stages:
            paint(stage.volumes[0], surfaces)
        check_like_vtk(*(stage.picture() for stage in stages))
    stages[0].volumes[0].GetProperty().GetIsoSurfaceValues().SetNumberOfContours(0)
    assert np.ptp(stages[0].picture().reshape(-1, 3), axis=0).max() == 0


def test_grey_transfer_function(image):
    """VTK's GPU mapper takes no notice of it; the surface has the grey of its isovalue."""
    stage = Stage(True)
    grey = vtkPiecewiseFunction()
    grey.AddPoint(-1, 0.1)
    grey.AddPoint(1, 0.9)
    show(stage, image).GetProperty().SetColor(grey)
    picture = stage.picture()
    hit = np.isfinite(progiso.depth(stage.mapper))
    assert hit.mean() > 0.2
    assert np.abs(picture[hit] - 255 * (0.5 + 0.4 * 0.1)).max() <= 1


def test_a_narrow_colour_is_not_smeared():
    """Colours come from the functions themselves, not from a table over the range of values."""
    values = 1e4 * blobs(SHAPE, 12, waves=2)
    stage = Stage(True)
    show(
        stage,
        progiso.compress(make_image(values), rate=24),
        {999.0: (*RED, 1.0), 1000.0: (*GREEN, 1.0), 1001.0: (*BLUE, 1.0)},
    )
    picture = stage.picture()[np.isfinite(progiso.depth(stage.mapper))]
    shares = [
        (np.abs(picture - 255 * np.array(rgb)).max(axis=1) <= 1).mean()
        for rgb in (RED, GREEN, BLUE)
    ]
    assert sum(shares) == 1 and min(shares[0], shares[2]) > 0.2


# --- other things in the scene -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("share", [0.3, 0.85, 1.0, 1.15, 1.8])
def test_opaque_geometry(image, surfaces, share):
    """Before, between and behind the surfaces."""

    def build(stage):
        show(stage, image, surfaces)
        stage.renderer.AddActor(wall(stage.camera, share))

    check_scene_like_vtk(build)


@pytest.mark.parametrize("radius", [6, 12, 17])
def test_opaque_geometry_comes_and_goes(image, radius):
    """Also a change that the volume takes no part in restarts a translucent picture."""
    stages = both(lambda stage: show(stage, image, NESTED))
    bare = stages[0].picture()
    balls = [ball(radius), ball(radius)]
    for stage, actor in zip(stages, balls):
        stage.renderer.AddActor(actor)
    check_like_vtk(*(stage.picture() for stage in stages))
    for actor in balls:
        actor.SetPosition(5, 5, 5)
    check_like_vtk(*(stage.picture() for stage in stages))
    for actor in balls:
        actor.VisibilityOff()
    assert np.array_equal(stages[0].picture(), bare)


@pytest.mark.parametrize("peels", [False, True])
def test_invisible_geometry_leaves_no_trace(image, peels):
    """A sphere of opacity 0 across the surface."""
    plain, stage = Stage(True), Stage(True)
    for scene in (plain, stage):
        show(scene, image, NESTED if peels else OPAQUE)
        scene.peel(peels)
    stage.renderer.AddActor(ball(11, opacity=0.0))
    assert far_apart(stage.picture(), plain.picture())[0] == 0


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_several_volumes(image, surfaces):
    """Two volumes apart, each with its mapper, and each with its place and colours."""
    other = {0.2: (*BLUE, next(iter(surfaces.values()))[3])}

    def build(stage):
        stage.add(image, surfaces)
        place = np.eye(4)
        place[:3, 3] = 30, 0, 0
        stage.add(image, other, matrix=place)
        stage.look_at(image, 2, distance=2.5)

    check_scene_like_vtk(build)


def test_volumes_are_added_and_removed(image):
    def build(stage):
        stage.add(image, OPAQUE)
        stage.add(image, {0.1: (*RED, 1.0)}, matrix=np.diag([-1, 1, 1, 1]))
        stage.look_at(image, 1, distance=2.5)

    stages = both(build)
    for change in ("RemoveVolume", "AddVolume"):
        for stage in stages:
            getattr(stage.renderer, change)(stage.volumes[1])
        check_like_vtk(*(stage.picture() for stage in stages))


def test_overlapping_opaque_volumes(image):
    """Opaque surfaces of two volumes hide each other by depth; VTK's mapper has vtkMultiVolume for that: against the caster's."""
    half = np.eye(4)
    half[:3, 3] = 6, 4, 2
    stage = Stage(True)
    stage.add(image, OPAQUE)
    stage.add(image, {0.1: (*RED, 1.0)}, matrix=half)
    stage.look_at(image, 1)
    stage.render()
    depths = [progiso.depth(volume.GetMapper()) for volume in stage.volumes]
    picture = picture_of(stage.window)
    reds = picture[..., 0] > picture[..., 1]
    clear = np.isfinite(depths[0]) & np.isfinite(depths[1])
    clear[clear] = np.abs(depths[0][clear] - depths[1][clear]) > 1e-2
    assert clear.sum() > 1000 and 100 < reds[clear].sum() < clear.sum() - 100
    assert np.array_equal(reds[clear], (depths[1] < depths[0])[clear])


# --- clipping and cropping ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize(
    "normals", [[(1, 0, 0)], [(0.6, -0.5, 0.3)], [(1, 0.2, 0), (0, -1, 0.4), (0.1, 0, 1)]]
)
@pytest.mark.parametrize("matrix", [None, TURNED @ STRETCHED])
def test_clipping_planes(image, surfaces, normals, matrix):
    def build(stage):
        volume = show(stage, image, surfaces, matrix=matrix)
        for plane in planes(*normals):
            volume.GetMapper().AddClippingPlane(plane)

    check_scene_like_vtk(build)


def test_a_clipping_plane_moves(image):
    """Also by a change of the plane itself, which the mapper is not told of."""
    cutters = [next(planes((1, 0, 0))) for _ in range(2)]
    stages = both(lambda stage: show(stage, image))
    first = stages[0].picture()
    for stage, cutter in zip(stages, cutters):
        stage.mapper.AddClippingPlane(cutter)
        cutter.SetNormal(0, -1, 0)
    for origin in (CENTRE, CENTRE + 5):
        for cutter in cutters:
            cutter.SetOrigin(origin)
        check_like_vtk(*(stage.picture() for stage in stages))
    stages[0].mapper.RemoveAllClippingPlanes()
    assert np.array_equal(stages[0].picture(), first)


def test_clipped_and_lit(cube):
    """The normals at a cut are those of the whole volume."""

    def build(stage):
        volume = shaded(stage, cube)
        volume.GetMapper().AddClippingPlane(next(planes((1, 0.3, 0))))
        stage.shine()

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("regions", REGIONS)
def test_cropping(image, regions, surfaces):
    """Where a ray comes into a region from outside VTK's mapper may show a surface that is not there: that does not count."""

    def build(stage):
        mapper = show(stage, image, surfaces).GetMapper()
        mapper.CroppingOn()
        mapper.SetCroppingRegionPlanes(PLANES)
        mapper.SetCroppingRegionFlags(REGIONS[regions])

    stages = both(build)
    pictures = [stage.picture() for stage in stages]
    camera = Camera.from_vtk(stages[0].camera)
    caps = capped(reference_volume(image), list(surfaces), camera, SIZE, (PLANES, REGIONS[regions]))
    assert caps.mean() < 0.3
    check_like_vtk(*pictures, beside=caps)


def test_cropping_and_clipping_of_a_moved_volume(image):
    """The regions turn with the volume, the clipping plane stays: by the caster's crossings."""
    stage = Stage(True)
    mapper = show(stage, image, NESTED, matrix=TURNED).GetMapper()
    mapper.CroppingOn()
    mapper.SetCroppingRegionPlanes(PLANES)
    mapper.SetCroppingRegionFlags(REGIONS["inverted cross"])
    plane = next(planes((0.5, 1, 0)))
    mapper.AddClippingPlane(plane)
    picture = stage.picture()
    camera, volume = Camera.from_vtk(stage.camera), reference_volume(image, TURNED)
    crossings = crossings_of(
        volume, list(NESTED), camera, SIZE, cropping=(PLANES, REGIONS["inverted cross"])
    )
    origins, directions = camera.rays(SIZE)
    world = origins[crossings.ray] + crossings.depth[:, None] * directions[crossings.ray]
    crossings = crossings.only((world - plane.GetOrigin()) @ np.array(plane.GetNormal()) > 0)
    model = blend(crossings, list(NESTED.values()), BACKGROUND, SIZE)
    assert (
        np.abs(picture - model).max(axis=2) > tolerances.LAYERS_LEVELS
    ).mean() <= tolerances.LAYERS_PIXELS


# --- where the volume is, and the camera -------------------------------------------------------------------------------------


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("matrix", [TURNED, STRETCHED, MIRRORED, TURNED @ STRETCHED @ MIRRORED])
def test_user_matrix(image, matrix, surfaces):
    check_scene_like_vtk(lambda stage: show(stage, image, surfaces, matrix=matrix))


@pytest.mark.parametrize("matrix", [TURNED, STRETCHED, MIRRORED, TURNED @ STRETCHED @ MIRRORED])
def test_user_matrix_and_light(cube, matrix):
    """Beside triangles, of which the side towards the camera alone is lit: VTK's mapper does not turn normals as planes."""
    ours, theirs = Stage(True), Stage(False)
    shaded(ours, cube, matrix=matrix)
    look = theirs.add_mesh(cube, OPAQUE, matrix).GetProperty()
    look.LightingOn()
    look.SetAmbient(0)
    look.SetDiffuse(0.7)
    for stage in (ours, theirs):
        stage.shine(position=(60, 80, 30))
    pictures = ours.picture(), theirs.picture()
    check_like_vtk(*pictures, beside=pictures[1][..., 1] < 30)


@pytest.mark.parametrize("spacing", [(1, 1, 1), (0.5, 2, 1)])
def test_oriented_image(spacing):
    """A direction matrix, an origin, and an extent that does not begin at 0."""
    direction = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    values = make_image(
        blobs(SHAPE, 12, waves=2),
        origin=(3, -4, 5),
        spacing=spacing,
        direction=direction,
        extent_start=(2, -7, 4),
    )
    compressed = progiso.compress(values, rate=16)
    check_scene_like_vtk(lambda stage: show(stage, compressed, NESTED))


def test_from_perspective_to_parallel(image):
    stages = both(lambda stage: show(stage, image, NESTED))
    pictures = [stages[0].picture()]
    for stage in stages:
        stage.camera.ParallelProjectionOn()
        stage.camera.SetParallelScale(18)
    pictures.append(stages[0].picture())
    check_like_vtk(pictures[1], stages[1].picture())
    assert not np.array_equal(*pictures)


@pytest.mark.parametrize(
    "spacing, matrix, angle",
    [
        ((1, 1, 1), None, 60),
        ((1e-3, 1e-3, 1e-3), None, 60),
        ((1, 1, 1), TURNED, 60),
        ((1, 1, 1), STRETCHED, 60),
    ],
)
@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_camera_inside(spacing, matrix, angle, surfaces):
    compressed = progiso.compress(make_image(blobs(SHAPE, 12, waves=2), spacing=spacing), rate=16)
    place = np.append(CENTRE * spacing, 1)
    moved = np.eye(4) if matrix is None else matrix
    eye, focus = (moved @ (place + [*np.array(d) * spacing, 0]) for d in ((2, 3, 1), (9, 6, -4)))

    def build(stage):
        stage.add(compressed, surfaces, matrix=matrix)
        stage.camera.SetPosition(eye[:3])
        stage.camera.SetFocalPoint(focus[:3])
        stage.camera.SetViewAngle(angle)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_near_plane_cuts_the_volume(image, surfaces):
    """The camera is outside. VTK's mapper moves the plane by a part of the range: what is that close to it does not count."""
    stages = both(lambda stage: show(stage, image, surfaces))
    for stage in stages:
        stage.clipping_range = 40, 70
    pictures = [stage.picture() for stage in stages]
    ahead = progiso.depth(stages[0].mapper) * np.cos(np.radians(25))  # at least
    check_like_vtk(*pictures, beside=ahead < 40.2)
    whole = Stage(True)
    show(whole, image, surfaces)
    assert far_apart(whole.picture(), pictures[0])[0] > 0.05


def test_model_transform(image):
    """The camera's own model transform, and a change of it."""
    stages = both(lambda stage: show(stage, image, NESTED))
    first = stages[0].picture()
    for stage in stages:
        stage.camera.SetModelTransformMatrix(matrix_of(TURNED))
    picture = stages[0].picture()
    check_like_vtk(picture, stages[1].picture())
    assert not np.array_equal(picture, first)


# --- windows -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_viewports(image, surfaces):
    """Two renderers show the same volume from two sides: one mapper serves both. The other two have something else."""

    def build(stage):
        show(stage, image, surfaces)
        stage.renderer.SetViewport(0.5, 0.0, 1.0, 0.5)
        for corner in ((0, 0), (0.5, 0.5), (0, 0.5)):
            other = vtkRenderer()
            other.SetViewport(*corner, corner[0] + 0.5, corner[1] + 0.5)
            other.SetBackground(0.3, 0.2, 0.2)
            stage.window.AddRenderer(other)
            if corner == (0, 0):
                other.AddActor(ball(10))  # hides nothing in the other viewports
            else:
                other.AddVolume(stage.volumes[0])
                stage.look_at(image, int(4 * corner[0]), camera=other.GetActiveCamera())
            other.ResetCameraClippingRange() if corner != (0, 0) else other.ResetCamera()

    check_scene_like_vtk(build, size=(240, 200))


def test_several_windows(image):
    """Each window with its own mapper of the same image; and one mapper that goes from window to window."""
    stages = [Stage(True), Stage(True)]
    for stage in stages:
        show(stage, image, NESTED)
    pictures = [stage.picture() for stage in stages for _ in range(2)]
    assert all(np.array_equal(pictures[0], picture) for picture in pictures)
    wanderer = stages[0].volumes[0]
    for stage in stages:
        stage.renderer.RemoveAllViewProps()
    for stage in (stages[1], stages[0], stages[1]):
        stage.renderer.AddVolume(wanderer)
        stage.render()
        assert np.array_equal(picture_of(stage.window), pictures[0])
        stage.renderer.RemoveVolume(wanderer)


def test_window_resize(image):
    stages = both(lambda stage: show(stage, image, NESTED))
    for size in ((160, 128), (90, 130), (200, 70)):
        for stage in stages:
            stage.window.SetSize(*size)
        pictures = [stage.picture() for stage in stages]
        assert pictures[0].shape == (size[1], size[0], 3)
        check_like_vtk(*pictures)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_multisampling(image, surfaces):
    """With opaque geometry, whose depth comes out of the multisampled framebuffer."""

    def build(stage):
        show(stage, image, surfaces)
        stage.renderer.AddActor(ball(11))

    ours, _, picture = check_scene_like_vtk(build, samples=8)
    plain = Stage(True)
    build(plain)
    assert not np.array_equal(picture, plain.picture())  # the sphere's edges are smooth


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize(
    "kind", ["CrystalEyes", "Left", "Right", "Anaglyph", "SplitViewportHorizontal"]
)
def test_stereo(cube, surfaces, kind):
    """Beside triangles: VTK's mapper has an eye's rays go on within the volume as from between the eyes."""
    ours, theirs, mono = Stage(True), Stage(False), Stage(True)
    show(ours, cube, surfaces)
    theirs.add_mesh(cube, surfaces)
    show(mono, cube, surfaces)
    for stage in (ours, theirs):
        stage.camera.SetEyeAngle(15)  # so that what shears the rays shows
        stage.window.StereoCapableWindowOn()
        stage.window.StereoRenderOn()
        getattr(stage.window, "SetStereoTypeTo" + kind)()
    pictures = ours.picture(), theirs.picture()
    check_like_vtk(*pictures)
    assert far_apart(mono.picture(), pictures[0])[0] > 1.5 * tolerances.VTK_PIXELS


# --- passes ------------------------------------------------------------------------------------------------------------------


def test_depth_peeling(image):
    """Translucent geometry, before, within and behind an opaque isosurface; VTK's needs to be peeled with it."""

    def build(stage):
        show(stage, image)
        stage.peel(not stage.ours)
        stage.renderer.AddActor(ball(13, RED, 0.4))
        stage.renderer.AddActor(ball(9, BLUE, 0.5, CENTRE + 4))

    _, theirs, picture = check_scene_like_vtk(build)
    ours = Stage(True)
    build(ours)
    ours.renderer.UseDepthPeelingForVolumesOn()
    assert np.array_equal(ours.picture(), picture)


def test_depth_peeling_and_clipping(image):
    def build(stage):
        show(stage, image).GetMapper().AddClippingPlane(next(planes((1, 0.2, 0))))
        stage.peel(not stage.ours)
        stage.renderer.AddActor(ball(13, RED, 0.4))
        stage.renderer.AddActor(ball(6))

    check_scene_like_vtk(build)


@pytest.mark.parametrize("for_volumes", [False, True])
def test_translucent_surfaces_cover_translucent_geometry(image, for_volumes):
    """A translucent isosurface is drawn over translucent geometry, peeled or not, as VTK's without peeling of volumes."""

    def build(stage):
        show(stage, image, NESTED)
        stage.peel(for_volumes and stage.ours)
        stage.renderer.AddActor(ball(13, RED, 0.4))

    check_scene_like_vtk(build)


def passes(*kinds):
    """A sequence of render passes under a camera pass."""
    collection, sequence, camera = vtkRenderPassCollection(), vtkSequencePass(), vtkCameraPass()
    for kind in kinds:
        collection.AddItem(kind())
    sequence.SetPasses(collection)
    camera.SetDelegatePass(sequence)
    return camera


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_render_passes(image, surfaces):
    """A sequence of passes makes the same picture as the renderer."""

    def build(stage):
        show(stage, image, surfaces)
        stage.renderer.AddActor(ball(11))

    def build_by_passes(stage):
        build(stage)
        sequence = passes(
            vtkLightsPass, vtkOpaquePass, vtkTranslucentPass, vtkVolumetricPass, vtkOverlayPass
        )
        stage.renderer.SetPass(sequence)

    plain = Stage(True)
    build(plain)
    _, _, picture = check_scene_like_vtk(build_by_passes)
    assert np.array_equal(picture, plain.picture())


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("depths", ["Fixed16", "Fixed24", "Fixed32", "Float32"])
def test_depth_formats(image, surfaces, depths):
    """In a framebuffer of a pass, whatever its depths are kept in; VTK's mapper would have to be told."""
    plain, stage = Stage(True), Stage(True)
    for scene in (plain, stage):
        show(scene, image, surfaces)
        scene.renderer.AddActor(ball(11))
    frame = vtkFramebufferPass()
    frame.SetDepthFormat(getattr(vtkTextureObject, depths))
    frame.SetDelegatePass(
        passes(vtkLightsPass, vtkOpaquePass, vtkTranslucentPass, vtkVolumetricPass)
    )
    stage.renderer.SetPass(frame)
    check_like_vtk(stage.picture(), plain.picture())


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_fxaa(image, surfaces):
    def build(stage):
        show(stage, image, surfaces)
        stage.renderer.AddActor(ball(11))
        smooth = vtkOpenGLFXAAPass()
        smooth.SetDelegatePass(vtkRenderStepsPass())
        stage.renderer.SetPass(smooth)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_supersampling(image, surfaces):
    """The pass draws into a framebuffer larger than the window; VTK's mapper shows no isosurface in it."""
    plain, stage = Stage(True), Stage(True)
    for scene in (plain, stage):
        show(scene, image, surfaces)
        scene.renderer.AddActor(ball(11))
    fine = vtkSSAAPass()
    fine.SetDelegatePass(vtkRenderStepsPass())
    stage.renderer.SetPass(fine)
    apart = np.abs(stage.picture() - plain.picture()).max(axis=2)
    assert 0.002 < (apart > 20).mean() < 0.1, "edges are blended"
    assert (apart <= 2).mean() > 0.75, "the rest is the same"
    found = []
    for scene in (plain, stage):
        position, isovalue = [0.0] * 3, reference(0.0)
        assert scene.mapper.GetHit(80, 64, position, isovalue)
        found.append((*position, isovalue.get()))
    assert found[0] == pytest.approx(found[1], abs=0.5)


def occluded(stage):
    dark = vtkSSAOPass()
    dark.SetRadius(6)
    dark.SetKernelSize(64)
    dark.SetBias(0.05)
    dark.SetDelegatePass(vtkRenderStepsPass())
    stage.renderer.SetPass(dark)


def test_ambient_occlusion(cube):
    """The pass darkens the isosurface as it does the same surface in triangles (VTK's mapper shows none in it)."""
    ours, theirs = Stage(True), Stage(True)
    shaded(ours, cube)
    look = theirs.add_mesh(cube, OPAQUE).GetProperty()
    look.LightingOn()
    look.SetAmbient(0)
    look.SetDiffuse(0.7)
    bright, dark = [], []
    for stage in (ours, theirs):
        stage.renderer.AddActor(ball(11))
        bright.append(stage.picture())
        occluded(stage)
        dark.append(stage.picture())
    hit = np.isfinite(progiso.depth(ours.mapper))
    mine, triangles = ((a - b)[hit] for a, b in zip(bright, dark))
    assert triangles.mean() > 2 and np.corrcoef(mine.ravel(), triangles.ravel())[0, 1] > 0.9
    assert abs(mine.mean() - triangles.mean()) < 0.1 * triangles.mean()


def test_ambient_occlusion_of_an_unlit_surface(cube):
    """It has no normals: it counts as turned to the viewer, and is darker the more it is not."""
    stage = Stage(True)
    show(stage, cube)
    stage.renderer.AddActor(ball(11))
    bright = stage.picture()
    occluded(stage)
    with vtk_messages() as messages:  # VTK says that it wants shaded volumes
        darker = (bright - stage.picture())[np.isfinite(progiso.depth(stage.mapper))].max(axis=1)
    assert len(messages) == 1
    assert 0.1 < (darker > 20).mean() < 0.9 and darker.mean() < 80


def test_translucent_surfaces_occlude_nothing(image):
    """They are no place for shadows to fall: the sphere behind has its own."""
    stage = Stage(True)
    show(stage, image, NESTED)
    stage.renderer.AddActor(ball(11))
    plain = stage.picture()
    occluded(stage)
    assert far_apart(stage.picture(), plain)[0] < 0.2


# --- data --------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_cell_data(surfaces):
    """Values of cells are samples at their centres; VTK's draws them to the cells' outer faces, ours between the centres."""
    compressed = progiso.compress(
        make_image(blobs(SHAPE, 12, waves=2), cells=True, spacing=(1, 1.5, 1)), rate=16
    )

    def build(stage):
        mapper = show(stage, compressed, surfaces).GetMapper()
        for axis in range(3):
            for side in (1, -1):
                plane = vtkPlane()
                low, high = compressed.GetBounds()[2 * axis : 2 * axis + 2]
                plane.SetOrigin(*(low + 1.6 if side > 0 else high - 1.6 for _ in range(3)))
                plane.SetNormal(*(side * (axis == other) for other in range(3)))
                mapper.AddClippingPlane(plane)

    check_scene_like_vtk(build)


@pytest.mark.parametrize(
    "kind",
    [
        "uint8",
        "int8",
        "uint16",
        "int16",
        "uint32",
        "int32",
        "uint64",
        "int64",
        "float32",
        "float64",
    ],
)
def test_data_types(kind):
    values = (60 + 50 * np.clip(blobs(SHAPE, 12, waves=2), -1, 1)).astype(kind)
    compressed = progiso.compress(make_image(values), rate=16)
    check_scene_like_vtk(lambda stage: show(stage, compressed, {65: (*GREEN, 1.0)}))


def several(stage, arrays, component=None):
    """A stage's volume of a plain image with these point arrays, the first of them active."""
    plain = make_image(next(iter(arrays.values())), name=next(iter(arrays)))
    for name, values in arrays.items():
        plain.GetPointData().AddArray(make_image(values, name=name).GetPointData().GetScalars())
    volume = stage.add(progiso.compress(make_image(blobs(SHAPE, 1)), rate=4), OPAQUE)
    volume.GetMapper().SetInputData(plain)
    stage.look_at(plain_geometry())
    return volume


def plain_geometry():
    return progiso.compress(make_image(np.zeros(SHAPE, np.float32)), rate=4)


def test_changed_array():
    """Another array of the same input, by the mapper's scalar mode."""
    arrays = {"one": blobs(SHAPE, 12, waves=2), "two": blobs(SHAPE, 5, waves=2)}

    stages = both(lambda stage: several(stage, arrays))
    pictures = []
    for name in ("one", "two", "one"):
        for stage in stages:
            stage.mapper.SetScalarModeToUsePointFieldData()
            stage.mapper.SelectScalarArray(name)
        pictures.append(stages[0].picture())
        check_like_vtk(pictures[-1], stages[1].picture())
    assert np.array_equal(pictures[0], pictures[2]) and not np.array_equal(pictures[0], pictures[1])


def test_implicit_array():
    """Samples that are computed as they are read."""
    affine = vtkAffineTypeFloat64Array()
    affine.ConstructBackend(2 / (np.prod(SHAPE) - 1), -1.0)
    affine.SetNumberOfComponents(1)
    affine.SetNumberOfTuples(int(np.prod(SHAPE)))
    affine.SetName("implicit")
    stages = Stage(True), Stage(True)
    for stage in stages:
        several(stage, {"s": np.zeros(SHAPE, np.float32)})
    explicit = make_image(np.linspace(-1, 1, int(np.prod(SHAPE)), dtype=np.float64).reshape(SHAPE))
    implicit = make_image(np.zeros(SHAPE))
    implicit.GetPointData().SetScalars(affine)
    stages[0].mapper.SetInputData(explicit)
    stages[1].mapper.SetInputData(implicit)
    pictures = [stage.picture() for stage in stages]
    assert np.isfinite(progiso.depth(stages[0].mapper)).mean() > 0.1
    assert far_apart(*pictures)[0] <= tolerances.VTK_PIXELS


def test_component():
    """A component of vectors."""
    vectors = np.stack([blobs(SHAPE, seed, waves=2) for seed in (3, 12, 5)], axis=-1)
    picture, alone = Stage(True), Stage(True)
    several(picture, {"v": vectors}).GetMapper().SetComponent(1)
    several(alone, {"s": vectors[..., 1]})
    assert np.array_equal(picture.picture(), alone.picture())
    check_like_vtk(picture.picture(), several_of_vtk(vectors[..., 1]))


def several_of_vtk(values):
    stage = Stage(False)
    several(stage, {"s": values})
    return stage.picture()


def test_time_series():
    """Another image at the input, and another time of the same image object."""
    steps = [
        progiso.compress(make_image(blobs(SHAPE, seed, waves=2)), rate=16) for seed in (12, 5, 12)
    ]
    stages = both(lambda stage: show(stage, steps[0]))
    pictures = []
    for step in steps:
        for stage in stages:
            stage.feed(stage.mapper, step)
        pictures.append(stages[0].picture())
        check_like_vtk(pictures[-1], stages[1].picture())
    assert np.array_equal(pictures[0], pictures[2]) and not np.array_equal(pictures[0], pictures[1])


def test_values_change_in_place():
    """A plain image whose samples change, and say so, is drawn anew."""
    plain = make_image(blobs(SHAPE, 12, waves=2))
    other = make_image(blobs(SHAPE, 5, waves=2))
    stage = Stage(True)
    several(stage, {"s": blobs(SHAPE, 12, waves=2)}).GetMapper().SetInputData(plain)
    first = stage.picture()
    plain.GetPointData().GetScalars().DeepCopy(other.GetPointData().GetScalars())
    plain.GetPointData().GetScalars().Modified()
    plain.Modified()
    assert not np.array_equal(stage.picture(), first)
    check_like_vtk(stage.picture(), several_of_vtk(blobs(SHAPE, 5, waves=2)))


# --- light -------------------------------------------------------------------------------------------------------------------


def shaded(stage, image, surfaces=OPAQUE, specular=0.0, **settings):
    """Without ambient light: where a light is in the scene VTK's mapper has that of the lights, on no colour of the surface."""
    volume = show(stage, image, surfaces, **settings)
    look = volume.GetProperty()
    look.ShadeOn()
    look.SetAmbient(0.0)
    look.SetDiffuse(0.7)
    look.SetSpecular(specular)
    look.SetSpecularPower(8)
    return volume


def test_ambient_light_only(image):
    def build(stage):
        look = show(stage, image, NESTED).GetProperty()
        look.ShadeOn()
        look.SetAmbient(0.6)
        look.SetDiffuse(0)
        look.SetSpecular(0)

    check_scene_like_vtk(build)


def directional(stage):
    stage.shine()


def two_coloured(stage):
    stage.shine((1, 0.3, 0.2)).SetIntensity(0.7)
    stage.shine((0.2, 0.5, 1), position=(-50, 70, 90)).SetIntensity(0.6)


def positional(stage):
    light = stage.shine(position=(30, 40, 55))
    light.PositionalOn()
    light.SetConeAngle(180)
    return light


def attenuated(stage):
    positional(stage).SetAttenuationValues(0.2, 0.02, 0.0005)


def spot(stage):
    light = stage.shine(position=(50, 60, 75), focus=(24, 24, 24))
    light.PositionalOn()
    light.SetConeAngle(20)
    light.SetExponent(3)


def camera_light(stage):
    stage.shine(position=(0.6, 0.7, 1), focus=(0, 0, 0)).SetLightTypeToCameraLight()


def switched(stage):
    stage.shine()
    stage.shine((1, 0, 0), position=(0, -50, 0)).SwitchOff()


def many(stage):
    for i in range(12):
        angle = 2 * np.pi * i / 12
        stage.shine(
            (i % 2, i % 3 / 2, 1), position=(60 * np.cos(angle), 60 * np.sin(angle), 40)
        ).SetIntensity(0.2)


def light_kit(stage):
    stage.renderer.AutomaticLightCreationOff()
    stage.kit = vtkLightKit()
    stage.kit.AddLightsToRenderer(stage.renderer)
    stage.kit.Update()


LIGHTS = [
    directional,
    two_coloured,
    positional,
    attenuated,
    spot,
    camera_light,
    switched,
    many,
    light_kit,
]


@pytest.mark.parametrize("two_sided", [True, False])
@pytest.mark.parametrize("lights", LIGHTS, ids=lambda lights: lights.__name__)
def test_lights(cube, lights, two_sided):
    """Lights of each kind. Both sides are lit, or just the one where the values are lower."""

    def build(stage):
        shaded(stage, cube)
        stage.renderer.SetTwoSidedLighting(two_sided)
        lights(stage)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("lights", [directional, positional])
def test_specular_light(cube, surfaces, lights):
    """One-sided: on the other side VTK's mapper puts highlights where no mirror would. The highlight has its own colour."""

    def build(stage):
        shaded(stage, cube, surfaces, specular=0.6)
        stage.renderer.TwoSidedLightingOff()
        lights(stage)
        light = stage.renderer.GetLights().GetItemAsObject(0)
        light.SetDiffuseColor(1, 0.8, 0.6)
        light.SetSpecularColor(0.1, 0.5, 1)

    check_scene_like_vtk(build)


def test_headlight(cube):
    """Without a light in the scene VTK's mapper has light go from the camera's position to each point, ours along the view as
    vtkLight says: from far away both are the same. The material's ambient light is there, too."""

    def build(stage):
        shaded(stage, cube, specular=0.3).GetProperty().SetAmbient(0.2)
        stage.look_at(cube, 1, distance=30, angle=3)

    check_scene_like_vtk(build)


# --- the table ---------------------------------------------------------------------------------------------------------------


def test_the_table_names_tests_that_are_there():
    files = {path.name: path.read_text() for path in TESTS.rglob("test_*.py")}
    table = (TESTS.parent / "conformance.md").read_text()
    for row in re.findall(r"^\|.*\|$", table, re.MULTILINE):
        file = "test_conformance.py"
        for name in re.findall(r"test_\w+(?:\.py)?", row.rsplit("|", 2)[1]):
            if name.endswith(".py"):
                file = name
            else:
                named = file if f"def {name}(" in files[file] else "test_conformance.py"
                assert f"def {name}(" in files[named], f"{name} is in neither {file} nor {named}"
