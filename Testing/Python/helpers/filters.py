"""Filters that are run for a test."""

from helpers.messages import vtk_messages
from progiso import vtkImageZFPCompress


def update(algorithm):
    """Update an algorithm; return its output and what VTK had to say."""
    with vtk_messages() as messages:
        algorithm.Update()
    return algorithm.GetOutputDataObject(0), messages


def compressor(image, rate=8, **settings):
    """Return the filter that compresses an image, with its settings."""
    algorithm = vtkImageZFPCompress()
    algorithm.SetInputData(image)
    algorithm.SetRate(rate)
    for name, value in settings.items():
        getattr(algorithm, "Set" + name)(value)
    return algorithm
