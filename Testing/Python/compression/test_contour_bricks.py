"""A volume is contoured brick by brick and by several threads: neither shows; memory is bounded."""

import numpy as np
import pytest
from vtkmodules.vtkCommonCore import vtkSMPTools

import progiso
from helpers.images import blobs, make_image, metadata
from helpers.surfaces import check_same_surface, contour_by, contoured, corners_of, points_of
from progiso import vtkZFPContour


def test_threads_do_not_show():
    """Neither threads nor VTK's backend change even the order of points and triangles."""
    volume = progiso.compress(make_image(blobs((50, 40, 60), 4, waves=6)), rate=6)
    first = contoured(volume, [0.1, 0.3], 8, threads=1)
    before = vtkSMPTools.GetBackend()
    try:
        for backend in ("Sequential", "STDThread"):
            vtkSMPTools.SetBackend(backend)
            for threads in (0, 2, 5):
                other = contoured(volume, [0.1, 0.3], 8, threads)
                assert np.array_equal(points_of(other), points_of(first))
                assert np.array_equal(corners_of(other), corners_of(first))
                assert vtkSMPTools.GetBackend() == backend
    finally:
        vtkSMPTools.SetBackend(before)


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_memory_is_that_of_a_brick_a_thread(threads):
    """Memory does not depend on the volume's size.

    A brick of 32 cells takes a sample more, one on either side, and whole blocks: 40 samples a
    side.
    """
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(32)
    algorithm.SetNumberOfThreads(threads)
    surface = contour_by(
        algorithm, progiso.compress(make_image(blobs((130, 140, 150), 5)), rate=4), [0.1]
    )
    assert surface.GetNumberOfPolys() > 10_000
    brick = 4 * 40**3
    assert brick <= algorithm.GetPeakSampleBytes() <= threads * brick < 4 * 130 * 140 * 150


def test_bricks_are_decoded_when_they_hold_an_isovalue():
    """Every brick is decoded once, then only those that another isovalue needs."""
    z = np.broadcast_to(np.arange(65.0)[:, None, None], (65, 33, 33))
    algorithm = vtkZFPContour()
    algorithm.SetBrickSize(16)
    volume = progiso.compress(make_image(z), rate=32)
    contour_by(algorithm, volume, [3.5])
    assert algorithm.GetNumberOfDecodedBricks() == algorithm.GetNumberOfBricks() == 2 * 2 * 4
    for isovalues, layers in (([20.5], 1), ([20.5, 60.25], 2), ([1000, -1], 0)):
        contour_by(algorithm, volume, isovalues)
        assert algorithm.GetNumberOfDecodedBricks() == 4 * layers
    check_same_surface(contour_by(algorithm, volume, [16, 40.5]), contoured(volume, [16, 40.5], 16))
    contour_by(algorithm, progiso.compress(make_image(z), rate=16), [20.5])
    assert algorithm.GetNumberOfDecodedBricks() == 16


def test_brick_sizes_are_multiples_of_four():
    algorithm = vtkZFPContour()
    for asked, taken in ((1, 4), (35, 32), (36, 36), (10_000, 256)):
        algorithm.SetBrickSize(asked)
        assert algorithm.GetBrickSize() == taken


def test_progress_rises_in_the_calling_thread():
    seen = []
    volume = progiso.compress(make_image(blobs((257, 129, 129))), rate=2)
    progiso.contour(volume, 0.1, threads=1, progress=seen.append)
    assert len(seen) >= 2 and seen == sorted(seen) and seen[-1] == 1


def test_unaligned_memory():
    """A stream in someone's NumPy array may begin at any byte."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData

    volume = progiso.compress(make_image(blobs((20, 20, 20))), rate=8)
    stream = metadata(volume, "Stream")
    shifted = np.empty(len(stream) + 16, np.uint8)
    shifted = shifted[(3 - shifted.ctypes.data) % 8 :][: len(stream)]
    shifted[:] = stream
    array = numpy_to_vtk(shifted)
    array.SetName("ProgIso.ZFP.Stream")
    moved = vtkImageData()
    moved.ShallowCopy(volume)
    moved.GetFieldData().AddArray(array)
    check_same_surface(contoured(moved, [0.1]), contoured(volume, [0.1]))
