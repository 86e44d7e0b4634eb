"""Isovalues, their colours and their opacities."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction

import progiso
from helpers.comparison import (
    BLUE,
    GREEN,
    NESTED,
    OPAQUE,
    RED,
    ComparisonScene,
    both,
    check_like_vtk,
    check_scene_like_vtk,
    paint,
    show,
)
from helpers.geometry import SHAPE
from helpers.images import blobs, make_image


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
    check_scene_like_vtk(lambda scene: show(scene, image, surfaces))


def test_isovalues_change(image):
    """One surface, three, or none are drawn, as the property says at the time."""
    scenes = both(lambda scene: show(scene, image))
    for surfaces in (OPAQUE, NESTED, OPAQUE):
        for scene in scenes:
            paint(scene.volumes[0], surfaces)
        check_like_vtk(*(scene.picture() for scene in scenes))
    scenes[0].volumes[0].GetProperty().GetIsoSurfaceValues().SetNumberOfContours(0)
    assert np.ptp(scenes[0].picture().reshape(-1, 3), axis=0).max() == 0


def test_grey_transfer_function(image):
    """VTK's GPU mapper ignores it; in ours the surface has the grey of its isovalue."""
    scene = ComparisonScene(ours=True)
    grey = vtkPiecewiseFunction()
    grey.AddPoint(-1, 0.1)
    grey.AddPoint(1, 0.9)
    show(scene, image).GetProperty().SetColor(grey)
    picture = scene.picture()
    hit = np.isfinite(progiso.depth(scene.mapper))
    assert hit.mean() > 0.2
    assert np.abs(picture[hit] - 255 * (0.5 + 0.4 * 0.1)).max() <= 1


def test_a_narrow_colour_is_not_smeared():
    """Colours come from the functions themselves, not from a table over the range of values."""
    values = 1e4 * blobs(SHAPE, 12, waves=2)
    scene = ComparisonScene(ours=True)
    show(
        scene,
        progiso.compress(make_image(values), rate=24),
        {999.0: (*RED, 1.0), 1000.0: (*GREEN, 1.0), 1001.0: (*BLUE, 1.0)},
    )
    picture = scene.picture()[np.isfinite(progiso.depth(scene.mapper))]
    shares = [
        (np.abs(picture - 255 * np.array(rgb)).max(axis=1) <= 1).mean()
        for rgb in (RED, GREEN, BLUE)
    ]
    assert sum(shares) == 1 and min(shares[0], shares[2]) > 0.2
