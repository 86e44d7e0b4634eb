"""Arrays of every kind, and inputs that change."""

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkAffineTypeFloat64Array
from vtkmodules.vtkCommonDataModel import vtkPlane

import progiso
from helpers.comparison import (
    GREEN,
    NESTED,
    OPAQUE,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    far_apart,
    show,
)
from helpers.geometry import SHAPE
from helpers.images import blobs, make_image
from progiso.measure import tolerances


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
def test_cell_data(surfaces):
    """Cells' values are samples at their centres.

    VTK's mapper draws them up to the cells' outer faces, ours between the centres.
    """
    compressed = progiso.compress(
        make_image(blobs(SHAPE, 12, waves=2), cells=True, spacing=(1, 1.5, 1)), rate=16
    )

    def build(scene):
        mapper = show(scene, compressed, surfaces).GetMapper()
        for axis in range(3):
            for side in (1, -1):
                plane = vtkPlane()
                low, high = compressed.GetBounds()[2 * axis : 2 * axis + 2]
                plane.SetOrigin(*(low + 1.6 if side > 0 else high - 1.6 for _ in range(3)))
                plane.SetNormal(*(side * (axis == other) for other in range(3)))
                mapper.AddClippingPlane(plane)

    check_scene_like_vtk(build)


TYPES = "uint8 int8 uint16 int16 uint32 int32 uint64 int64 float32 float64".split()


@pytest.mark.parametrize("kind", TYPES)
def test_data_types(kind):
    values = (60 + 50 * np.clip(blobs(SHAPE, 12, waves=2), -1, 1)).astype(kind)
    compressed = progiso.compress(make_image(values), rate=16)
    check_scene_like_vtk(lambda scene: show(scene, compressed, {65: (*GREEN, 1.0)}))


def several(scene, arrays, component=None):
    """Add a volume of a plain image with these point arrays, the first of them active."""
    plain = make_image(next(iter(arrays.values())), name=next(iter(arrays)))
    for name, values in arrays.items():
        plain.GetPointData().AddArray(make_image(values, name=name).GetPointData().GetScalars())
    volume = scene.add(progiso.compress(make_image(blobs(SHAPE, 1)), rate=4), OPAQUE)
    volume.GetMapper().SetInputData(plain)
    scene.look_at(plain_geometry())
    return volume


def plain_geometry():
    return progiso.compress(make_image(np.zeros(SHAPE, np.float32)), rate=4)


def test_changed_array():
    """The mapper's scalar mode chooses another array of the same input."""
    arrays = {"one": blobs(SHAPE, 12, waves=2), "two": blobs(SHAPE, 5, waves=2)}

    scenes = both(lambda scene: several(scene, arrays))
    pictures = []
    for name in ("one", "two", "one"):
        for scene in scenes:
            scene.mapper.SetScalarModeToUsePointFieldData()
            scene.mapper.SelectScalarArray(name)
        pictures.append(scenes[0].picture())
        check_like_vtk(pictures[-1], scenes[1].picture())
    assert np.array_equal(pictures[0], pictures[2]) and not np.array_equal(pictures[0], pictures[1])


def test_implicit_array():
    """Samples may be computed as they are read."""
    affine = vtkAffineTypeFloat64Array()
    affine.ConstructBackend(2 / (np.prod(SHAPE) - 1), -1.0)
    affine.SetNumberOfComponents(1)
    affine.SetNumberOfTuples(int(np.prod(SHAPE)))
    affine.SetName("implicit")
    scenes = ComparisonScene(ours=True), ComparisonScene(ours=True)
    for scene in scenes:
        several(scene, {"s": np.zeros(SHAPE, np.float32)})
    explicit = make_image(np.linspace(-1, 1, int(np.prod(SHAPE)), dtype=np.float64).reshape(SHAPE))
    implicit = make_image(np.zeros(SHAPE))
    implicit.GetPointData().SetScalars(affine)
    scenes[0].mapper.SetInputData(explicit)
    scenes[1].mapper.SetInputData(implicit)
    pictures = [scene.picture() for scene in scenes]
    assert np.isfinite(progiso.depth(scenes[0].mapper)).mean() > 0.1
    assert far_apart(*pictures)[0] <= tolerances.VTK_PIXELS


def test_component():
    """One component of vectors may be drawn."""
    vectors = np.stack([blobs(SHAPE, seed, waves=2) for seed in (3, 12, 5)], axis=-1)
    picture, alone = ComparisonScene(ours=True), ComparisonScene(ours=True)
    several(picture, {"v": vectors}).GetMapper().SetComponent(1)
    several(alone, {"s": vectors[..., 1]})
    assert np.array_equal(picture.picture(), alone.picture())
    check_like_vtk(picture.picture(), several_of_vtk(vectors[..., 1]))


def several_of_vtk(values):
    scene = ComparisonScene(ours=False)
    several(scene, {"s": values})
    return scene.picture()


def test_time_series():
    """Another image at the input is drawn, and another time of the same image object."""
    steps = [
        progiso.compress(make_image(blobs(SHAPE, seed, waves=2)), rate=16) for seed in (12, 5, 12)
    ]
    scenes = both(lambda scene: show(scene, steps[0]))
    pictures = []
    for step in steps:
        for scene in scenes:
            scene.feed(scene.mapper, step)
        pictures.append(scenes[0].picture())
        check_like_vtk(pictures[-1], scenes[1].picture())
    assert np.array_equal(pictures[0], pictures[2]) and not np.array_equal(pictures[0], pictures[1])


def test_values_change_in_place():
    """A plain image whose samples change, and say so, is drawn anew."""
    plain = make_image(blobs(SHAPE, 12, waves=2))
    other = make_image(blobs(SHAPE, 5, waves=2))
    scene = ComparisonScene(ours=True)
    several(scene, {"s": blobs(SHAPE, 12, waves=2)}).GetMapper().SetInputData(plain)
    first = scene.picture()
    plain.GetPointData().GetScalars().DeepCopy(other.GetPointData().GetScalars())
    plain.GetPointData().GetScalars().Modified()
    plain.Modified()
    assert not np.array_equal(scene.picture(), first)
    check_like_vtk(scene.picture(), several_of_vtk(blobs(SHAPE, 5, waves=2)))
