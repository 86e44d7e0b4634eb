"""Pieces of a compressed volume: each has the blocks that the whole has there."""

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkPointDataToCellData
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

import progiso
from helpers.images import make_image, noise, same_bits, samples_of
from helpers.messages import vtk_messages
from progiso import (
    vtkCompressedVolume,
    vtkImageZFPCompress,
    vtkImageZFPDecompress,
    vtkZFPWriter,
)


@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize("pieces", [2, 3, 8])
def test_pieces_hold_the_blocks_of_the_whole(pieces, cells):
    """A piece's stream decodes to the samples that the whole's does, its own and those around."""
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-13, 14, -9, 16, 2, 31)
    cell_values = vtkPointDataToCellData()
    cell_values.SetInputConnection(source.GetOutputPort())
    algorithm = vtkImageZFPCompress()
    algorithm.SetInputConnection((cell_values if cells else source).GetOutputPort())
    algorithm.SetRate(5)
    algorithm.Update()
    expected = samples_of(progiso.decompress(algorithm.GetOutput()))
    decompressor = vtkImageZFPDecompress()
    decompressor.SetInputConnection(algorithm.GetOutputPort())
    origin, covered = np.array([-13, -9, 2]), np.zeros(expected.shape, int)
    for piece in range(pieces):
        decompressor.UpdatePiece(piece, pieces, 0)
        output, volume = algorithm.GetOutput(), vtkCompressedVolume()
        assert volume.Read(output), volume.GetErrorMessage()
        own = np.reshape(output.GetExtent(), (3, 2)) - origin[:, None]
        held = np.reshape(volume.GetExtent(), (3, 2)) - origin[:, None]
        assert (held[:, 0] % 4 == 0).all() and (held != [[0, 27], [0, 25], [0, 29]]).any()
        assert (held[:, 0] <= np.maximum(own[:, 0] - 1, 0)).all()
        assert (held[:, 1] >= np.minimum(own[:, 1] + 1, [27, 25, 29])).all()
        found = decompressor.GetOutput()
        assert found.GetExtent() == volume.GetExtent()
        box = tuple(slice(low, high + (0 if cells else 1)) for low, high in held[::-1])
        assert same_bits(samples_of(found), np.ascontiguousarray(expected[box]))
        covered[tuple(slice(low, high) for low, high in own[::-1])] += 1
    cell_box = tuple(slice(0, n) for n in (29, 25, 27))
    assert (covered[cell_box] == 1).all(), "every cell belongs to one piece"


@pytest.mark.parametrize("bits", [9, 64, 333, 2048])
def test_cropping_keeps_blocks_as_they_are(bits):
    """Rows of blocks may begin at any bit of a word."""
    compressed = progiso.compress(
        make_image(noise((21, 18, 30), 5), extent_start=(3, -4, 5)), rate=bits / 64
    )
    part, volume = vtkImageData(), vtkCompressedVolume()
    part.DeepCopy(compressed)
    part.SetExtent(17, 25, 5, 9, 12, 15)
    assert volume.Read(part) and not volume.Covers(part)
    volume.Crop(part.GetExtent())
    assert volume.GetExtent() == (15, 26, 4, 11, 9, 16)
    volume.Write(part)
    expected = samples_of(progiso.decompress(compressed))[7:11, 9:14, 14:23]
    assert same_bits(samples_of(progiso.decompress(part)), np.ascontiguousarray(expected))
    with vtk_messages() as messages:
        writer = vtkZFPWriter()
        writer.SetInputData(part)
        writer.SetFileName("/dev/null")
        assert writer.Write() == 0
    assert len(messages) == 1 and "piece" in messages[0]


def test_a_stream_of_another_piece_is_refused():
    compressed = progiso.compress(make_image(noise((9, 9, 9))), rate=8)
    compressed.SetExtent(4, 12, 0, 8, 0, 4)
    reader = vtkCompressedVolume()
    assert not reader.Read(compressed) and "another piece" in reader.GetErrorMessage()
