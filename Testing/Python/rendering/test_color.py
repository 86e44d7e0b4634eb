"""Another array or volume gives the surface its colours."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

import progiso
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene
from progiso.oracle.caster import Camera

N, RADIUS, SIZE = 40, 14.0, (120, 100)
CENTER = (N - 1) / 2
CAMERA = Camera((CENTER, CENTER, 90.0), (CENTER, CENTER, CENTER), (0.0, 1.0, 0.0), view_angle=30.0)


def ball(cells=False):
    """Return the distance from the centre, and beside it how far to the right a sample is."""
    z, y, x = np.meshgrid(*[np.arange(N) - CENTER] * 3, indexing="ij")
    image = make_image(np.sqrt(x * x + y * y + z * z).astype(np.float32), "distance", cells=cells)
    right = numpy_to_vtk(x.astype(np.float32).ravel(), deep=True)
    right.SetName("right")
    (image.GetCellData() if cells else image.GetPointData()).AddArray(right)
    return image


def table(low=(0, 0, 1), high=(1, 0, 0)):
    colors = vtkColorTransferFunction()
    colors.AddRGBPoint(-RADIUS, *low)
    colors.AddRGBPoint(RADIUS, *high)
    return colors


def scene_of(image, lit=False, opacity=1.0, colors=None, **settings):
    scene = Scene(
        image,
        RADIUS,
        CAMERA,
        SIZE,
        lit=lit,
        Rate=16.0,
        ColorLookupTable=colors or table(),
        **settings,
    )
    opacities = vtkPiecewiseFunction()
    opacities.AddPoint(RADIUS, opacity)
    scene.volume.GetProperty().SetScalarOpacity(opacities)
    return scene


def picture_of(scene):
    scene.render()
    return scene.picture().astype(int)


def ray_places(scene):
    """Return where rays hit, x relative to the centre, row 0 at the top; inf where none does."""
    distance = scene.depth()
    rows, columns = distance.shape
    half = np.tan(np.radians(CAMERA.view_angle / 2))
    right = ((np.arange(columns) + 0.5) * 2 - columns) / rows * half
    up = -((np.arange(rows) + 0.5) * 2 - rows) / rows * half
    return distance * right / np.sqrt(1 + right**2 + up[:, None] ** 2)


@pytest.mark.parametrize("settings", [{}, CACHED])
@pytest.mark.parametrize("cells", [False, True])
def test_colour_of_another_array(settings, cells):
    image = ball(cells)
    if cells:
        image.SetOrigin(-0.5, -0.5, -0.5)
    scene = scene_of(image, ColorArrayName="right", **settings)
    place, picture = ray_places(scene), picture_of(scene)
    hit = np.isfinite(place)
    assert hit.sum() > 1000
    share = np.clip((place[hit] + RADIUS) / (2 * RADIUS), 0, 1)
    assert np.abs(picture[hit][:, 0] - 255 * share).max() <= 2
    assert np.abs(picture[hit][:, 2] - 255 * (1 - share)).max() <= 2
    assert (picture[hit][:, 1] == 0).all()


@pytest.mark.parametrize("lit", [False, True])
@pytest.mark.parametrize("opacity", [1.0, 0.5])
def test_same_from_a_cache_and_from_port_1(lit, opacity):
    """Colours of an array or a compressed volume, decoded as a whole or pass by pass, are the same
    bits."""
    image = ball()
    right = progiso.compress(image, rate=16, array="right")
    ways = (
        {"ColorArrayName": "right"},
        {"ColorArrayName": "right", **CACHED},
        {"ColorInputData": right},
        {"ColorInputData": right, "MaximumPassesPerRender": 1, **CACHED},
    )
    first, *others = (picture_of(scene_of(image, lit, opacity, **way)) for way in ways)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 50
    assert all(np.array_equal(first, other) for other in others)


def test_a_small_cache_does_not_matter():
    field, colors = (
        make_image(blobs((48, 56, 64))),
        progiso.compress(make_image(blobs((48, 56, 64), seed=5)), rate=8),
    )
    camera = Camera((32.0, 28.0, 140.0), (32.0, 28.0, 24.0), (0.0, 1.0, 0.0))
    scenes = [
        Scene(
            field,
            0.1,
            camera,
            lit=True,
            ColorInputData=colors,
            ColorLookupTable=table(),
            **settings,
        )
        for settings in ({}, {**CACHED, "MemoryBudget": 3_000_000})
    ]
    pictures = [picture_of(scene) for scene in scenes]
    memory = scenes[1].statistics()["memory"]
    assert memory["total"] - memory["compressed"] <= 3_000_000
    assert np.array_equal(*pictures)


@pytest.mark.parametrize("opacity", [1.0, 0.5])
def test_other_colours_decode_nothing(opacity):
    scene = scene_of(ball(), opacity=opacity, ColorArrayName="right", **CACHED)
    before = picture_of(scene)
    scene.mapper.SetColorLookupTable(table((0, 1, 0), (0, 0.5, 0)))
    after = picture_of(scene)
    hit = np.isfinite(scene.depth())
    assert before[hit][:, 0].max() > 50 and after[hit][:, 1].min() > 50
    decoded = sum(p["decoded_blocks"] for p in scene.statistics()["passes"])
    assert (
        decoded == 0 or opacity == 1.0
    )  # an opaque image keeps its hits, and with them the first image's passes


def test_errors():
    image = ball()
    for settings, problem in (
        ({"ColorArrayName": "left"}, 'no array "left"'),
        (
            {"ColorInputData": progiso.compress(make_image(blobs((8, 8, 8))), rate=4)},
            "other dimensions",
        ),
    ):
        scene = scene_of(image, **settings)
        with vtk_messages() as messages:
            scene.window.Render()
        assert len(messages) == 1 and problem in messages[0]


# --- magnitudes -----------------------------------------------------------------------------------


def with_vectors(image, cells=False):
    """Add "flow", vectors whose length is "speed"."""
    data = image.GetCellData() if cells else image.GetPointData()
    z, y, x = np.meshgrid(*[np.arange(N) - CENTER] * 3, indexing="ij")
    flow = np.stack([x, 0.5 * y, np.sin(z)], axis=-1).reshape(-1, 3).astype(np.float32)
    for name, values in (("flow", flow), ("speed", np.sqrt((flow.astype(float) ** 2).sum(axis=1)))):
        array = numpy_to_vtk(values.astype(np.float32), deep=True)
        array.SetName(name)
        data.AddArray(array)
    return image


@pytest.mark.parametrize("cells", [False, True])
def test_magnitudes_give_colours(cells):
    image = with_vectors(ball(cells), cells)
    flow, speed, component = (
        picture_of(scene_of(image, ColorArrayName=name, ColorComponent=i))
        for name, i in (("flow", -1), ("speed", 0), ("flow", 0))
    )
    assert np.array_equal(flow, speed) and (flow != component).mean() > 0.1


def test_isosurfaces_of_magnitudes():
    image = with_vectors(ball())
    image.GetPointData().SetActiveScalars("flow")
    scene = Scene(image, 9.0, CAMERA, SIZE, Rate=16.0, Component=-1)
    image.GetPointData().SetActiveScalars("speed")
    other = Scene(image, 9.0, CAMERA, SIZE, Rate=16.0)
    expected = other.depth()
    image.GetPointData().SetActiveScalars("flow")
    depth = scene.depth()
    assert np.isfinite(depth).sum() > 1000 and depth.tobytes() == expected.tobytes()
    compressed = progiso.compress(image, rate=16, array="flow", component=-1)
    assert progiso.describe(compressed)["component"] == -1
    assert Scene(compressed, 9.0, CAMERA, SIZE).depth().tobytes() == expected.tobytes()
