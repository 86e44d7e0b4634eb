"""Observers of the mapper and its window may do anything: the mapper survives it."""

import gc
import time

import numpy as np
import pytest
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_DOUBLE
from vtkmodules.vtkCommonCore import reference

import progiso
from helpers.comparison import OPAQUE, ComparisonScene, paint, show
from helpers.gl_hooks import gl_errors
from helpers.images import blobs, make_image
from helpers.messages import vtk_messages
from helpers.scenes import CACHED

LOADING = progiso.vtkProgressiveIsosurfaceMapper.LoadingEvent


class Trouble(Exception):
    pass


def observed(scene, event, does, on=None):
    """Add an observer that does something once; return a list that is filled when it has."""
    done = []

    def act(caller, _event):
        if not done:
            done.append(True)
            does(caller)

    (on or scene.mapper).AddObserver(event, act)
    return done


@pytest.fixture
def drawn(image):
    """Return a scene whose image takes many passes, and its picture."""
    scene = ComparisonScene(ours=True)
    show(scene, image, OPAQUE, **CACHED, SpeculationLimit=1).GetProperty().ShadeOn()
    expected = scene.picture()
    scene.mapper.EmptyCache()
    time.sleep(0.21)  # windows ask observers whether to abort five times a second
    return scene, expected


@pytest.mark.parametrize("event", ["ProgressEvent", "StartEvent", "EndEvent", "AbortCheckEvent"])
def test_an_exception_in_an_observer(drawn, event, capfd):
    """It is reported and goes no farther."""
    scene, expected = drawn

    def fail(_caller):
        raise Trouble("of the observer's own")

    target = {"ProgressEvent": scene.mapper, "StartEvent": scene.volumes[0]}.get(
        event, scene.window
    )
    done = observed(scene, event, fail, target)
    assert np.array_equal(scene.picture(), expected)
    assert done and "Trouble: of the observer's own" in capfd.readouterr().err
    assert np.array_equal(scene.picture(), expected)


def test_an_observer_aborts(drawn):
    """The next render goes on after the pass that was the last."""
    scene, expected = drawn
    done = observed(scene, "AbortCheckEvent", lambda window: window.SetAbortRender(1), scene.window)
    scene.window.Render()
    assert done and not scene.mapper.GetConverged() and scene.mapper.GetCompletedFraction() < 1
    assert scene.mapper.GetNumberOfGLErrors() == 0
    assert np.array_equal(scene.picture(), expected)


def other_window(scene, image):
    """Return a window of its own for the scene's mapper."""
    other = ComparisonScene(ours=True)
    other.look_at(image)
    volume = type(scene.volumes[0])()
    volume.SetMapper(scene.mapper)
    volume.SetProperty(scene.volumes[0].GetProperty())
    other.renderer.AddVolume(volume)
    other.renderer.ResetCameraClippingRange()
    other.volumes.append(volume)
    return other


DEEDS = {
    "renders": lambda scene, image: scene.window.Render(),
    "renders another window": lambda scene, image: ComparisonScene(ours=True).render(),
    "renders the mapper in another window": lambda scene, image: other_window(
        scene, image
    ).window.Render(),
    "releases": lambda scene, image: scene.mapper.ReleaseGraphicsResources(scene.window),
    "changes the input": lambda scene, image: scene.mapper.SetInputData(
        make_image(blobs((20, 20, 20), 3))
    ),
    "changes the size": lambda scene, image: scene.window.SetSize(60, 50),
    "changes the isovalue": lambda scene, image: paint(scene.volumes[0], {0.3: (1, 0, 0, 1)}),
    "changes the budget": lambda scene, image: scene.mapper.SetMemoryBudget(1000),
    "empties the cache": lambda scene, image: scene.mapper.EmptyCache(),
    "picks": lambda scene, image: scene.mapper.GetHit(80, 64, [0] * 3, reference(0.0)),
    "takes the mapper away": lambda scene, image: scene.volumes[0].SetMapper(None),
    "takes the input away": lambda scene, image: scene.mapper.RemoveAllInputs(),
}


