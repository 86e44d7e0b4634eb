"""Scenes in which something is made to fail."""

import os
import subprocess
import sys

import numpy as np

from helpers.comparison import OPAQUE, ComparisonScene, picture_of, show
from helpers.messages import vtk_messages


def compiled_scene(image, settings, surfaces=OPAQUE):
    """Return a scene whose shaders stay compiled, as another volume holds them."""
    scene = ComparisonScene(ours=True, size=(64, 48))
    for _ in range(2):
        show(scene, image, surfaces, **settings).GetProperty().ShadeOn()
    scene.render()
    scene.volumes.pop().VisibilityOff()
    scene.render()
    return scene


def messages_of(scene):
    """Render; return what VTK reports, and the picture."""
    with vtk_messages() as messages:
        scene.window.Render()
    return messages, picture_of(scene.window)


def is_empty(picture):
    """Tell whether a picture shows nothing but its background."""
    return np.ptp(picture.reshape(-1, 3), axis=0).max() == 0


def run_program(program, file=None, **environment):
    """Run a program in a process of its own; return what it prints."""
    program = program.format(path=[path for path in sys.path if path], file=file)
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout
