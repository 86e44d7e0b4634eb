"""Complete pictures of windows in which isosurfaces show pass by pass."""

from __future__ import annotations

import functools
import weakref
from contextlib import ExitStack, contextmanager

#: A plotter's methods that take a picture of what the window holds.
_CAPTURES = ("screenshot", "write_frame", "get_image_depth")


def complete_captures(plotter):
    """Let a plotter's pictures wait until the image is complete.

    pyvista reads a window without rendering it again, and has no hook before that: the plotter's
    own methods are wrapped. trame renders a window once for each picture that a browser gets, and
    keeps its interactor from rendering: such renders are complete too.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        Prepared once, however often it is passed.
    """
    if _CAPTURES[0] in vars(plotter):
        return
    for name in _CAPTURES:
        setattr(plotter, name, _completing(plotter, name))
    if plotter.render_window is not None:
        _complete_where_nobody_refines(plotter)


def _complete_where_nobody_refines(plotter):
    """Complete every image whose window's interactor is forbidden to render the next."""
    owner, renders = weakref.ref(plotter), ExitStack()  # the window holds the functions

    def start(window, _event):
        interactor = window.GetInteractor()
        if interactor is not None and not interactor.GetEnableRender():
            renders.enter_context(_complete_renders(owner()))

    plotter.render_window.AddObserver("StartEvent", start)
    plotter.render_window.AddObserver("EndEvent", lambda *_: renders.close())


def _completing(plotter, name):
    """A method of a plotter that completes the image first, and every render on the way."""
    method = getattr(type(plotter), name)
    owner = weakref.ref(plotter)  # which holds the function

    @functools.wraps(method)
    def capture(*args, **kwargs):
        plotter = owner()
        with _complete_renders(plotter):
            complete(plotter)
            return method(plotter, *args, **kwargs)

    return capture


def complete(plotter):
    """Finish the image that shows; nothing is rendered where it is complete or not shown yet."""
    window = plotter.render_window
    if window is None or window.GetNeverRendered():
        return
    shown = (prop for prop in _props(plotter) if prop.GetVisibility())
    if not all(prop.GetMapper().GetConverged() for prop in shown):
        with _complete_renders(plotter):
            window.Render()


@contextmanager
def _complete_renders(plotter):
    """Let no render inside the block end before the image is complete."""
    mappers = [prop.GetMapper() for prop in _props(plotter)]
    allowances = [mapper.GetTimeAllowance() for mapper in mappers]
    for mapper in mappers:
        mapper.SetTimeAllowance(float("inf"))
    try:
        yield
    finally:
        for mapper, allowance in zip(mappers, allowances):
            mapper.SetTimeAllowance(allowance)


def _props(plotter):
    """The isosurfaces in all of a plotter's views."""
    return [
        prop
        for renderer in plotter.renderers
        for prop in renderer.actors.values()
        if prop.IsA("vtkIsosurfaceVolume")
    ]
