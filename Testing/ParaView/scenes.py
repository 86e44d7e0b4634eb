"""Scenes of ParaView's sources and VTK's test data, the progressive isosurface beside Contour.

    pvpython scenes.py BUILD OUTPUT DATA [SCENE...]

BUILD holds the plugin, DATA is the folder `Data` of VTK's test data (as in the repository
pyvista/vtk-data). Writes OUTPUT/scenes.png, a contact sheet with what differs, and
OUTPUT/scenes.csv, the shares of pixels that do. Wants a display (README.md), and Pillow.
"""

import csv
import dataclasses
import math
import pathlib
import sys
from collections.abc import Callable

import numpy as np
from paraview import simple
from PIL import Image, ImageDraw
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPerlinNoise
from vtkmodules.vtkImagingHybrid import vtkSampleFunction
from vtkmodules.vtkIOImage import (
    vtkImageReader2,
    vtkMetaImageReader,
    vtkNIFTIImageReader,
    vtkSLCReader,
)
from vtkmodules.vtkIOLegacy import vtkStructuredPointsReader

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "Python/with_paraview/scripts"))
import session  # noqa: E402  (reads BUILD and OUTPUT)

DATA = pathlib.Path(sys.argv[3])
SIZE = (400, 300)
#: Grey levels by which a pixel's channel may be off and count as the same.
LEVELS = 8
#: Bits a sample: the default, and what keeps all but a float's last bits.
RATES = (8, 24)


@dataclasses.dataclass
class Scene:
    """What both ways show, and how.

    `make` returns the source. `array` is the one whose isosurface is drawn, the first where there
    is none, `color` ParaView's arguments for the one to colour by, `view` azimuth and elevation,
    `settings` properties of the progressive isosurface.
    """

    name: str
    make: Callable
    isovalues: list
    array: str = None
    color: tuple = None
    opacity: float = 1.0
    view: tuple = (30, 20)
    settings: dict = dataclasses.field(default_factory=dict)


# --- what the scenes are made of ------------------------------------------------------------------


def hand_over(image):
    """Make a source of an image that Python holds."""
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(image)
    return source


def read(reader, name):
    """Read a file of the test data by one of VTK's readers."""
    path = DATA / name
    if not path.exists():
        raise FileNotFoundError(f"{path} is missing: DATA is the folder Data of VTK's test data")
    reader.SetFileName(str(path))
    reader.Update()
    return hand_over(reader.GetOutput())


def sampled(function, size=64, half=1.0, name="values"):
    """Sample a function of x, y and z over a cube around the origin."""
    axis = np.linspace(-half, half, size)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    values = numpy_to_vtk(np.asarray(function(x, y, z), np.float32).ravel(), deep=True)
    values.SetName(name)
    image = vtkImageData()
    image.SetDimensions(size, size, size)
    image.SetSpacing(*[2 * half / (size - 1)] * 3)
    image.SetOrigin(-half, -half, -half)
    image.GetPointData().SetScalars(values)
    return image


def wavelet(half=10):
    return simple.Wavelet(WholeExtent=[-half, half] * 3)


def wavelet_with(function, name):
    """Add an array to the wavelet by ParaView's Calculator."""
    return simple.Calculator(Input=wavelet(24), Function=function, ResultArrayName=name)


def quadric(x, y, z):
    """Return VTK's example VisQuad."""
    return 0.5 * x**2 + y**2 + 0.2 * z**2 + 0.1 * y * z + 0.2 * x


def ice_cream(x, y, z):
    """Return a cone with a bitten scoop, as VTK's example of implicit Booleans."""
    cone = np.maximum(np.hypot(y, z) * np.cos(0.35) - np.sin(0.35) * (x + 0.9), x - 0.4)
    scoop = np.sqrt((x - 0.45) ** 2 + y**2 + z**2) - 0.42
    bite = np.sqrt((x - 0.6) ** 2 + y**2 + (z - 0.45) ** 2) - 0.3
    return np.maximum(np.minimum(cone, scoop), -bite)


