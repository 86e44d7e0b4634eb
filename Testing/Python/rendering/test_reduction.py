"""ImageReductionFactor: fewer rays, and the same image in larger pixels."""

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkHardwareSelector, vtkPolyDataMapper

import progiso
from helpers.images import blobs, make_image, reference_volume
from helpers.scenes import CACHED, Scene, check_depth
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, cast

SIZE = (160, 120)
CAMERA = Camera((40.0, 22.0, 30.0), (12.0, 12.0, 12.0), view_angle=40)


@pytest.fixture(scope="module")
def image():
    return progiso.compress(make_image(blobs((25, 25, 25), 6)), rate=8)


def enlarged(picture, factor):
    """Return a picture with squares in place of pixels."""
    return picture.repeat(factor, axis=0).repeat(factor, axis=1)


@pytest.mark.parametrize("settings", [{}, CACHED])
def test_depths_are_those_of_fewer_rays(image, settings):
    scene = Scene(image, 0.1, CAMERA, SIZE, ImageReductionFactor=4, **settings)
    got = scene.depth()
    expected = cast(
        reference_volume(image),
        0.1,
        CAMERA,
        (40, 30),
        slack=tolerances.SLACK,
        clip=scene.clipping_range,
    )
    check_depth(got, expected, grazing=0.3)


def test_the_picture_is_that_of_a_smaller_window_enlarged(image):
    small = Scene(image, 0.1, CAMERA, (40, 30), lit=True)
    scene = Scene(image, 0.1, CAMERA, SIZE, lit=True, ImageReductionFactor=4)
    small.render()
    scene.render(small.clipping_range)
    assert (scene.picture() == enlarged(small.picture(), 4)).all()


@pytest.mark.parametrize("factor", [3, 7, 64])
def test_sizes_that_no_factor_divides(image, factor):
    """The enlarged image fills the window, in place."""
    near = Camera((12.0, 12.0, 20.0), (12.0, 12.0, 0.0), view_angle=120)
    full = Scene(image, 0.1, near, (161, 118), lit=True)
    full.render()
    scene = Scene(image, 0.1, near, (161, 118), lit=True, ImageReductionFactor=factor)
    scene.render(full.clipping_range)
    columns, rows = -(-161 // factor), -(-118 // factor)
    assert progiso.depth(scene.mapper).shape == (rows, columns)
    # the middle of each large pixel shows what the full image has there
    x = ((np.arange(columns) + 0.5) * 161 / columns).astype(int)
    y = ((np.arange(rows) + 0.5) * 118 / rows).astype(int)
    got, expected = scene.picture()[::-1][y][:, x], full.picture()[::-1][y][:, x]
    assert (np.abs(got.astype(int) - expected).max(axis=2) > 60).mean() < 0.15
    assert len(np.unique(scene.picture().reshape(-1, 3), axis=0)) <= columns * rows + 1


def test_the_full_image_returns(image):
    scene = Scene(image, 0.1, CAMERA, SIZE, lit=True)
    scene.render()
    before = scene.picture()
    scene.mapper.SetImageReductionFactor(5)
    scene.render(scene.clipping_range)
    assert (scene.picture() != before).any()
    scene.mapper.SetImageReductionFactor(1)
    scene.render(scene.clipping_range)
    assert (scene.picture() == before).all()


@pytest.mark.parametrize("samples", [0, 4])
def test_translucent_surfaces_end_at_geometry(image, samples):
    """Depths of opaque geometry are read where rays are, of windows with several samples, too."""
    pictures = []
    for factor in (1, 2):
        scene = Scene(image, 0.1, CAMERA, SIZE, lit=True, ImageReductionFactor=factor)
        scene.window.SetMultiSamples(samples)
        scene.volume.GetProperty().GetScalarOpacity().RemoveAllPoints()
        scene.volume.GetProperty().GetScalarOpacity().AddPoint(0.1, 0.5)
        sphere, mapper, actor = vtkSphereSource(), vtkPolyDataMapper(), vtkActor()
        sphere.SetCenter(12, 12, 12)
        sphere.SetRadius(9)
        mapper.SetInputConnection(sphere.GetOutputPort())
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(1, 0, 0)
        scene.renderer.AddActor(actor)
        scene.render()
        pictures.append(scene.picture().astype(int))
        scene.renderer.RemoveActor(actor)
        scene.render()
        assert np.abs(scene.picture() - pictures[-1]).mean() > 10  # the sphere counts
    assert np.abs(pictures[0] - pictures[1]).mean() < 4


def test_hits_and_selections(image):
    """A hit is that of the large pixel; a selection is exact."""
    scene = Scene(image, 0.1, CAMERA, SIZE)
    found = []
    for factor in (1, 3):
        scene.mapper.SetImageReductionFactor(factor)
        scene.render()
        position, isovalue = [0.0] * 3, reference(0.0)
        assert scene.mapper.GetHit(80, 60, position, isovalue)
        selector = vtkHardwareSelector()
        selector.SetRenderer(scene.renderer)
        selector.SetArea(0, 0, SIZE[0] - 1, SIZE[1] - 1)
        selector.SetFieldAssociation(1)
        cells = selector.Select().GetNode(0).GetSelectionList()
        found.append((position, [cells.GetValue(i) for i in range(cells.GetNumberOfValues())]))
    assert np.linalg.norm(np.subtract(found[0][0], found[1][0])) < 1.0
    assert found[0][1] == found[1][1]
