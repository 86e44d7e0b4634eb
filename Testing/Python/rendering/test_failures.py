"""What cannot be drawn is told once, and drawn again as soon as the cause is gone."""

import numpy as np
import pytest

from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import Scene
from progiso.oracle.caster import Camera

SHAPE = (20, 24, 28)
CAMERA = Camera((14, 12, 90), (14, 12, 10))


def with_holes():
    values = blobs(SHAPE, 3)
    values[5, 6, 7] = np.nan
    return make_image(values)


def flat():
    return make_image(blobs((1, 24, 28), 3))


def whole():
    return make_image(blobs(SHAPE, 3))


def too_many_isovalues(scene):
    values = scene.volume.GetProperty().GetIsoSurfaceValues()
    for i in range(257):
        values.SetValue(i, 0.01 * i)


def one_isovalue(scene):
    values = scene.volume.GetProperty().GetIsoSurfaceValues()
    values.SetNumberOfContours(1)
    values.SetValue(0, 0.1)


def setting(name, value):
    return lambda scene: getattr(scene.mapper, f"Set{name}")(value)


#: What makes a scene fail, the words it says, and what mends it.
FAILURES = {
    "NaN": (
        lambda s: (s.mapper.MaskNonFiniteOff(), s.mapper.SetInputData(with_holes())),
        "Mask NaN",
        lambda s: s.mapper.MaskNonFiniteOn(),
    ),
    "flat": (
        lambda s: s.mapper.SetInputData(flat()),
        "Only volumes",
        lambda s: s.mapper.SetInputData(whole()),
    ),
    "component": (setting("Component", 3), "Component is 3", setting("Component", 0)),
    "colours": (setting("ColorArrayName", "none"), '"none"', setting("ColorArrayName", None)),
    "isovalues": (too_many_isovalues, "isovalues", one_isovalue),
    "buffer": (setting("LargestBuffer", 1000), "one GPU buffer", setting("LargestBuffer", 0)),
}


@pytest.mark.parametrize("case", FAILURES)
def test_a_failure_is_told_once_until_something_changes(case):
    fail, words, mend = FAILURES[case]
    scene = Scene(whole(), 0.1, CAMERA)
    one_isovalue(scene)
    background = scene.picture()[0, 0]
    assert (scene.picture() != background).any()
    for _ in range(2):  # once mended, it is told again
        with vtk_messages() as messages:
            fail(scene)
            for _ in range(4):
                scene.renderer.GetActiveCamera().Azimuth(1)
                scene.window.Render()
        assert len(messages) == 1 and words in messages[0], messages
        assert (scene.picture() == background).all()
        with vtk_messages() as messages:
            mend(scene)
            scene.window.Render()
        assert not messages and (scene.picture() != background).any()


def test_another_change_that_does_not_help_is_told():
    scene = Scene(with_holes(), 0.1, CAMERA, MaskNonFinite=False)
    with vtk_messages() as messages:
        scene.window.Render()
        scene.mapper.SetRate(12)
        scene.window.Render()
        scene.window.Render()
    assert len(messages) == 2
