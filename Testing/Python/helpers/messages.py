"""Messages that VTK reports."""

import contextlib

from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow


@contextlib.contextmanager
def vtk_messages():
    """Collect what VTK reports meanwhile, in a list that is filled at the end."""
    window, messages = vtkStringOutputWindow(), []
    before = vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        yield messages
    finally:
        vtkOutputWindow.SetInstance(before)
        messages.extend(part.strip() for part in window.GetOutput().split("\n\n") if part.strip())