def gyroid(x, y, z):
    """Return three periods of Schoen's gyroid."""
    a, b, c = (3 * math.pi * axis for axis in (x, y, z))
    return np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a)


def marschner_lobb(x, y, z):
    """Return Marschner and Lobb's test signal."""
    ring = np.cos(12 * math.pi * np.cos(math.pi * np.hypot(x, y) / 2))
    return (1 - np.sin(math.pi * z / 2) + 0.25 * (1 + ring)) / 2.5


def perlin():
    noise = vtkPerlinNoise()
    noise.SetFrequency(2, 2, 2)
    sample = vtkSampleFunction()
    sample.SetImplicitFunction(noise)
    sample.SetSampleDimensions(64, 64, 64)
    sample.SetModelBounds(-1, 1, -1, 1, -1, 1)
    sample.ComputeNormalsOff()
    sample.Update()
    return hand_over(sample.GetOutput())


def turned():
    """Return the quadric with axes of its own and uneven spacing."""
    image = sampled(quadric)
    image.SetSpacing(*np.multiply(image.GetSpacing(), (1.0, 1.6, 0.7)))
    c, s = math.cos(0.6), math.sin(0.6)
    image.SetDirectionMatrix(c, -s, 0, s, c, 0, 0, 0, 1)
    return hand_over(image)


def head():
    """Return the quarter of a head that VTK's medical examples show."""
    reader = vtkImageReader2()
    reader.SetFilePrefix(str(DATA / "headsq/quarter"))
    reader.SetFilePattern("%s.%d")
    reader.SetFileDimensionality(2)
    reader.SetDataByteOrderToLittleEndian()
    reader.SetDataScalarTypeToUnsignedShort()
    reader.SetDataExtent(0, 63, 0, 63, 1, 93)
    reader.SetDataSpacing(3.2, 3.2, 1.5)
    reader.Update()
    return hand_over(reader.GetOutput())


def blunt_fin():
    """Return the flow around a blunt fin, resampled: there are no data in its cylinder."""
    flow = simple.PLOT3DReader(
        FileName=str(DATA / "bluntfinxyz.bin"), QFileName=[str(DATA / "bluntfinq.bin")]
    )
    flow.Functions = [110]
    flow.UpdatePipeline()
    return simple.ResampleToImage(Input=flow, SamplingDimensions=[80, 60, 40])


def halves():
    """Return the wavelet as two blocks that share a plane of samples."""
    extents = ([-24, 0, -24, 24, -24, 24], [0, 24, -24, 24, -24, 24])
    return simple.GroupDatasets(Input=[simple.Wavelet(WholeExtent=extent) for extent in extents])


