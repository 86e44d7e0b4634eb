"""Another array or volume gives the surface its colours."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction,
    vtkDiscretizableColorTransferFunction,
)

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


# --- colour maps ----------------------------------------------------------------------------------


def map_of(kind):
    """Return a table over [-14, 14], or over decades, of a kind that users have."""
    colors = vtkDiscretizableColorTransferFunction()
    if kind.startswith("lookup"):
        colors = vtkLookupTable()
        colors.SetNumberOfTableValues(9 if "few" in kind else 700)
        colors.SetTableRange(-RADIUS / 2, RADIUS / 2)
        colors.SetHueRange(0.9, 0.1)
        colors.Build()
    elif kind == "decades":
        colors.SetUseLogScale(True)
        colors.DiscretizeOff()
        for place, color in ((1e-6, (0, 0, 1)), (1e-3, (1, 1, 0)), (1e6, (1, 0, 0))):
            colors.AddRGBPoint(place, *color)
    else:
        colors.SetDiscretize(kind == "few steps")
        colors.SetNumberOfValues(7)
        for place, color in (
            (-RADIUS / 2, (0, 0, 1)),
            (-1, (0, 1, 0)),
            (-0.999999, (1, 1, 0)),  # a jump
            (RADIUS / 2, (1, 0, 0)),
        ):
            colors.AddRGBPoint(place, *color)
        if kind == "lab":
            colors.SetColorSpaceToLab()
        if kind == "sharp":
            colors.RemoveAllPoints()
            colors.AddRGBPoint(-RADIUS / 2, 0, 0, 1, 0.25, 1.0)
            colors.AddRGBPoint(RADIUS / 2, 1, 0, 0)
    if "beyond" in kind:
        colors.UseBelowRangeColorOn()
        colors.UseAboveRangeColorOn()
        colors.SetBelowRangeColor(*((0, 1, 1, 1) if "lookup" in kind else (0, 1, 1)))
        colors.SetAboveRangeColor(*((1, 0, 1, 1) if "lookup" in kind else (1, 0, 1)))
    return colors


def check_mapped(scene, values, slope, colors):
    """Hold pixels against the table's colours of the values there, or within half a voxel."""
    picture, hit = picture_of(scene), np.isfinite(values)
    assert hit.sum() > 1000
    found, at = picture[hit], values[hit]
    closest = np.full(len(at), 999.0)
    color = [0.0] * 3
    for shift in (-slope, 0, slope):
        expected = np.empty((len(at), 3))
        for i, value in enumerate(at * (1 + shift) if slope < 0.02 else at + shift):
            colors.GetColor(value, color)
            expected[i] = color
        closest = np.minimum(closest, np.abs(found - 255 * expected).max(axis=1))
    assert (closest <= 3).mean() > 0.995, np.sort(closest)[-20:]
    assert len(np.unique(found, axis=0)) > 1


@pytest.mark.parametrize(
    "kind",
    ["nodes", "lab", "sharp", "few steps", "beyond", "lookup few beyond", "lookup many"],
)
def test_tables_have_their_nodes_steps_and_ends(kind):
    colors = map_of(kind)
    colors.Build()
    scene = scene_of(ball(), colors=colors, ColorArrayName="right")
    check_mapped(scene, ray_places(scene), 0.03, colors)


def test_decades():
    """Two thirds of a logarithmic map would be one colour by samples at even distances."""
    image, colors = ball(), map_of("decades")
    x = vtk_to_numpy(image.GetPointData().GetArray("right"))
    decades = numpy_to_vtk(np.exp(x.astype(float)), deep=True)
    decades.SetName("decades")
    image.GetPointData().AddArray(decades)
    scene = scene_of(image, colors=colors, ColorArrayName="decades")
    scene.mapper.SetRate(32)
    place = ray_places(scene)
    place[~np.isfinite(place)] = np.nan
    low = np.floor(place - 0.5) + 0.5  # the interpolant is linear between samples at half voxels
    values = np.exp(low) + (place - low) * (np.exp(low + 1) - np.exp(low))
    check_mapped(scene, values, 0.015, colors)


