"""pyvista's server backend in Jupyter: a kernel runs a notebook, a browser gets its pictures."""

import asyncio
import importlib.util
import json
import os
import re
import sys

import numpy as np
import pytest

from progiso.measure import tolerances

pyvista = pytest.importorskip("pyvista")

SIZE = (240, 200)

SCENE = f"""
import pyvista, progiso
from helpers.images import blobs

def scene(isovalue):
    image = pyvista.ImageData(dimensions=(64, 56, 60))
    image["field"] = blobs((60, 56, 64), 12, waves=6).ravel()
    plotter = pyvista.Plotter(window_size={SIZE})
    plotter.set_background("black")
    prop = plotter.progiso.add_isosurface(image, isovalue, color="white", speculation=False)
    prop.GetMapper().SetDecodeWholeVolume(False)
    return plotter, prop
"""

# trame-vtklocal, which pyvista asks for where it is there, downloads VTK for browsers
OFFLINE = """
import sys
sys.modules["trame.widgets.vtklocal"] = None
"""

SHOW = """
plotter, prop = scene(0.1)
plotter.show(jupyter_backend="server")
"""

# As a window on a display, whose images grow: each render is to begin anew, and to end after a
# pass.
ON_SCREEN = """
plotter.render_window.SetOffScreenRendering(False)
prop.GetMapper().SetTimeAllowance(0)
plotter.render_window.AddObserver("StartEvent", lambda *_: prop.GetMapper().EmptyCache())
for _ in range(5):  # a view has to be seen to be alone in its window
    plotter.render()
plotter.camera.azimuth += 20
"""

CHANGE = """
prop.GetProperty().GetIsoSurfaceValues().SetValue(0, 0.4)
plotter.render()
"""

TELL = """
import json
camera = plotter.camera
told = {name: getattr(camera, name) for name in ("position", "focal_point", "up", "view_angle")}
print(json.dumps(dict(camera=told, off_screen=bool(plotter.render_window.GetOffScreenRendering()))))
"""


class Notebook:
    """A notebook whose cells run in a kernel one by one, for an `async with` statement."""

    def __init__(self):
        import nbclient
        import nbformat

        self._new_cell = nbformat.v4.new_code_cell
        self._notebook = nbformat.v4.new_notebook()
        self._client = nbclient.NotebookClient(self._notebook, timeout=60, kernel_name="python3")

    async def __aenter__(self):
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        self._kernel = self._client.async_setup_kernel(env=environment)
        await self._kernel.__aenter__()
        return self

    async def __aexit__(self, *exception):
        await self._kernel.__aexit__(*exception)

    async def run(self, source):
        """Run a cell; return what it printed."""
        self._notebook.cells.append(self._new_cell(source))
        cell = await self._client.async_execute_cell(
            self._notebook.cells[-1], len(self._notebook.cells) - 1
        )
        self.outputs = cell.outputs
        return "".join(
            output.text
            for output in cell.outputs
            if output.output_type == "stream" and output.name == "stdout"
        )

    def page(self):
        """Return the address of the page in the widget that the last cell displayed."""
        (shown,) = [output.data for output in self.outputs if output.output_type == "display_data"]
        widget = shown["application/vnd.jupyter.widget-view+json"]["model_id"]
        return re.search('src="([^"]+)"', self._client.widget_state[widget]["value"]).group(1)


def complete_picture(isovalue, camera):
    """Return what is to be seen, rendered here without a display."""
    names = {}
    exec(SCENE, names)
    pyvista.OFF_SCREEN, before = True, pyvista.OFF_SCREEN
    try:
        plotter, _ = names["scene"](isovalue)
    finally:
        pyvista.OFF_SCREEN = before
    for name, value in camera.items():
        setattr(plotter.camera, name, value)
    plotter.renderer.ResetCameraClippingRange()
    picture = plotter.screenshot(return_img=True)
    plotter.close()
    return picture


async def look(on_screen):
    """Show, turn, change the isovalue; return what came to the browser, and what was to come."""
    from helpers.browser import Browser

    found = []
    async with Notebook() as notebook:
        await notebook.run(OFFLINE + SCENE)
        await notebook.run(SHOW)
        page = notebook.page()
        if on_screen:
            await notebook.run(ON_SCREEN)
        async with Browser(page) as browser:
            steps = (
                (0.1, lambda: asyncio.sleep(0)),
                (0.1, lambda: browser.drag((0.5, 0.5), (0.6, 0.5), (0.75, 0.6))),
                (0.4, lambda: notebook.run(CHANGE)),
            )
            for isovalue, act in steps:
                await act()
                picture = await browser.last_picture()
                told = json.loads(await notebook.run(TELL))
                assert told["off_screen"] != on_screen
                found.append((picture, complete_picture(isovalue, told["camera"])))
    return found


@pytest.mark.parametrize("on_screen", [False, True])
def test_pictures_are_complete(lacking, on_screen):
    """Also in a window on a display, which trame renders once and no more.

    Pictures are taken at first, after a mouse turned the camera, and after a cell changed the
    isovalue.
    """
    for module in ("nbclient", "ipykernel", "ipywidgets", "trame_pyvista", "nest_asyncio2"):
        if not importlib.util.find_spec(module):
            lacking(f"there is no {module}")
    found = asyncio.run(asyncio.wait_for(look(on_screen), 120))
    for picture, expected in found:
        assert picture.shape == expected.shape and (expected > 100).mean() > 0.1
        assert np.abs(picture.astype(int) - expected).mean() < tolerances.JPEG_MEAN
    first, turned, changed = (picture.astype(int) for picture, _ in found)
    assert np.abs(turned - first).mean() > 5 and np.abs(changed - turned).mean() > 5
