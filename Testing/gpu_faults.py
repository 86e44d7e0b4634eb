"""On a machine with a GPU: fill its memory, render, free it, render again.

Prints JSON with a verdict, exits with 1 if bad.

Run it with a Python that has progiso: ``.venv/bin/python Testing/gpu_faults.py``, or
``progiso-bundle/run Testing/gpu_faults.py``. Where the `python3` on the path has torch with CUDA
that holds the memory (as another program would), else textures do. With its memory full the GPU may
still serve an image, from the host's; what must not happen is a wrong image, a crash, or no good
image afterwards.
"""

import argparse
import json
import subprocess
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_FLOAT
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
from vtkmodules.vtkRenderingOpenGL2 import vtkTextureObject

import progiso
from progiso.bench.fields import compressed, parse_field
from progiso.measure.machine import gpu_bytes

# Takes memory in ever smaller pieces until there is none, and holds it until its input ends.
HOLD = """
import sys, torch
held, piece = [], 1 << 30
while piece >= 1 << 20:
    try:
        held.append(torch.zeros(piece, dtype=torch.uint8, device="cuda"))
    except torch.OutOfMemoryError:
        piece //= 2
torch.cuda.synchronize()
print(sum(t.numel() for t in held), flush=True)
sys.stdin.read()
"""


def hold_by_torch():
    """Fill the memory from another process; None where that cannot be."""
    try:
        process = subprocess.Popen(
            ["python3", "-c", HOLD],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
    except OSError:
        return None
    held = process.stdout.readline().strip()
    if not held:
        process.communicate()
        return None
    return f"{held} bytes by torch", process.communicate


def hold_by_textures(window, most):
    """Fill the memory with textures of a GiB, `most` at most, as long as they can be made."""
    textures = []
    while len(textures) < most:
        texture = vtkTextureObject()
        texture.SetContext(window)
        if not texture.Allocate3D(1024, 512, 512, 1, VTK_FLOAT):
            break
        textures.append(texture)

    def free():
        for texture in textures:
            texture.ReleaseGraphicsResources(window)
        textures.clear()

    return f"{len(textures)} GiB by textures", free


class Scene:
    """A volume in a window, and what its renders report."""

    def __init__(self, image, isovalue, size):
        self.prop = progiso.make_isosurface(image, isovalue)
        self.mapper = self.prop.GetMapper()
        self.mapper.AddObserver("ErrorEvent", lambda _mapper, _event: self.errors.append("error"))
        self.errors = []
        renderer = vtkRenderer()
        renderer.AddViewProp(self.prop)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(renderer)
        progiso.orbit_camera(image, 1, 5).apply(renderer.GetActiveCamera())
        renderer.ResetCameraClippingRange()

    def render(self):
        """Render anew, from nothing; return the picture and the number of errors."""
        self.errors.clear()
        self.prop.ReleaseGraphicsResources(self.window)
        self.window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        grab.Update()
        return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).copy(), len(self.errors)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--field", default="gyroid-512-k12-r4", help="the volume (default: %(default)s)"
    )
    parser.add_argument(
        "--textures",
        type=int,
        metavar="N",
        help="fill with textures, N at most, whether there is torch or not",
    )
    parsed = parser.parse_args()
    field = parse_field(parsed.field)
    scene = Scene(compressed(field), field.isovalues[0], (1280, 720))
    before, errors = scene.render()
    found = {
        "field": field.name,
        "gl": scene.mapper.GetStatistics().GetGLDescription(),
        "errors_before": errors,
    }
    scene.prop.ReleaseGraphicsResources(scene.window)
    how, free = (parsed.textures is None and hold_by_torch()) or hold_by_textures(
        scene.window, parsed.textures or 1 << 10
    )
    found |= {"filled": how, "in_use": gpu_bytes()}
    full, errors = scene.render()
    empty = bool(np.ptp(full, axis=0).max() == 0)
    same = bool(np.array_equal(full, before))
    found["full"] = {"errors": errors, "picture": "right" if same else "none" if empty else "wrong"}
    free()
    after, errors = scene.render()
    found["freed"] = {
        "errors": errors,
        "picture": "right" if np.array_equal(after, before) else "wrong",
    }
    served = same and found["full"]["errors"] == 0
    refused = empty and found["full"]["errors"] == 1
    good = (
        np.ptp(before, axis=0).max() > 50
        and (served or refused)
        and found["freed"] == {"errors": 0, "picture": "right"}
    )
    found["verdict"] = "good" if good else "bad"
    print(json.dumps(found, indent=1))
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