def test_categories_are_those_of_the_nearest_sample():
    """Labels 1, 5 and 9; 3 has no colour, and between two there is none."""
    image = ball()
    x = vtk_to_numpy(image.GetPointData().GetArray("right"))
    labels = np.digitize(x, [-6, 0, 6]) * 4 + 1
    labels[labels == 13] = 3
    array = numpy_to_vtk(labels.astype(np.int32), deep=True)
    array.SetName("labels")
    image.GetPointData().AddArray(array)
    for kind in (vtkLookupTable, vtkDiscretizableColorTransferFunction):
        colors = kind()
        colors.SetIndexedLookup(True)
        for label in (1, 5, 9):
            colors.SetAnnotation(label, str(label))
        palette = np.eye(3)
        if kind is vtkLookupTable:
            colors.SetNumberOfTableValues(3)
            for i, color in enumerate(palette):
                colors.SetTableValue(i, *color, 1)
            colors.SetNanColor(1, 1, 0, 1)
        else:
            colors.SetNumberOfIndexedColors(3)
            for i, color in enumerate(palette):
                colors.SetIndexedColor(i, *color)
            colors.SetNanColor(1, 1, 0)
        scene = scene_of(image, colors=colors, ColorArrayName="labels")
        place, picture = ray_places(scene), picture_of(scene)
        hit = np.isfinite(place)
        nearest = np.floor(place[hit]) + 0.5
        expected = np.vstack([palette, [1, 1, 0]])[np.digitize(nearest, [-6, 0, 6])] * 255
        sure = np.abs(place[hit] - np.round(place[hit])) > 0.02
        assert (np.abs(picture[hit] - expected).max(axis=1)[sure] <= 1).mean() > 0.999
        # back to a map of values in between: the hits' values are others
        scene.mapper.SetColorLookupTable(map_of("nodes"))
        assert len(np.unique(picture_of(scene)[hit], axis=0)) > 5
        scene.mapper.SetColorLookupTable(colors)
        assert np.array_equal(picture_of(scene), picture)


@pytest.mark.parametrize("settings", [{}, CACHED])
@pytest.mark.parametrize("cells", [False, True])
def test_no_number_has_its_colour(cells, settings):
    image = ball(cells)
    array = image.GetCellData() if cells else image.GetPointData()
    right = vtk_to_numpy(array.GetArray("right"))
    right[right > 4] = np.nan
    right[right < -8] = np.inf
    colors = table()
    colors.SetNanColor(0, 1, 0)
    if cells:
        image.SetOrigin(-0.5, -0.5, -0.5)
    scene = scene_of(image, colors=colors, ColorArrayName="right", **settings)
    place, picture = ray_places(scene), picture_of(scene)
    green = (picture == [0, 255, 0]).all(axis=2)
    none = (place > 3.6) | (place < -7.6)  # samples lie at half voxels
    some = (place < 3.4) & (place > -7.4)
    assert green[none & np.isfinite(place)].all() and not green[some].any()
    assert green.sum() > 500


@pytest.mark.parametrize("opacity", [1.0, 0.5])
def test_opacities_of_a_table(opacity):
    """The table's and the isosurface's multiply; the same picture by a flat map and opacities."""
    colors = map_of("nodes")
    opacities = vtkPiecewiseFunction()
    opacities.AddPoint(-RADIUS, 0.6)
    opacities.AddPoint(RADIUS, 0.6)
    colors.SetScalarOpacityFunction(opacities)
    colors.EnableOpacityMappingOn()
    scene = scene_of(ball(), opacity=opacity, colors=colors, ColorArrayName="right")
    mapped = picture_of(scene)
    assert scene.mapper.DrawsTranslucent(scene.volume.GetProperty())
    colors.EnableOpacityMappingOff()
    plain = picture_of(
        scene_of(ball(), opacity=0.6 * opacity, colors=map_of("nodes"), ColorArrayName="right")
    )
    assert np.abs(mapped - plain).max() <= 1
    # where a part is clear, what lies behind it shows alone
    opacities.RemoveAllPoints()
    for place, value in ((-RADIUS, 0), (-0.01, 0), (0.01, 1), (RADIUS, 1)):
        opacities.AddPoint(place, value)
    colors.EnableOpacityMappingOn()
    half = picture_of(scene)
    place = ray_places(scene)
    clear, shown = half[place < -1], half[(place > 1) & np.isfinite(place)]
    assert (clear == half[0, 0]).all() and (shown != half[0, 0]).any(axis=1).all()


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
