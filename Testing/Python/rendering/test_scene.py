"""Isosurfaces in a scene: depth buffer, opaque and translucent geometry, light, several volumes."""

import ctypes

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkColorTransferFunction,
    vtkLight,
    vtkPolyDataMapper,
)

import progiso
from helpers.images import blobs, make_image, noise, reference_volume
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, orbit
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, cast

SIZE = (160, 120)
ISOVALUE = 0.1


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((40, 36, 44), 12)), rate=8)


def colour(volume, rgb):
    function = vtkColorTransferFunction()
    function.AddRGBPoint(0, *rgb)
    volume.GetProperty().SetColor(function)


def flat(scene, rgb):
    """Give the isosurface one colour that no light changes."""
    colour(scene.volume, rgb)
    scene.volume.GetProperty().ShadeOff()


def piece_of(compressed, axis, first, last):
    """Return a part of a compressed volume with the whole stream.

    Samples count from the volume's own first one.
    """
    part = vtkImageData()
    part.ShallowCopy(compressed)
    extent = list(compressed.GetExtent())
    extent[2 * axis : 2 * axis + 2] = extent[2 * axis] + first, extent[2 * axis] + last
    part.SetExtent(extent)
    return part


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize("settings", [{}, CACHED])
def test_pieces_meet_without_a_seam(axis, cells, settings):
    """Two mappers with a part of a volume each make the whole picture; neither alone does."""
    values = make_image(blobs((40, 36, 44), 12), cells=cells, extent_start=(5, -3, 2))
    compressed = progiso.compress(values, rate=4)
    camera = orbit(reference_volume(compressed), 1, 8)
    end = values.GetDimensions()[axis] - 1
    ranges = (0, end), (0, 17), (17, end)
    whole, parts, other = (
        Scene(piece_of(compressed, axis, *part), ISOVALUE, camera, SIZE, lit=True, **settings)
        for part in ranges
    )
    hits = [np.isfinite(scene.depth()) for scene in (whole, parts, other)]
    assert (
        (hits[0] == (hits[1] | hits[2])).all()
        and not (hits[0] == hits[1]).all()
        and not (hits[0] == hits[2]).all()
    )
    parts.renderer.AddVolume(other.volume)
    parts.render()
    difference = np.abs(parts.picture().astype(int) - whole.picture()).max(axis=2)
    assert (difference > tolerances.PROCESSES_LEVELS).mean() <= tolerances.PROCESSES_PIXELS


