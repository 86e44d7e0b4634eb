"""`make_isosurface` and `render`: several isovalues with their colours and opacities, and what is
wrong with others."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkRenderer, vtkRenderWindow

import progiso
from helpers.images import make_image
from progiso.rendering import window_pixels

SIZE = 101
RED, GREEN, BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def image():
    """Return distances from the centre: isosurfaces are spheres, the isovalue is their radius."""
    axis = np.arange(33) - 16.0
    distance = np.sqrt(axis[:, None, None] ** 2 + axis[:, None] ** 2 + axis**2).astype(np.float32)
    return progiso.compress(make_image(distance), rate=16)


def colours(prop, *radii):
    """Show a prop along x on black; return the colours where the circles of these radii are."""
    renderer, window = vtkRenderer(), vtkRenderWindow()
    renderer.AddVolume(prop)
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetParallelScale(SIZE / 6)  # three pixels a voxel
    camera.SetFocalPoint(16, 16, 16)
    camera.SetPosition(100, 16, 16)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCameraClippingRange()
    window.Render()
    row = window_pixels(window, SIZE, SIZE)[SIZE // 2] / 255
    return [pytest.approx(row[SIZE // 2 + round(3 * radius)], abs=0.01) for radius in radii]


def test_each_isovalue_has_its_colour_and_opacity(image):
    prop = progiso.make_isosurface(
        image, [12, 6], color=[RED, GREEN], shade=False, opacity=[0.25, 1]
    )
    # from outside in: beside both, through the outer sphere's front and back, on the inner through
    # the outer
    through = 0.25 + 0.75 * 0.25
    assert colours(prop, 14, 9, 0) == [(0, 0, 0), (through, 0, 0), (0.25, 0.75, 0)]


def test_one_colour_and_opacity_are_everyones(image):
    prop = progiso.make_isosurface(image, (12, 6), color=BLUE, shade=False, opacity=0.5)
    assert colours(prop, 9, 0) == [(0, 0, 0.75), (0, 0, 1 - 0.5**4)]


def test_a_hidden_isovalue(image):
    prop = progiso.make_isosurface(image, [12, 6], color=[RED, GREEN], shade=False, opacity=[0, 1])
    assert colours(prop, 9, 0) == [(0, 0, 0), GREEN]


def test_a_changed_isovalue_keeps_colour_and_opacity(image):
    """It keeps them where it passes another isovalue, and where both are equal on the way."""
    prop = progiso.make_isosurface(
        image, [12, 6], color=[RED, GREEN], shade=False, opacity=[0.25, 1]
    )
    values = prop.GetProperty().GetIsoSurfaceValues()
    values.SetValue(1, 12)
    values.SetValue(1, 15)
    values.SetValue(0, 3)
    assert colours(prop, 13, 0) == [GREEN, GREEN]
    values.SetValue(1, 2)
    through = 0.25 + 0.75 * 0.25
    assert colours(prop, 2.5, 0) == [(through, 0, 0), (0.25, 0.75, 0)]


def test_one_more_isovalue_starts_the_colours_again(image):
    prop = progiso.make_isosurface(image, [6, 3], color=[RED, GREEN], shade=False)
    prop.GetProperty().GetIsoSurfaceValues().SetValue(2, 12)
    prop.GetProperty().GetIsoSurfaceValues().SetValue(0, 2)
    assert colours(prop, 0, 9) == [RED, RED]


def test_a_transfer_function_gives_the_colours(image):
    function = vtkColorTransferFunction()
    function.AddRGBPoint(0, *RED)
    function.AddRGBPoint(10, *GREEN)
    prop = progiso.make_isosurface(image, 5, color=function, shade=False)
    assert colours(prop, 0) == [(0.5, 0.5, 0)]
    prop.GetProperty().GetIsoSurfaceValues().SetValue(0, 10)
    assert colours(prop, 0) == [GREEN]


WRONG = {
    "no isovalue": ({"isovalue": []}, ValueError, "isovalue: give 1 to 256"),
    "too many isovalues": (
        {"isovalue": range(257)},
        ValueError,
        "isovalue: give 1 to 256 isovalues, not 257",
    ),
    "isovalue's kind": ({"isovalue": "6"}, ValueError, "isovalue must be a finite number, got '6'"),
    "not finite": (
        {"isovalue": [6, float("nan")]},
        ValueError,
        "isovalue must be a finite number, got nan",
    ),
    "colours": ({"color": [RED] * 3}, ValueError, "color: 3 for 2 isovalues; give 1 or 2"),
    "colour's length": ({"color": (1, 0)}, ValueError, "color must be red, green and blue"),
    "colour's kind": ({"color": 5}, TypeError, "color must be red, green and blue"),
    "colour's range": ({"color": (0, 0, 255)}, ValueError, r"color must be in \[0, 1\], got 255"),
    "opacities": ({"opacity": [1, 1, 1]}, ValueError, "opacity: 3 for 2 isovalues; give 1 or 2"),
    "opacity's range": ({"opacity": [1, 1.5]}, ValueError, r"opacity must be in \[0, 1\], got 1.5"),
    "level of detail": (
        {"level_of_detail": "high"},
        ValueError,
        "level_of_detail must be 'off', 'on', 'interactive' or 'conservative', got 'high'",
    ),
    "level of detail's kind": (
        {"level_of_detail": True},
        ValueError,
        "level_of_detail must be 'off', 'on', 'interactive' or 'conservative', got True",
    ),
    "pixel tolerance": (
        {"pixel_tolerance": 0},
        ValueError,
        r"pixel_tolerance must be in \[0.0625, 64\], got 0",
    ),
    "pixel tolerance's kind": (
        {"pixel_tolerance": "1"},
        TypeError,
        "pixel_tolerance must be a number, got '1'",
    ),
    "opacity's kind": ({"opacity": "linear"}, TypeError, "opacity must be a number, got 'linear'"),
}


@pytest.mark.parametrize("case", WRONG)
def test_errors_name_what_is_wrong(image, case):
    arguments, error, message = WRONG[case]
    with pytest.raises(error, match=message):
        progiso.make_isosurface(image, **{"isovalue": [12, 6], **arguments})


def test_windows_come_and_go(image):
    """A prop goes on in another window, where its blocks are decoded again."""
    prop = progiso.make_isosurface(
        image, [12, 6], color=[RED, GREEN], shade=False, opacity=[0.25, 1]
    )
    prop.GetMapper().SetDecodeWholeVolume(False)
    through = 0.25 + 0.75 * 0.25
    for _ in range(3):
        assert colours(prop, 9, 0) == [(through, 0, 0), (0.25, 0.75, 0)]


def test_render(image):
    """Colours are given as on the command line, by name: one, or one for each isovalue."""
    camera = progiso.view_camera(image, direction=(1, 0, 0), view_up=(0, 0, 1))
    one, both = (
        progiso.render(
            image,
            isovalues,
            size=(64, 64),
            camera=camera,
            color=color,
            background="black",
            opacity=opacity,
        )
        for isovalues, color, opacity in ((6, "lime", 1), ([12, 6], ["red", "#00ff00"], [0.5, 1]))
    )
    alone, through, outside = one.image[32, 32], both.image[32, 32], both.image[32, 32 + 15]
    assert alone[1] > 150 and alone[0] < 60  # the highlight is white
    assert through[1] == pytest.approx(alone[1] / 2, abs=20) and through[0] > 60
    assert outside[0] > 60 and outside[1] < 60