def undo(scene, image, mapper, volume, size):
    """Give a scene back all that a deed may have changed, and render it."""
    volume.SetMapper(mapper)
    mapper.SetInputData(image)
    mapper.SetMemoryBudget(0)
    paint(volume, OPAQUE)
    scene.window.SetSize(*size)
    scene.render()


def check_picture(scene, expected, deed):
    """Compare the picture after a deed that is undone.

    VTK's meshes crash where they move to another window while they are rendered; OSMesa's windows
    are not drawn to after that.
    """
    if "OS" not in scene.window.GetClassName() or "mapper in another" not in deed:
        assert np.array_equal(scene.picture(), expected)


@pytest.mark.parametrize("deed", DEEDS)
def test_an_observer_does_anything_while_a_volume_loads(drawn, image, deed):
    """Before the upload, the preparation, and the passes, and in between: as above."""
    scene, expected = drawn
    mapper, volume, size = scene.mapper, scene.volumes[0], scene.window.GetSize()
    for part in range(4):
        mapper.ReleaseGraphicsResources(scene.window)
        told = []

        def act(*_, part=part, told=told):
            told.append(True)
            if len(told) == part + 1:
                DEEDS[deed](scene, image)

        observer = mapper.AddObserver(LOADING, act)
        with vtk_messages():
            scene.window.Render()
        assert len(told) > part
        mapper.RemoveObserver(observer)
        undo(scene, image, mapper, volume, size)
        check_picture(scene, expected, deed)


def test_loading_is_told(image):
    """Before its parts and at their end: of a volume, and again only of programs that are new."""
    scene = ComparisonScene(ours=True)
    volume = show(scene, image, OPAQUE)
    told = []

    @calldata_type(VTK_DOUBLE)
    def note(_caller, _event, fraction):
        told.append(fraction)

    scene.mapper.AddObserver(LOADING, note)
    scene.render()
    assert len(told) >= 5 and told == sorted(set(told)) and told[0] < 0.1 and told[-1] == 1.0
    told.clear()
    paint(volume, {0.3: (1, 0, 0, 1)})
    scene.camera.Azimuth(20)
    scene.render()
    assert not told
    paint(volume, {0.3: (1, 0, 0, 0.5)})  # translucent surfaces have programs of their own
    scene.render()
    assert len(told) >= 2 and told == sorted(told) and told[-1] == 1.0
    told.clear()
    scene.mapper.SetInputData(progiso.compress(make_image(blobs((20, 20, 20), 3)), rate=8))
    scene.render()
    assert len(told) >= 4 and told == sorted(told) and told[-1] == 1.0
    assert not gl_errors()


@pytest.mark.parametrize("event", ["ProgressEvent", "AbortCheckEvent", "StartEvent"])
@pytest.mark.parametrize("deed", DEEDS)
def test_an_observer_does_anything(drawn, image, event, deed):
    """While the mapper renders, that may spoil the picture, but nothing else.

    Undone, the picture is right.
    """
    scene, expected = drawn
    mapper, volume, size = scene.mapper, scene.volumes[0], scene.window.GetSize()
    targets = {"ProgressEvent": mapper, "AbortCheckEvent": scene.window, "StartEvent": volume}
    done = observed(scene, event, lambda _: DEEDS[deed](scene, image), targets[event])
    with vtk_messages():
        scene.window.Render()
    assert done
    undo(scene, image, mapper, volume, size)
    check_picture(scene, expected, deed)


def test_an_observer_drops_the_last_reference(drawn):
    """The mapper lives on until its render has ended."""
    scene, _ = drawn
    observed(scene, "ProgressEvent", lambda _: scene.volumes.pop().SetMapper(None))
    scene.window.Render()
    gc.collect()
    assert not gl_errors()
