"""Composite data sets on a server of two processes: the pictures of one process. Blocks are in
pieces there, or belong to one of the processes as a whole."""

import server
import session
from paraview import simple

PROCESSES = 2
#: Grey levels, and the share of pixels that may differ by more: light at the seams of pieces.
LEVELS, SHARE = 16, 5e-3


def make_sources():
    """Return sources by name, with the array and the isovalue to show."""
    halves = [
        simple.Wavelet(WholeExtent=[-10, 0, -10, 10, -10, 10]),
        simple.Wavelet(WholeExtent=[0, 10, -10, 10, -10, 10]),
    ]
    blocks = simple.GroupDatasets(Input=halves)
    values = ["POINTS", "RTData"], 157.0
    return {
        "blocks": (blocks, *values),
        "collection": (
            simple.GroupDatasets(Input=halves, OutputType="vtkPartitionedDataSetCollection"),
            *values,
        ),
        "cells": (simple.PointDatatoCellData(Input=blocks), ["CELLS", "RTData"], 157.0),
        "amr": (simple.AMRGaussianPulseSource(), ["CELLS", "Gaussian-Pulse"], 0.2),
        "compressed": (simple.ZFPCompress(Input=halves[0], Rate=16), *values),
    }


def show_all(place):
    """Return pictures, opaque and translucent, and the number of processes that drew, by name."""
    view = session.make_view([200, 150])
    found = {}
    for name, (source, array, isovalue) in make_sources().items():
        display = session.show_isosurface(
            source, view, Isovalues=[isovalue], CompressionRate=16, ColorArrayName=[None, ""]
        )
        if name != "compressed":
            display.IsosurfaceArray = array
        session.look(view)
        opaque = session.screenshot(view, f"remote_{name}_{place}.png")
        processes = session.check_converged(display)["processes"]
        display.Opacity = 0.4
        translucent = session.screenshot(view, f"remote_{name}_{place}_translucent.png")
        found[name] = opaque, translucent, processes
        simple.Hide(source, view)
    return found


session.load_plugin()
here = show_all("here")
with server.connected(PROCESSES):
    there = show_all("there")
seen = {}
for name, (*pictures, _) in here.items():
    for kind, one, two in zip(("opaque", "translucent"), pictures, there[name], strict=False):
        differing = float((abs(one - two).max(axis=2) > LEVELS).mean())
        assert session.covered(one) > 0.01, name
        if name != "amr" or kind == "opaque":  # its source gives every process all blocks
            seen[f"{name}, {kind}"] = differing
for name, differing in seen.items():
    assert differing <= SHARE, f"{name}: {differing}"
assert there["blocks"][2] == PROCESSES
session.finish(**seen)