def wall(camera, distance, rgb, opacity=1.0):
    """Return a wide square of one colour, `distance` from the camera and across its view."""
    position, forward = np.array(camera.position), np.subtract(camera.focal_point, camera.position)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, camera.view_up)
    right /= np.linalg.norm(right)
    up, centre, reach = np.cross(right, forward), position + distance * forward, 3 * distance
    plane = vtkPlaneSource()
    plane.SetOrigin(centre - reach * (right + up))
    plane.SetPoint1(centre + reach * (right - up))
    plane.SetPoint2(centre - reach * (right - up))
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(plane.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(rgb)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetOpacity(opacity)
    return actor


def across(camera, size):
    """Return the cosines between the rays of an image and the view."""
    forward = np.subtract(camera.focal_point, camera.position)
    return (camera.rays(size)[1] @ (forward / np.linalg.norm(forward))).reshape(size[1], size[0])


@pytest.mark.parametrize("parallel", [False, True])
def test_depth_buffer(image, parallel):
    """VTK composites by the surface's depth, to the last places of the depth buffer."""
    volume = reference_volume(image)
    camera = orbit(volume, 1, 4)
    if parallel:
        camera = Camera(camera.position, camera.focal_point, parallel_scale=25)
    scene = Scene(image, ISOVALUE, camera, SIZE)
    scene.render()
    data = vtkFloatArray()
    scene.window.GetZbufferData(0, 0, SIZE[0] - 1, SIZE[1] - 1, data)
    z = vtk_to_numpy(data).reshape(SIZE[1], SIZE[0])[::-1]
    expected = cast(volume, ISOVALUE, camera, SIZE, slack=tolerances.SLACK)
    hit = np.isfinite(expected.late)
    assert np.array_equal(z == 1, ~np.isfinite(scene_depth := progiso.depth(scene.mapper)))
    near, far = scene.renderer.GetActiveCamera().GetClippingRange()

    eye = (scene_depth * across(camera, SIZE))[hit]
    window_z = (
        (eye - near) / (far - near) if parallel else far * (eye - near) / (eye * (far - near))
    )
    assert hit.sum() > 1000
    assert np.abs(z[hit] - window_z).max() < tolerances.DEPTH_BUFFER


@pytest.mark.parametrize("distance", [45.0, 60.0, 66.0, 70.0, 90.0])
def test_opaque_geometry_hides_and_is_hidden(image, distance):
    volume = reference_volume(image)
    camera = orbit(volume, 1, 4)
    scene = Scene(image, ISOVALUE, camera, SIZE)
    flat(scene, (0, 1, 0))
    scene.renderer.AddActor(wall(camera, distance, (1, 0, 0)))
    scene.render()
    picture = scene.picture()
    expected = cast(volume, ISOVALUE, camera, SIZE, slack=tolerances.SLACK)
    eye = expected.depth * across(camera, SIZE)
    in_front, behind = (eye < distance - 1e-2) & np.isfinite(expected.late), eye > distance + 1e-2
    behind &= ~(np.isfinite(expected.early) & ~np.isfinite(expected.late))
    assert np.all(picture[in_front] == [0, 255, 0])
    assert np.all(picture[behind] == [255, 0, 0])
    assert in_front.sum() + behind.sum() > 0.98 * picture[..., 0].size
    if 60 <= distance <= 70:
        assert in_front.any() and behind[np.isfinite(expected.depth)].any()


def test_translucent_geometry_in_front_blends(image):
    """The isosurface is drawn in the opaque pass: what is translucent covers it and is not
    overwritten."""
    camera = orbit(reference_volume(image), 1, 4)
    scene = Scene(image, ISOVALUE, camera, SIZE)
    flat(scene, (0, 1, 0))
    scene.renderer.AddActor(wall(camera, 10, (1, 0, 0), opacity=0.5))
    hit = np.isfinite(scene.depth())
    picture = scene.picture().astype(int)
    assert hit.any() and np.abs(picture[hit] - [127.5, 127.5, 0]).max() < 3
    assert np.abs(picture[~hit] - [(1 + 0.2) / 2 * 255, 0.15 * 255, 0.2 * 255]).max() < 3


def test_two_isosurfaces(image):
    """Of two volumes in one window the nearer hit shows."""
    camera = orbit(reference_volume(image), 1, 4)
    first, second = Scene(image, -0.2, camera, SIZE), Scene(image, 0.3, camera, SIZE)
    alone = [first.depth(), second.depth()]
    flat(first, (0, 1, 0))
    flat(second, (0, 0, 1))
    first.renderer.AddVolume(second.volume)
    second.window.Finalize()
    first.render()
    picture = first.picture()
    assert np.all(picture[alone[0] < alone[1] - 1e-2] == [0, 255, 0])
    assert np.all(picture[alone[1] < alone[0] - 1e-2] == [0, 0, 255])
    assert (alone[0] < alone[1]).any() and (alone[1] < alone[0]).any()


def test_visibility_and_background(image):
    scene = Scene(image, ISOVALUE, orbit(reference_volume(image), 1, 4), SIZE)
    hit = np.isfinite(scene.depth())
    assert np.all(scene.picture()[~hit] == np.round(np.array([0.2, 0.3, 0.4]) * 255))
    scene.volume.VisibilityOff()
    scene.window.Render()
    assert np.all(scene.picture() == np.round(np.array([0.2, 0.3, 0.4]) * 255))


@pytest.mark.parametrize(
    "direction", [None, np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]]
)
@pytest.mark.parametrize("spacing", [(1, 1, 1), (1, 2, 0.5)])
def test_light_falls_on_smooth_normals(spacing, direction):
    """A sphere is lit like a sphere, without facet, block or seam, in any geometry."""
    shape, radius = (48, 48, 48), 18.0
    z, y, x = np.indices(shape)
    matrix = (np.eye(3) if direction is None else direction) * spacing
    places = np.stack([x, y, z], axis=-1) @ matrix.T
    centre = matrix @ [23.5, 23.5, 23.5]
    radius = 18.0 * min(spacing)
    values = radius + 5 - np.linalg.norm(places - centre, axis=-1)
    image = progiso.compress(make_image(values, spacing=spacing, direction=direction), rate=24)
    camera = Camera(
        tuple(centre + [70, 20, 40]),
        tuple(centre),
        view_angle=2.4 * np.degrees(np.arctan(radius / 83)),
    )
    scene = Scene(image, 5.0, camera, SIZE)
    colour(scene.volume, (1, 1, 1))
    scene.volume.GetProperty().ShadeOn()
    scene.volume.GetProperty().SetAmbient(0)
    scene.volume.GetProperty().SetDiffuse(1)
    scene.volume.GetProperty().SetSpecular(0)
    depth = scene.depth()
    origins, directions = camera.rays(SIZE)
    hit = np.isfinite(depth).ravel()
    normals = (origins + directions * np.where(hit, depth.ravel(), 0)[:, None] - centre) / radius
    forward = np.subtract(camera.focal_point, camera.position) / np.linalg.norm([70, 20, 40])
    lit = np.abs(normals @ forward)
    seen = hit & (lit > 0.3)
    assert seen.sum() > 3000
    levels = scene.picture()[..., 0].ravel()
    assert np.abs(levels[seen] - 255 * lit[seen]).max() < tolerances.SHADING_LEVELS


