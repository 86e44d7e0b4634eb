"""Pictures against the baselines that lie beside the tests."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter

from helpers import TESTS
from progiso.measure import tolerances

BASELINES = TESTS / "baselines"


def read_png(path):
    """Return a PNG's colours [row, column, rgb], row 0 at the top."""
    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)[
        ::-1, :, :3
    ]


def write_png(pixels, path):
    """Write colours [row, column, rgb], row 0 at the top."""
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(
        numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3), deep=True)
    )
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()


def check_picture(pixels, name, config, folder):
    """Hold a picture against its baseline, or store it as that.

    Where it fails the picture is left in `folder`.
    """
    path = BASELINES / f"{name}.png"
    if config.getoption("--write-baselines"):
        BASELINES.mkdir(exist_ok=True)
        write_png(pixels, path)
        return
    assert path.exists(), (
        f"there is no baseline {path}: look at the picture, then run pytest --write-baselines"
    )
    baseline = read_png(path)
    assert pixels.shape == baseline.shape
    difference = np.abs(pixels.astype(int) - baseline).max(axis=2)
    share, mean = np.mean(difference > tolerances.IMAGE_LEVELS), difference.mean()
    if share > tolerances.IMAGE_PIXELS or mean > tolerances.IMAGE_MEAN:
        write_png(pixels, folder / f"{name}.png")
        raise AssertionError(
            f"{share:.2%} of the pixels differ, {mean:.2f} grey levels on average:"
            f" see {folder / name}.png, {path}"
        )