SCENES = [
    Scene("Wavelet as it comes", wavelet, [157.09]),
    Scene(
        "Wavelet, 129³: four isovalues by its map",
        lambda: wavelet(64),
        [90, 140, 190, 240],
        color=("POINTS", "RTData"),
    ),
    Scene("Wavelet, two translucent isovalues", lambda: wavelet(24), [130, 220], opacity=0.4),
    Scene(
        "Wavelet, coloured by another array",
        lambda: wavelet_with("coordsX*coordsY", "product"),
        [150],
        array="RTData",
        color=("POINTS", "product"),
    ),
    Scene(
        "Wavelet, coloured by a vector's magnitude",
        lambda: wavelet_with("coords", "place"),
        [150],
        array="RTData",
        color=("POINTS", "place", "Magnitude"),
    ),
    Scene(
        "Mandelbrot, iterations in three dimensions",
        lambda: simple.Mandelbrot(
            WholeExtent=[0, 80] * 3,
            OriginCX=[-1.75, -1.25, -1.0, 0],
            SizeCX=[2.5, 2.5, 2, 1.5],
            MaximumNumberofIterations=20,
        ),
        [8.5],
    ),
    Scene(
        "Fast Uniform Grid: squared distance",
        lambda: simple.FastUniformGrid(GenerateDistanceSquaredScalars=1),
        [60],
        array="DistanceSquared",
    ),
    Scene(
        "VisQuad: five isovalues by their map",
        lambda: hand_over(sampled(quadric)),
        [0.05, 0.25, 0.5, 0.75, 1.0],
        color=("POINTS", "values"),
        opacity=0.5,
    ),
    Scene("Ice cream: edges and a bite", lambda: hand_over(sampled(ice_cream)), [0.0]),
    Scene("Gyroid, 96³", lambda: hand_over(sampled(gyroid, 96)), [0.0]),
    Scene("Marschner-Lobb, 64³", lambda: hand_over(sampled(marschner_lobb)), [0.5]),
    Scene("Perlin noise", perlin, [0.1]),
    Scene("Quadric with axes of its own", turned, [0.4]),
    Scene(
        "headsq: skin and bone",
        head,
        [500, 1150],
        opacity=0.6,
        view=(200, 5),
    ),
    Scene("ironProt", lambda: read(vtkStructuredPointsReader(), "ironProt.vtk"), [128]),
    Scene("HeadMRVolume", lambda: read(vtkMetaImageReader(), "HeadMRVolume.mhd"), [35]),
    Scene("carotid: speed", lambda: read(vtkStructuredPointsReader(), "carotid.vtk"), [200]),
    Scene("vase", lambda: simple.OpenDataFile(str(DATA / "vase.vti")), [100], view=(30, 60)),
    Scene("hydrogen", lambda: simple.OpenDataFile(str(DATA / "hydrogen/hydrogen.vti")), [0.01]),
    Scene("neghip", lambda: read(vtkSLCReader(), "neghip.slc"), [70, 150], opacity=0.5),
    Scene("bolt", lambda: read(vtkSLCReader(), "bolt.slc"), [60], view=(30, 60)),
    Scene(
        "avg152T1, a mean brain",
        lambda: read(vtkNIFTIImageReader(), "avg152T1_RL_nifti.nii.gz"),
        [120],
    ),
    Scene("Blunt fin, resampled: samples are missing", blunt_fin, [1.5], array="Density"),
    Scene(
        "RectilinearGrid: armor plate",
        lambda: simple.OpenDataFile(str(DATA / "RectilinearGrid.vtr")),
        [0.5],
        array="Volume Fraction for Armor Plate",
        settings={"ResampleUnevenGrids": 1},
    ),
    Scene("Two blocks", halves, [150], array="RTData", color=("POINTS", "RTData")),
    Scene(
        "AMR Gaussian Pulse: cells", simple.AMRGaussianPulseSource, [0.02], array="Gaussian-Pulse"
    ),
]


# --- pictures -------------------------------------------------------------------------------------


def place(view, source, scene):
    """Look at all of a source from the scene's side."""
    x0, x1, y0, y1, z0, z1 = source.GetDataInformation().GetBounds()
    session.look(view, *scene.view)
    view.ResetCamera(x0, x1, y0, y1, z0, z1)
    view.GetActiveCamera().Zoom(1.25)


def dress(display, source, scene, view):
    """Colour a display as the scene wants, by a map over all values of the source's array."""
    if scene.color:
        simple.ColorBy(display, scene.color)
        display.SetScalarBarVisibility(view, False)
        _, name, *magnitude = scene.color
        values = source.PointData[name].GetRange(-1 if magnitude else 0)
        simple.GetColorTransferFunction(name).RescaleTransferFunction(*values)
    else:
        if display.ColorArrayName[1]:  # else ParaView 5.11 fails
            simple.ColorBy(display, None)
        display.DiffuseColor = display.AmbientColor = [0.9, 0.85, 0.7]
    display.Opacity = scene.opacity


