"""Damaged streams and hostile metadata: the image is wrong, but complete and repeatable, or there
is one clear error; never one of OpenGL."""

import subprocess
import sys

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable

import progiso
from helpers.decoding import check_decoding, small_window
from helpers.images import (
    PREFIX,
    blobs,
    make_image,
    metadata,
    noise,
    reference_values,
    without_checksums,
    without_ranges,
)
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget
from progiso import vtkCompressedVolume
from progiso.oracle import zfp_reference
from progiso.oracle.caster import Camera

SHAPE = (36, 40, 44)
CAMERA = Camera((90.0, 70.0, 110.0), (21.5, 19.5, 17.5), view_angle=30.0)
SIZE = (80, 60)

# Rays that wait take one more pass for each block along them whose turn has come, few even where
# all blocks are active.
MOST_PASSES = 400


def flip(stream, rng):
    for bit in rng.integers(0, 8 * len(stream), len(stream) // 20):
        stream[bit // 8] ^= 1 << (bit % 8)


def truncate(stream, rng):
    stream[len(stream) // 2 :] = 0


def fill(value):
    def change(stream, rng):
        stream[:] = value

    return change


def randomize(stream, rng):
    stream[:] = rng.integers(0, 256, len(stream), np.uint8)


def brighten(stream, rng):
    """Give every seventh block the largest exponent, whose larger values float32 does not hold."""
    blocks = len(stream) * 8 // 512
    stream.reshape(blocks, 64)[::7, :2] = 0xFF


DAMAGE = {
    "bits flipped": flip,
    "truncated and padded": truncate,
    "all ones": fill(255),
    "all zeros": fill(0),
    "random": randomize,
    "infinite": brighten,
}


@pytest.fixture(scope="module")
def window():
    with small_window() as window:
        yield window


@pytest.fixture(scope="module", params=DAMAGE)
def damaged(request):
    """Return a compressed volume with a damaged stream, and an isovalue in the middle of what
    libzfp decodes of it."""
    image = without_ranges(progiso.compress(make_image(blobs(SHAPE, 3)), rate=8))
    stream = vtk_to_numpy(image.GetFieldData().GetAbstractArray(PREFIX + "Stream"))
    DAMAGE[request.param](
        stream, np.random.default_rng(5)
    )  # in place: the array is the image's own
    values = reference_values(image)
    assert (
        np.isinf(values).any() == (request.param in ("all ones", "random", "infinite"))
        and not np.isnan(values).any()
    )
    finite = values[np.isfinite(values)]
    return image, float(np.median(finite[np.abs(finite) > 0.05])) if (finite != 0).any() else 0.1


def shows(image, isovalues, opacity=1.0, **settings):
    """Render twice, check that the images are the same, return picture and depth."""
    results = []
    for _ in range(2):
        scene = Scene(image, isovalues[0], CAMERA, SIZE, lit=True, **settings)
        surface = scene.volume.GetProperty()
        for i, value in enumerate(isovalues):
            surface.GetIsoSurfaceValues().SetValue(i, value)
        surface.GetScalarOpacity().AddPoint(0, opacity)
        depth = scene.depth()
        assert len(scene.statistics()["passes"]) < MOST_PASSES
        results.append((scene.picture().tobytes(), depth.tobytes()))
    assert results[0] == results[1]
    return results[0]


def test_decoded_as_libzfp_does(damaged, window):
    check_decoding(window, damaged[0])


def test_decoded_whole_and_by_the_smallest_cache(damaged):
    image, isovalue = damaged
    budget = least_budget(image, isovalue, CAMERA, SIZE)
    whole = shows(image, [isovalue])
    assert shows(image, [isovalue], MemoryBudget=budget) == whole
    assert shows(image, [isovalue], SpeculationLimit=1, **CACHED) == whole


def test_several_isovalues(damaged):
    image, isovalue = damaged
    isovalues = [isovalue, -isovalue, 0.0, 1e30]
    assert shows(image, isovalues, **CACHED) == shows(image, isovalues)


def test_translucent(damaged):
    image, isovalue = damaged
    isovalues = [isovalue, 0.01]
    assert shows(image, isovalues, 0.3, **CACHED) == shows(image, isovalues, 0.3)


def test_colors(damaged):
    """The damaged volume colours another, and itself."""
    image, isovalue = damaged
    good = progiso.compress(make_image(blobs(SHAPE, 4)), rate=8)
    table = vtkLookupTable()
    for shown, value in ((good, 0.1), (image, isovalue)):
        looks = {"ColorInputData": image, "ColorLookupTable": table}
        assert shows(shown, [value], **looks, **CACHED) == shows(shown, [value], **looks)


def infinite_block(sign):
    """Find bits of a block of the largest exponent that libzfp decodes to infinite values of one
    sign, among others."""
    rng = np.random.default_rng(1)
    while True:  # a few times
        bits = np.append(np.array([255, 255], np.uint8), rng.integers(0, 256, 254, np.uint8))
        values = zfp_reference.decode(bits.tobytes(), (4, 4, 4), 2048)
        if np.isinf(values).any() and np.isfinite(np.maximum(-sign * values, 0)).all():
            return bits


@pytest.mark.parametrize("sign", [-1, 1])
def test_infinite_values_hide_no_other_surface(sign):
    """Other blocks of a macrocell with infinite values are shown as before."""
    image = progiso.compress(make_image(blobs((16, 16, 16), 5)), rate=32)
    camera = Camera((40.0, 45.0, 50.0), (7.5, 7.5, 7.5), view_angle=25.0)
    before = Scene(image, 0.1, camera, SIZE).depth()
    metadata(image, "Stream")[:256] = infinite_block(sign)
    after = Scene(image, 0.1, camera, SIZE).depth()
    unaffected = before < np.linalg.norm(
        np.subtract(camera.position, (4, 4, 4))
    )  # nearer than that block
    assert unaffected.mean() > 0.1
    assert np.array_equal(before[unaffected], after[unaffected])


@pytest.mark.parametrize("low, high", [(0, 1e-30), (-1e30, 1e30), (7, 8), (-1e300, 1e300)])
def test_lying_range(low, high):
    """The range of values is for users; nothing is left out by it."""
    image = progiso.compress(make_image(noise((12, 12, 12))), rate=8)
    expected = shows(image, [1.0], **CACHED)
    metadata(without_checksums(image), "Range")[:] = low, high
    assert shows(image, [1.0], **CACHED) == expected


# --- metadata -------------------------------------------------------------------------------------

NAN, INFINITY = float("nan"), float("inf")
GEOMETRIES = {
    "spacing NaN": lambda image: image.SetSpacing(1, NAN, 1),
    "spacing zero": lambda image: image.SetSpacing(1, 1, 0),
    "spacing infinite": lambda image: image.SetSpacing(INFINITY, 1, 1),
    "spacing too large": lambda image: image.SetSpacing(1e300, 1e300, 1e300),
    "spacing too small": lambda image: image.SetSpacing(1e-200, 1e-200, 1e-200),
    "origin NaN": lambda image: image.SetOrigin(NAN, 0, 0),
    "origin infinite": lambda image: image.SetOrigin(0, 0, -INFINITY),
    "flat directions": lambda image: image.SetDirectionMatrix(1, 0, 0, 1, 0, 0, 0, 0, 1),
    "no directions": lambda image: image.SetDirectionMatrix(*[0] * 9),
}


@pytest.mark.parametrize("case", GEOMETRIES)
def test_geometry(case):
    """Where rays would have no end there is one error and nothing is drawn."""
    image = progiso.compress(make_image(noise((9, 9, 9))), rate=8)
    scene = Scene(image, 1.0, CAMERA, SIZE, **CACHED)
    scene.renderer.GetActiveCamera().SetClippingRange(0.1, 500)
    scene.window.Render()
    empty = scene.picture()
    assert (empty != empty[0, 0]).any()
    GEOMETRIES[case](image)
    assert progiso.vtkCompressedVolume.Place(image)
    scene.renderer.GetActiveCamera().SetClippingRange(0.1, 500)
    with vtk_messages() as messages:
        scene.window.Render()
    assert len(messages) == 1 and "finite" in messages[0], messages
    picture = scene.picture()
    assert (picture == picture[0, 0]).all()
    assert scene.mapper.GetNumberOfGLErrors() == 0


def replace(image, name, values):
    array = numpy_to_vtk(np.array(values), deep=True)
    array.SetName(PREFIX + name)
    image.GetFieldData().AddArray(array)


METADATA = {
    "version": (lambda image: replace(image, "Version", [9]), "version 9"),
    "rate negative": (lambda image: replace(image, "BlockBits", [-64]), "BlockBits is -64"),
    "rate of another stream": (lambda image: replace(image, "BlockBits", [2048]), "truncated"),
    "truncated": (
        lambda image: replace(image, "Stream", metadata(image, "Stream")[:-8]),
        "truncated",
    ),
    "dimensions": (lambda image: replace(image, "Dimensions", [1 << 62, 9, 9]), "Dimensions"),
    "range NaN": (lambda image: replace(image, "Range", [NAN, 1.0]), "Range"),
    "range reversed": (lambda image: replace(image, "Range", [1.0, -1.0]), "Range"),
    "mask out of order": (lambda image: mask(image, [5, 1, 0, 0]), "HiddenSamples"),
    "mask beyond": (lambda image: mask(image, [0, 1, 1 << 40, 1]), "HiddenSamples"),
    "no name": (lambda image: image.GetFieldData().RemoveArray(PREFIX + "ArrayName"), "ArrayName"),
}


def mask(image, runs):
    replace(image, "Version", [2])
    replace(image, "HiddenSamples", np.array(runs, np.uint64).reshape(-1, 2))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("hostile")


@pytest.mark.parametrize("case", METADATA)
def test_metadata(folder, case):
    """Whatever takes the volume says in one sentence what is wrong with it."""
    change, words = METADATA[case]
    image = progiso.compress(make_image(noise((9, 9, 9))), rate=8)
    change(image)
    file = folder / "hostile.vti"
    progiso.save(image, file)
    for call in (
        lambda: progiso.decompress(image),
        lambda: progiso.contour(image, 1.0),
        lambda: progiso.decompress(progiso.read(file)),
        lambda: progiso.render(progiso.read(file), 1.0, size=SIZE),
        lambda: progiso.save(image, folder / "hostile.zfp"),
    ):
        with pytest.raises((ValueError, RuntimeError, OSError), match=words):
            call()


def test_origin_of_two_numbers(folder):
    header = (
        "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\n"
        "space origin: (1,2)\nencoding: raw\n\n"
    )
    (folder / "x.nrrd").write_bytes(header.encode() + bytes(8))
    with pytest.raises(ValueError, match=r"origin \[1.0, 2.0\]"):
        progiso.read(folder / "x.nrrd")


def test_command_line(folder):
    """The exit status is 1, the error one line."""
    for change, word in (
        METADATA["truncated"],
        METADATA["range reversed"],
        (GEOMETRIES["spacing zero"], "finite"),
    ):
        image = progiso.compress(make_image(noise((9, 9, 9))), rate=8)
        change(image)
        progiso.save(image, folder / "x.vti")
        command = [
            sys.executable,
            "-m",
            "progiso",
            "render",
            "x.vti",
            "--isovalue",
            "1",
            "--size",
            "64x48",
        ]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        lines = done.stderr.strip().splitlines()
        assert done.returncode == 1 and len(lines) == 1, done.stdout + done.stderr
        assert "error" in lines[0] and word in lines[0]


@pytest.mark.parametrize("scale", [0.0, 1e-3, 1e30])
@pytest.mark.parametrize("settings", [{}, CACHED], ids=["whole", "cached"])
def test_wrong_ranges(scale, settings):
    """Those of other samples, with checksums that are right: images come to an end all the same."""
    image = progiso.compress(make_image(blobs(SHAPE, 3)), rate=8)
    other = progiso.compress(make_image(np.float32(scale) * blobs(SHAPE, 4)), rate=8)
    for name in ("Ranges", "RangesDirectory"):
        image.GetFieldData().AddArray(other.GetFieldData().GetAbstractArray(PREFIX + name))
    assert vtkCompressedVolume.Place(image)
    for opacity in (1.0, 0.3):
        shows(image, [0.1, 0.0], opacity, **settings)