def test_ambient_diffuse_and_colour(image):
    """Without shading the colour is the transfer function's at the isovalue; ambient light alone
    gives its share."""
    scene = Scene(image, ISOVALUE, orbit(reference_volume(image), 1, 4), SIZE)
    function = vtkColorTransferFunction()
    function.AddRGBPoint(ISOVALUE - 1, 0, 0, 1)
    function.AddRGBPoint(ISOVALUE + 1, 1, 0.5, 1)
    scene.volume.GetProperty().SetColor(function)
    scene.volume.GetProperty().ShadeOff()
    hit = np.isfinite(scene.depth())
    assert np.abs(scene.picture()[hit].astype(int) - [127.5, 63.75, 255]).max() <= 2
    scene.volume.GetProperty().ShadeOn()
    scene.volume.GetProperty().SetAmbient(0.5)
    scene.volume.GetProperty().SetDiffuse(0)
    scene.volume.GetProperty().SetSpecular(0)
    scene.render()
    assert np.abs(scene.picture()[hit].astype(int) - [63.75, 31.9, 127.5]).max() <= 2


def test_viewports(image):
    """Two renderers side by side each show their part, and the depth image has the size of the
    viewport."""
    camera = orbit(reference_volume(image), 1, 4)
    alone = Scene(image, ISOVALUE, camera, (80, 120)).depth()
    scene = Scene(image, ISOVALUE, camera, SIZE)
    scene.renderer.SetViewport(0.5, 0, 1, 1)
    depth = scene.depth()
    assert depth.shape == (120, 80)
    assert depth.tobytes() == alone.tobytes()
    picture = scene.picture()
    assert np.ptp(picture[:, :80].reshape(-1, 3), axis=0).max() == 0
    assert np.ptp(picture[:, 80:].reshape(-1, 3), axis=0).max() > 50


def test_gl_errors_are_counted(image):
    """An error made on purpose shows in the count that every scene checks."""
    scene = Scene(image, ISOVALUE, orbit(reference_volume(image), 1, 4), SIZE)
    scene.render()
    library = {
        "vtkOSOpenGLRenderWindow": "libOSMesa.so.8",
        "vtkEGLRenderWindow": "libOpenGL.so.0",
    }.get(scene.window.GetClassName(), "libGL.so.1")
    scene.window.MakeCurrent()
    ctypes.CDLL(library).glEnable(0xFFFF)
    assert scene.mapper.GetNumberOfGLErrors() == 1


BAD = {
    "flat": lambda: make_image(noise((1, 8, 8))),
    "truncated": lambda: truncated(progiso.compress(make_image(noise((8, 8, 8))))),
}


def truncated(image):
    stream = image.GetFieldData().GetAbstractArray("ProgIso.ZFP.Stream")
    stream.SetNumberOfValues(stream.GetNumberOfValues() // 2)
    return image


@pytest.mark.parametrize("name", BAD)
def test_errors_name_what_is_wrong(name):
    """Rendering without a usable input says so and shows the background, however often."""
    scene = Scene(BAD[name](), 0.0, Camera((30, 30, 30), (4, 4, 4)))
    for _ in range(2):
        with vtk_messages() as messages:
            scene.window.Render()
    assert np.ptp(scene.picture().reshape(-1, 3), axis=0).max() == 0
    scene = Scene(BAD[name](), 0.0, Camera((30, 30, 30), (4, 4, 4)))
    with vtk_messages() as messages:
        scene.window.Render()
    assert any(
        "vtkProgressiveIsosurfaceMapper" in m or "vtkImageZFPCompress" in m for m in messages
    ), messages


def mesh_scene(image, isovalue, scene):
    """Return a window like a scene's, with its camera and lights, that shows the mesh."""
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, isovalue)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(contour.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = scene.volume.GetProperty()
    actor.GetProperty().SetAmbient(look.GetAmbient())
    actor.GetProperty().SetDiffuse(look.GetDiffuse())
    actor.GetProperty().SetSpecular(look.GetSpecular())
    scene.renderer.RemoveVolume(scene.volume)
    scene.renderer.AddActor(actor)
    scene.window.Render()
    return scene.picture().astype(int)


def test_lit_like_meshes():
    """Lit from beside and behind, the surface looks like FlyingEdges' mesh, not as in VTK's volume
    mapper."""
    image = make_image(blobs((40, 40, 40)))
    pictures = {}
    for like_meshes in (True, False):
        camera = orbit(reference_volume(progiso.compress(image, rate=16)), 1, 4)
        scene = Scene(
            image, 0.1, camera, (160, 120), lit=True, Rate=24.0, LitLikeMeshes=like_meshes
        )
        colour(scene.volume, (1, 1, 1))
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(1.0, 0.3, -0.8)
        light.SetFocalPoint(0.0, 0.0, 0.0)
        scene.renderer.AddLight(light)
        scene.render()
        pictures[like_meshes] = scene.picture().astype(int)
        mesh = mesh_scene(image, 0.1, scene)
    off = {key: np.abs(picture - mesh).mean() for key, picture in pictures.items()}
    assert off[True] < tolerances.MESH_LIGHT_MEAN and off[False] > 5 * tolerances.MESH_LIGHT_MEAN, (
        off
    )