def shoot(scene):
    """Return the pictures of Contour and of the progressive isosurface, at each of RATES."""
    view = session.make_view(SIZE)
    source = scene.make()
    source.UpdatePipeline()
    array = scene.array or source.PointData.GetArray(0).Name
    points, of = source, "POINTS"
    if array not in source.PointData.keys():
        points, of = simple.CellDatatoPointData(Input=source), "CELLS"
    contour = simple.Contour(Input=points, ContourBy=["POINTS", array])
    contour.Isosurfaces = scene.isovalues
    contour.ComputeScalars = 1
    display = simple.Show(contour, view)
    dress(display, source, scene, view)
    place(view, source, scene)
    pictures = [session.screenshot(view, "contour.png")]
    simple.Hide(contour, view)
    display = session.show_isosurface(
        source, view, IsosurfaceArray=[of, array], Isovalues=scene.isovalues, **scene.settings
    )
    dress(display, source, scene, view)
    for rate in RATES:
        display.CompressionRate = rate
        place(view, source, scene)
        pictures.append(session.screenshot(view, "isosurface.png"))
        session.check_converged(display)
    for proxy in dict.fromkeys((contour, points, source)):
        simple.Delete(proxy)
    simple.Delete(view)
    return pictures


def compare(contour, ours):
    """Return what differs, by name.

    The shares of all pixels that differ and of those that either covers, the share that only one
    of both covers, and by how many grey levels those that are covered differ in the mean.
    """
    difference = abs(contour - ours).max(axis=2)
    background = contour[0, 0]
    covered = [(abs(picture - background).max(axis=2) > LEVELS) for picture in (contour, ours)]
    either, one = covered[0] | covered[1], covered[0] ^ covered[1]
    if not covered[0].any() or not covered[1].any():
        raise RuntimeError("one of both shows nothing")
    return {
        "differ": (difference > LEVELS).mean(),
        "of surface": (difference > LEVELS)[either].mean(),
        "outline": (one & (difference > LEVELS)).mean(),
        "mean levels": difference[either].mean(),
    }


def row_of_sheet(scene, pictures, shares):
    """Draw ours, Contour and what differs (times 8), side by side under the scene's name."""
    contour, ours = pictures[0], pictures[1]
    difference = np.minimum(8 * abs(contour - ours), 255)
    strip = np.concatenate([ours, contour, difference], axis=1)[::-1].astype(np.uint8)
    strip = Image.fromarray(strip).resize((strip.shape[1] // 2, strip.shape[0] // 2), Image.LANCZOS)
    row = Image.new("RGB", (strip.width, strip.height + 18), "white")
    row.paste(strip, (0, 18))
    title = f"{scene.name}: {100 * shares['differ']:.2f} %".replace("³", "^3")
    ImageDraw.Draw(row).text((4, 3), title, fill="black")
    return row


def save_sheet(rows):
    """Save the rows in two columns."""
    half = (len(rows) + 1) // 2
    width, height = rows[0].size
    sheet = Image.new("RGB", (2 * width + 8, half * height), "white")
    for i, row in enumerate(rows):
        sheet.paste(row, ((i // half) * (width + 8), (i % half) * height))
    sheet.quantize(256).save(session.OUTPUT / "scenes.png", optimize=True)


def save_table(rows):
    """Save what differs as CSV, a line a scene."""
    with open(session.OUTPUT / "scenes.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)


def main(names):
    session.load_plugin()
    rows, table = [], []
    for scene in SCENES:
        if names and not any(name in scene.name for name in names):
            continue
        contour, *ours = pictures = shoot(scene)
        found = [compare(contour, picture) for picture in ours]
        rows.append(row_of_sheet(scene, pictures, found[0]))
        line = {"scene": scene.name, "isovalues": " ".join(map(str, scene.isovalues))}
        for rate, shares in zip(RATES, found):
            line |= {f"{what} at {rate} bits": f"{value:.5f}" for what, value in shares.items()}
        table.append(line)
        print(line, flush=True)
    save_sheet(rows)
    save_table(table)


main(sys.argv[4:])
