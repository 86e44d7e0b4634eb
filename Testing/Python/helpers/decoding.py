"""Decoding on the GPU, held against libzfp."""

import contextlib

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow

from helpers.images import reference_values
from progiso import vtkProgressiveIsosurfaceMapper


@contextlib.contextmanager
def small_window():
    """Yield a window that has been rendered, so that there is a context to decode in."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(16, 16)
    window.AddRenderer(vtkRenderer())
    window.Render()
    yield window
    window.Finalize()


def check_decoding(window, image):
    """Decode on the GPU; every bit must be libzfp's."""
    got = vtkFloatArray()
    mapper = vtkProgressiveIsosurfaceMapper()
    mapper.DecodeOnGPU(window, image, got)
    expected = reference_values(image).ravel()
    got = vtk_to_numpy(got)
    assert got.shape == expected.shape
    wrong = np.flatnonzero(got.view(np.uint32) != expected.view(np.uint32))
    assert len(wrong) == 0, (
        f"{len(wrong)} of {len(got)} samples, first at {wrong[0]}:"
        f" {got[wrong[0]]!r}, not {expected[wrong[0]]!r}"
    )
