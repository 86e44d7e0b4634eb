"""Composite data sets of images, and rectilinear grids: the surface that ParaView's Contour has."""

import session
from paraview import simple

view = session.start()
LOOK = {"DiffuseColor": [0.9, 0.85, 0.7], "ColorArrayName": [None, ""]}
#: Grey levels, and the share of the surface's pixels that may differ by more: its edges.
LEVELS, SHARE = 24, 0.04


def show_contour(source, array, isovalue, name, **properties):
    """Return the picture of ParaView's Contour."""
    if array[0] == "CELLS":
        source = simple.CellDatatoPointData(Input=source)
    contour = simple.Contour(Input=source, ContourBy=["POINTS", array[1]], Isosurfaces=[isovalue])
    display = simple.Show(contour, view)
    display.SetRepresentationType("Surface")
    for key, value in {**LOOK, **properties}.items():
        setattr(display, key, value)
    session.look(view)
    pixels = session.screenshot(view, f"blocks_{name}_contour.png")
    simple.Hide(contour, view)
    return pixels


def check_like_contour(source, array, isovalue, name, settings=(), most=SHARE, **properties):
    """Check that a source looks as its contour; return its figures."""
    expected = show_contour(source, array, isovalue, name, **properties)
    with session.messages() as listener:
        display = session.show_isosurface(
            source,
            view,
            IsosurfaceArray=array,
            Isovalues=[isovalue],
            CompressionRate=16,
            **LOOK,
            **dict(settings),
            **properties,
        )
        pixels = session.screenshot(view, f"blocks_{name}.png")
    assert not listener.GetOutput(), f"{name}: {listener.GetOutput()}"
    simple.Hide(source, view)
    share = session.covered(expected)
    assert share > 0.05, f"{name}: {share}"
    differing = (abs(pixels - expected).max(axis=2) > LEVELS).mean()
    assert differing <= most * share, f"{name}: {differing} of {share} differ"
    return session.check_converged(display)


def rectilinear(script):
    """Return a rectilinear grid whose coordinates a script computes from -1 … 1."""
    source = simple.ProgrammableSource(OutputDataSetType="vtkRectilinearGrid")
    source.Script = f"""
from vtkmodules.util.numpy_support import numpy_to_vtk
import numpy
x, y, z = (numpy.linspace(-1, 1, n) for n in (30, 25, 28))
{script}
output.SetDimensions(30, 25, 28)
output.SetXCoordinates(numpy_to_vtk(x, deep=1))
output.SetYCoordinates(numpy_to_vtk(y, deep=1))
output.SetZCoordinates(numpy_to_vtk(z, deep=1))
z, y, x = numpy.meshgrid(z, y, x, indexing="ij")
output.PointData.append((x * x + 2 * y * y + z * z + 0.3 * numpy.sin(6 * x)).ravel(), "v")
"""
    return source


halves = [
    simple.Wavelet(WholeExtent=[-10, 0, -10, 10, -10, 10]),
    simple.Wavelet(WholeExtent=[0, 10, -10, 10, -10, 10]),
]
alone = check_like_contour(simple.Wavelet(), ["POINTS", "RTData"], 157.0, "image")
grouped = {
    kind: simple.GroupDatasets(Input=halves, OutputType=f"vtk{kind}")
    for kind in ("MultiBlockDataSet", "PartitionedDataSet", "PartitionedDataSetCollection")
}
for kind, source in grouped.items():
    info = check_like_contour(source, ["POINTS", "RTData"], 157.0, kind)
    # blocks share the budget, and count together
    assert info["budget"] < 1.01 * alone["budget"], (info, alone)
    assert info["bytes"] > alone["bytes"] and info["processes"] == 1, (info, alone)
blocks = grouped["MultiBlockDataSet"]
check_like_contour(blocks, ["POINTS", "RTData"], 157.0, "translucent", Opacity=0.4)
cells = simple.PointDatatoCellData(Input=blocks)
check_like_contour(cells, ["CELLS", "RTData"], 157.0, "cells")
extracted = simple.ExtractBlock(Input=blocks, Selectors=["/Root/Block1", "/Root/Wavelet2"])
check_like_contour(extracted, ["POINTS", "RTData"], 157.0, "extracted")
amr = simple.AMRGaussianPulseSource()
# Contour's facets of a coarse level are seen, ours not
check_like_contour(amr, ["CELLS", "Gaussian-Pulse"], 0.2, "amr", most=0.1)

# blocks without the isovalue cost nothing
far = simple.GroupDatasets(
    Input=[simple.Wavelet(WholeExtent=[-10, 0, -10, 10, -10, 10], Maximum=40.0), halves[1]]
)
display = session.show_isosurface(far, view, Isovalues=[157.0])
session.screenshot(view, "blocks_one_of_two.png")
assert 0.4 < session.check_converged(display)["budget"] / alone["budget"] < 0.6
display.Isovalues = [157.0, 20.0]
session.screenshot(view, "blocks_both.png")
assert session.check_converged(display)["budget"] > 0.9 * alone["budget"]
simple.Hide(far, view)

# a selected cell is that of the block that is seen there
display = session.show_isosurface(blocks, view, Isovalues=[157.0])
session.look(view, azimuth=0, elevation=0)
for block, column in ((1, 140), (2, 180)):
    simple.SelectSurfaceCells(Rectangle=[column, 112, column, 112], View=view)
    (selected,) = blocks.GetSelectionInput(0).Input
    assert list(selected.IDs)[0] == block, (block, list(selected.IDs))
    simple.ClearSelection(blocks)
simple.Hide(blocks, view)

# another array's colours; where a block lacks it, the solid colour
coloured = simple.Calculator(Input=blocks, ResultArrayName="right", Function="coordsX")
display = session.show_isosurface(
    coloured, view, IsosurfaceArray=["POINTS", "RTData"], Isovalues=[157.0]
)
simple.ColorBy(display, ("POINTS", "right"))
display.SetScalarBarVisibility(view, False)
session.look(view, azimuth=0, elevation=0)
pixels = session.screenshot(view, "blocks_coloured.png")
middle = pixels.shape[1] // 2
left, right = (half - pixels[0, 0] for half in (pixels[:, :middle], pixels[:, middle:]))
assert left[..., 2].mean() > left[..., 0].mean() and right[..., 0].mean() > right[..., 2].mean()
simple.Hide(coloured, view)

check_like_contour(rectilinear("z = 2 * z"), ["POINTS", "v"], 0.8, "even")
uneven = rectilinear("x = x**3; z = z * numpy.exp(z)")
with session.messages() as listener:
    session.show_isosurface(uneven, view)
    assert session.covered(session.screenshot(view, "blocks_refused.png")) == 0.0
assert listener.GetOutput().count("Progressive Isosurface:") == 1, listener.GetOutput()
assert "Resample Uneven Grids" in listener.GetOutput()
check_like_contour(
    uneven, ["POINTS", "v"], 0.8, "uneven", settings={"ResampleUnevenGrids": 1}.items()
)
session.finish(alone=alone)
