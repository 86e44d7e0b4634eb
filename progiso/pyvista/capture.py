"""Complete pictures of windows in which images refine pass by pass."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pyvista

from ..vtkProgIsoKernels import vtkIsosurfaceVolume

#: A plotter's methods that take a picture of what the window holds.
_CAPTURES = ("screenshot", "write_frame", "get_image_depth")


def complete_captures(plotter: pyvista.BasePlotter) -> None:
    """Make a plotter's pictures wait until the image is complete.

    pyvista reads a window without rendering it again, and has no hook before that: so the
    plotter's own methods are wrapped. trame renders a window once for each picture that a browser
    gets, and keeps its interactor from rendering: such renders are made complete, too.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        Prepared once, however often it is passed.
    """
    if _CAPTURES[0] in vars(plotter):
        return
    for name in _CAPTURES:
        setattr(plotter, name, _completing(plotter, name))
    _complete_where_nobody_refines(plotter)


def _complete_where_nobody_refines(plotter: pyvista.BasePlotter) -> None:
    """Complete every image whose window's interactor may not render the next one."""
    window = plotter.render_window
    if window is None:
        return
    owner, renders = weakref.ref(plotter), ExitStack()  # the window keeps the functions

    def start(window: Any, _event: object) -> None:
        interactor = window.GetInteractor()
        plotter = owner()
        if plotter is None or interactor is None or interactor.GetEnableRender():
            return
        renders.enter_context(_complete_renders(plotter))

    window.AddObserver("StartEvent", start)
    window.AddObserver("EndEvent", lambda *_: renders.close())


def _completing(plotter: pyvista.BasePlotter, name: str) -> Callable[..., Any]:
    """Wrap a method of a plotter so that it completes the image first, and every render in it."""
    method = getattr(type(plotter), name)
    owner = weakref.ref(plotter)  # the plotter keeps the function

    @functools.wraps(method)
    def capture(*args: Any, **kwargs: Any) -> Any:
        plotter = owner()
        assert plotter is not None  # whose method this is
        with _complete_renders(plotter):
            complete(plotter)
            return method(plotter, *args, **kwargs)

    return capture


def complete(plotter: pyvista.BasePlotter) -> None:
    """Finish the image that shows, unless it is complete or not shown yet."""
    window = plotter.render_window
    if window is None or window.GetNeverRendered():
        return
    shown = (prop for prop in _props(plotter) if prop.GetVisibility())
    if not all(prop.GetMapper().GetConverged() for prop in shown):
        with _complete_renders(plotter):
            window.Render()


@contextmanager
def _complete_renders(plotter: pyvista.BasePlotter) -> Iterator[None]:
    """Make every render inside the block end with a complete image."""
    mappers = [prop.GetMapper() for prop in _props(plotter)]
    allowances = [mapper.GetTimeAllowance() for mapper in mappers]
    for mapper in mappers:
        mapper.SetTimeAllowance(float("inf"))
    try:
        yield
    finally:
        for mapper, allowance in zip(mappers, allowances):
            mapper.SetTimeAllowance(allowance)


def _props(plotter: pyvista.BasePlotter) -> list[vtkIsosurfaceVolume]:
    """List the isosurfaces in all of a plotter's views."""
    return [
        prop
        for renderer in plotter.renderers
        for prop in renderer.actors.values()
        if prop.IsA("vtkIsosurfaceVolume")
    ]
