"""`python -m progiso` as its users call it."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk

import progiso
from helpers.images import (
    blobs,
    make_image,
    marschner_lobb,
    noise,
    reference_values,
    reference_volume,
    same_bits,
    samples_of,
)
from helpers.pictures import read_png
from helpers.programs import call_progiso, run_progiso
from helpers.scenes import check_depth, check_memory, orbit
from progiso.measure import tolerances
from progiso.oracle.caster import Camera, cast


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder with a plain volume and its compressed twin."""
    folder = tmp_path_factory.mktemp("cli")
    values = blobs((40, 36, 44), 3)
    progiso.save(make_image(values, spacing=(1, 0.8, 1.2), origin=(3, 2, 1)), folder / "plain.vti")
    values.tofile(folder / "blobs_44x36x40_float32.raw")
    call_progiso(folder, "compress", "plain.vti", "packed.vti", "--rate", 6)
    return folder


def test_compress_is_the_librarys(folder):
    expected = progiso.compress(progiso.read(folder / "plain.vti"), rate=6)
    packed = progiso.read(folder / "packed.vti")
    assert same_bits(reference_values(packed), reference_values(expected))
    assert (
        packed.GetSpacing() == expected.GetSpacing() and packed.GetOrigin() == expected.GetOrigin()
    )


def test_decompress(folder):
    call_progiso(folder, "decompress", "packed.vti", "unpacked.vti")
    assert same_bits(
        samples_of(progiso.read(folder / "unpacked.vti")),
        reference_values(progiso.read(folder / "packed.vti")),
    )


def test_levels(folder):
    """Levels of detail are made, told and decoded."""
    values = np.random.default_rng(1).random((70, 20, 30), np.float32)
    progiso.save(progiso.image_from_array(values.ravel(), (30, 20, 70)), folder / "long.vti")
    text = call_progiso(folder, "compress", "long.vti", "levels.vti", "--rate", 4, "--levels", 3)
    assert "of 1 level of detail (16x11x36)" in text
    assert "level 1: samples 16 11 36, steps 2 2 2, rate 7" in call_progiso(
        folder, "info", "levels.vti"
    )
    about = json.loads(call_progiso(folder, "info", "levels.vti", "--json"))["compressed"]
    assert about["levels"][0]["samples"] == [16, 11, 36]
    assert "blocks of level 1: 108 decode" in call_progiso(folder, "info", "levels.vti", "--verify")
    call_progiso(folder, "decompress", "levels.vti", "level.vti", "--level", 1)
    level = progiso.read(folder / "level.vti")
    assert level.GetDimensions() == (16, 11, 36) and level.GetSpacing() == (2, 2, 2)


def test_compress_appended(folder):
    call_progiso(folder, "compress", "plain.vti", "appended.vti", "--rate", 6, "--appended")
    assert b'encoding="raw"' in (folder / "appended.vti").read_bytes()
    assert same_bits(
        reference_values(progiso.read(folder / "appended.vti")),
        reference_values(progiso.read(folder / "packed.vti")),
    )


def test_bytes_of_files(folder):
    """Sizes are given of the whole file, and of the samples in it."""
    text = call_progiso(folder, "compress", "plain.vti", "sized.vti", "--rate", 6)
    size, stream = (folder / "sized.vti").stat().st_size, 10 * 9 * 11 * 64 * 6 // 8
    assert f": {size} bytes, {stream} of compressed samples, 6 bits" in text
    assert (
        json.loads(call_progiso(folder, "info", "sized.vti", "--json"))["file bytes"]
        == size
        > stream
    )


def test_info(folder):
    plain, packed = (
        call_progiso(folder, "info", "plain.vti"),
        call_progiso(folder, "info", "packed.vti"),
    )
    for text in (plain, packed):
        assert "44 36 40" in text and "field" in text
    assert re.search(r"rate: 6\b", packed) and "rate" not in plain


def test_zfp_files(folder):
    call_progiso(folder, "compress", "plain.vti", "packed.zfp", "--rate", 6)
    subprocess.run(["zfp", "-q", "-h", "-z", "packed.zfp", "-o", "raw"], cwd=folder, check=True)
    assert same_bits(
        np.fromfile(folder / "raw", np.float32).reshape(40, 36, 44),
        reference_values(progiso.read(folder / "packed.vti")),
    )


def test_notes(folder):
    """What a user may not expect is said on stderr, and is no failure."""
    for arguments, words in (
        (("compress", "plain.vti", "noted.zfp"), "no spacing"),
        (("contour", "packed.vti", "noted.vtp", "--isovalue", 1e6), "range"),
        (("render", "packed.vti", "--isovalue", 1e6, "--size", "64x48"), "range"),
        (
            ("render", "packed.vti", "--isovalue", 0.1, "--size", "64x48", "--rate", 3),
            "--rate 3 is ignored",
        ),
        (
            ("contour", "packed.vti", "noted.vtp", "--isovalue", 0.1, "--component", 1),
            "--component 1 is ignored",
        ),
    ):
        done = run_progiso(folder, *arguments)
        assert done.returncode == 0, done.stderr
        assert "note: " in done.stderr and words in done.stderr
    quiet = run_progiso(
        folder, "render", "packed.vti", "--isovalue", 0.1, "--size", "64x48", "--rate", 6
    )
    assert quiet.stderr == ""


def test_labels_and_tolerances(folder):
    """What was chosen is said; one warning where what is given does not do."""
    ball = np.where(np.linalg.norm(np.mgrid[-16:16, -16:16, -16:16], axis=0) < 12, 4000, 0)
    ball.astype(np.int16).tofile(folder / "ball_32x32x32_int16.raw")
    done = run_progiso(folder, "compress", "ball_32x32x32_int16.raw", "ball.vti")
    assert "bits per sample, errors up to 0.4" in done.stdout and "these are labels" in done.stderr
    about = json.loads(call_progiso(folder, "info", "ball.vti", "--json"))["compressed"]
    assert 0 < about["mean_error"] < about["largest_error"] < 0.5 and about["rate"] > 8
    assert run_progiso(folder, "contour", "ball.vti", "a.ply", "--isovalue", 0.5).stderr == ""
    for command in (("render", "--size", "64x48"), ("contour", "b.ply")):
        done = run_progiso(
            folder, command[0], "ball_32x32x32_int16.raw", *command[1:],
            "--isovalue", 0.5, "--rate", 8,
        )  # fmt: skip
        assert done.returncode == 0 and done.stderr.count("Isovalue 0.5 may show another") == 1
    for rate in ((), ("--rate", "auto")):
        call_progiso(folder, "compress", "plain.vti", "kept.vti", "--tolerance", 0.01, *rate)
        assert progiso.describe(progiso.read(folder / "kept.vti"))["largest_error"] <= 0.01


def test_negative_numbers_are_values(folder):
    for number in ("-1e-3", "-.5", "-0.25", "-1E-2"):
        call_progiso(folder, "contour", "packed.vti", "negative.ply", "--isovalue", number)
    call_progiso(
        folder, "render", "packed.vti", "--isovalue", "-1e-3", "--size", "64x48",
        "--view", "-1,0,0", "--up", "-.1,0,1",
    )  # fmt: skip
    assert "--nonsense" in call_progiso(folder, "info", "plain.vti", "--nonsense", succeeds=False)


def test_ranges_of_components(folder):
    """`info` tells the range of each, of plain images in memory and by slabs."""
    values = np.stack([noise((6, 7, 8), seed) * seed for seed in (1, 2, 3)], -1)
    progiso.save(make_image(values, "three"), folder / "three.vti")
    found = json.loads(call_progiso(folder, "info", "three.vti", "--json"))["point arrays"]["three"]
    assert found["range"] == [[float(v.min()), float(v.max())] for v in np.moveaxis(values, -1, 0)]


def render(folder, file, *arguments):
    """Render; return the depth image and the statistics."""
    out = ("--output", "out.png", "--depth", "out.npy", "--stats", "out.json")
    call_progiso(folder, "render", file, "--isovalue", 0.1, *out, *arguments)
    assert (folder / "out.png").read_bytes()[:4] == b"\x89PNG"
    return np.load(folder / "out.npy"), json.loads((folder / "out.json").read_text())


def test_render(folder):
    depth, statistics = render(folder, "packed.vti", "--size", "200x150", "--orbit", "1/5")
    image = progiso.read(folder / "packed.vti")
    volume = reference_volume(image)
    camera = orbit(volume, 1, 5)
    assert depth.dtype == np.float32 and depth.shape == (150, 200)
    check_depth(depth, cast(volume, 0.1, camera, (200, 150), slack=tolerances.SLACK))
    assert statistics["converged"] and statistics["size"] == [200, 150]
    seen = statistics["camera"]
    assert seen["position"] == pytest.approx(camera.position) and seen[
        "focal_point"
    ] == pytest.approx(camera.focal_point)
    assert seen["view_up"] == [0, 1, 0] and seen["view_angle"] == 50 and seen["parallel"] is False
    check_memory(image, statistics)


def test_render_several_isovalues(folder):
    """The outer surface hides the inner; more surfaces cover more pixels."""
    arguments = ("packed.vti", "--size", "200x150", "--orbit", "1/5", "--background", "black")
    inner, _ = render(folder, *arguments, "--color", "#ff0000")
    look = ("--color", "#ff0000", "--color", "#00ff00", "--opacity", 1, "--opacity", 0.5)
    both, _ = render(folder, *arguments, "--isovalue", -0.3, *look)
    assert (
        np.isfinite(both).sum() > np.isfinite(inner).sum()
        and np.isfinite(both[np.isfinite(inner)]).all()
    )
    pixels = read_png(folder / "out.png")
    front = both < inner - 0.1
    assert pixels[front][:, 1].mean() > 30 > pixels[~np.isfinite(both)].max()


def test_speculation_and_memory_budget_change_no_depth(folder):
    """Speculation saves passes, and a small budget costs some; the image is the same."""
    progiso.save(
        progiso.compress(make_image(blobs((90, 80, 100), 3, waves=6)), rate=6), folder / "large.vti"
    )
    arguments = ("large.vti", "--size", "160x120", "--orbit", "2/5")
    whole, at_once = render(folder, *arguments)
    little = (*arguments, "--memory-budget", "2M", "--detailed")
    with_it, fast = render(folder, *little)
    without, slow = render(folder, *little, "--no-speculation")
    assert np.isfinite(whole).any()
    assert whole.tobytes() == with_it.tobytes() == without.tobytes()
    assert 1 == len(at_once["passes"]) < len(fast["passes"]) < len(slow["passes"])
    assert all(p["speculation"] == 1 for p in slow["passes"])
    for statistics in (fast, slow):
        assert statistics["memory"]["budget"] == 2 << 20
        assert statistics["memory"]["total"] - statistics["memory"]["compressed"] <= 2 << 20
        assert statistics["stage_ms"]["CastRays"] > 0
    assert at_once["stage_ms"] == {}


@pytest.fixture(scope="module")
def with_levels(folder):
    """Make a plain volume, its compressed twin, and one with levels; return options of a far
    view."""
    image = make_image(blobs((90, 80, 100), 3, waves=6))
    progiso.save(image, folder / "far.vti")
    progiso.save(progiso.compress(image), folder / "bare.vti")
    progiso.save(progiso.compress(image, levels=3), folder / "leveled.vti")
    return ("--size", "120x90", "--zoom", 0.4)


@pytest.mark.parametrize("mode", [(), ("--level-of-detail", "interactive")])
def test_a_picture_off_screen_is_still(folder, with_levels, mode):
    """It is exact, unless levels are drawn in any case."""
    expected, _ = render(folder, "bare.vti", *with_levels)
    depth, statistics = render(folder, "leveled.vti", *with_levels, *mode)
    assert depth.tobytes() == expected.tobytes()
    assert statistics["levels"] == {"0": np.isfinite(depth).sum()}


def test_a_note_says_that_there_are_no_levels(folder, with_levels):
    arguments = ("--isovalue", 0.1, *with_levels, "--level-of-detail", "on")
    done = run_progiso(folder, "render", "bare.vti", *arguments)
    assert done.returncode == 0 and done.stderr.count("note: ") == 1, done.stderr
    assert "no levels of detail" in done.stderr


def test_level_of_detail(folder, with_levels):
    """Far parts come from levels, which a plain file gets here; the tolerance says how many."""
    on = (*with_levels, "--level-of-detail", "on")
    exact, _ = render(folder, "bare.vti", *with_levels)
    depth, statistics = render(folder, "leveled.vti", *on)
    levels = statistics["levels"]
    assert set(levels) == {"0", "1"} and sum(levels.values()) == np.isfinite(depth).sum()
    assert levels["1"] > 0 and depth.tobytes() != exact.tobytes()
    assert render(folder, "far.vti", *on)[0].tobytes() == depth.tobytes()
    fine, statistics = render(folder, "leveled.vti", *on, "--pixel-tolerance", 1 / 16)
    assert statistics["levels"]["1"] == 0 and fine.tobytes() == exact.tobytes()


def test_render_plain_at_a_rate(folder):
    """A plain file, rendered at a rate, shows what its compressed file shows."""
    arguments = ("--size", "120x90", "--orbit", "0/3")
    packed, _ = render(folder, "packed.vti", *arguments)
    plain, _ = render(folder, "plain.vti", "--rate", 6, *arguments)
    other, _ = render(folder, "plain.vti", "--rate", 3, *arguments)
    assert plain.tobytes() == packed.tobytes()
    assert other.tobytes() != packed.tobytes()


def test_render_raw_by_its_name(folder):
    depth, statistics = render(
        folder, "blobs_44x36x40_float32.raw", "--size", "120x90", "--orbit", "0/3"
    )
    volume = reference_volume(progiso.compress(make_image(blobs((40, 36, 44), 3)), rate=8))
    check_depth(depth, cast(volume, 0.1, orbit(volume, 0, 3), (120, 90), slack=tolerances.SLACK))


def test_render_in_parallel_projection(folder):
    """Depths count from the camera's plane."""
    depth, statistics = render(folder, "packed.vti", "--size", "120x90", "--parallel")
    seen = statistics["camera"]
    assert seen["parallel"] is True
    camera = Camera(
        seen["position"],
        seen["focal_point"],
        seen["view_up"],
        parallel_scale=seen["parallel_scale"],
    )
    check_depth(
        depth,
        cast(
            reference_volume(progiso.read(folder / "packed.vti")),
            0.1,
            camera,
            (120, 90),
            slack=tolerances.SLACK,
        ),
    )


@pytest.mark.parametrize("suffix", [".mha", ".nii.gz", ".vtk", ".nrrd"])
def test_other_formats(folder, suffix):
    """Files that others wrote are read as the same samples in the same place."""
    values = marschner_lobb(12)
    if suffix in (".mha", ".nii.gz"):
        image = make_image(values, spacing=(1, 0.5, 2), origin=(4, 5, 6))
        progiso.save(image, folder / f"volume{suffix}")
    elif suffix == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter

        writer = vtkStructuredPointsWriter()
        writer.SetInputData(make_image(values, spacing=(1, 0.5, 2), origin=(4, 5, 6)))
        writer.SetFileName(str(folder / "volume.vtk"))
        assert writer.Write()
    else:
        header = (
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 12 12 12\nspacings: 1 0.5 2\n"
            "axis mins: 4 5 6\nencoding: raw\nendian: little\n\n"
        )
        (folder / "volume.nrrd").write_bytes(header.encode() + values.tobytes())
    about = json.loads(call_progiso(folder, "info", f"volume{suffix}", "--json"))
    assert about["dimensions"] == [12, 12, 12]
    assert about["spacing"] == pytest.approx([1, 0.5, 2])
    call_progiso(folder, "compress", f"volume{suffix}", "other.vti", "--rate", 32)
    assert np.abs(reference_values(progiso.read(folder / "other.vti")) - values).max() < 1e-6


FAILURES = {
    "missing file": (["info", "none.vti"], "none.vti"),
    "unknown format": (["info", "some.xyz"], "some.xyz"),
    "broken file": (["info", "broken.vti"], "broken.vti"),
    "rate": (["compress", "plain.vti", "x.vti", "--rate", "40"], "rate"),
    "array": (["compress", "plain.vti", "x.vti", "--array", "none"], "none"),
    "decompress plain": (["decompress", "plain.vti", "x.vti"], "compressed"),
    "size": (["render", "packed.vti", "--isovalue", "0", "--size", "0x5"], "0x5"),
    "orbit": (["render", "packed.vti", "--isovalue", "0", "--orbit", "5/5"], "5/5"),
    "orbit and zoom": (
        ["render", "packed.vti", "--isovalue", "0", "--orbit", "0/5", "--zoom", "2"],
        "--zoom",
    ),
    "orbit and parallel": (
        ["render", "packed.vti", "--isovalue", "0", "--orbit", "0/5", "--parallel"],
        "--parallel",
    ),
    "zfp header": (["info", "packed.vti", "--zfp-header", "4x4x4:8"], "--zfp-header"),
    "level of detail": (
        ["render", "packed.vti", "--isovalue", "0", "--level-of-detail", "some"],
        "--level-of-detail: invalid choice: 'some'",
    ),
    "pixel tolerance": (
        ["render", "packed.vti", "--isovalue", "0", "--pixel-tolerance", "100"],
        "pixel_tolerance must be in [0.0625, 64], got 100",
    ),
    "budget's unit": (["render", "packed.vti", "--isovalue", "0", "--memory-budget", "3T"], "3T"),
    "isovalue": (["render", "packed.vti", "--isovalue", "nan"], "isovalue"),
    "opacities": (
        ["render", "packed.vti", "--isovalue", "0", "--opacity", "1", "--opacity", "0.5"],
        "opacity: 2 for 1",
    ),
    "colours": (
        ["render", "packed.vti", "--isovalue", "0", "--color", "red", "--color", "tan"],
        "color: 2 for 1",
    ),
    "a text": (["info", "text.txt"], "text.txt"),
    "a folder": (["info", "empty"], "empty"),
    "a flat image": (["render", "thin.npy", "--isovalue", "0"], "'thin.npy': cannot compress"),
    "a picture's suffix": (
        ["render", "packed.vti", "--isovalue", "0", "--output", "x.jpg"],
        ".png",
    ),
    "output": (["compress", "plain.vti", "nowhere/x.vti"], "nowhere"),
    "appended": (["compress", "plain.vti", "x.zfp", "--appended"], "x.zfp"),
}


@pytest.mark.parametrize("case", FAILURES)
def test_errors_are_one_line(folder, case):
    arguments, word = FAILURES[case]
    (folder / "broken.vti").write_text("<VTKFile")
    (folder / "empty").mkdir(exist_ok=True)
    np.save(folder / "thin.npy", np.zeros((1, 5, 6)))
    (folder / "some.xyz").write_text("?")
    (folder / "text.txt").write_text("What VTK's reader of .hdr pictures takes for its own.\n" * 50)
    lines = call_progiso(folder, *arguments, succeeds=False).strip().splitlines()
    assert len(lines) == 1, lines
    assert "error" in lines[0] and word in lines[0]
    assert "Traceback" not in lines[0]
    assert not (folder / "x.vti").exists()


def test_of_too_small_a_budget_the_least_is_taken(folder):
    """The picture comes, and a note says so."""
    arguments = ["render", "packed.vti", "--isovalue", "0.1", "--memory-budget", "1000"]
    done = run_progiso(folder, *arguments)
    assert done.returncode == 0 and "MiB is too small" in done.stderr, done.stderr


def test_one_of_several_arrays(tmp_path):
    """Every command takes the array that is asked for; `info` lists all."""
    values = {"first": blobs((9, 10, 11)), "second": 50 * blobs((9, 10, 11), 7)}
    image = make_image(values["first"])
    image.GetPointData().GetScalars().SetName("first")
    second = numpy_to_vtk(values["second"].reshape(-1), deep=True)
    second.SetName("second")
    image.GetPointData().AddArray(second)
    progiso.save(image, tmp_path / "two.vti")
    about = json.loads(call_progiso(tmp_path, "info", "two.vti", "--json"))
    assert set(about["point arrays"]) == {"first", "second"}
    isovalue, tolerance = float(np.median(values["second"])), 0.01
    surface = progiso.contour(image, isovalue, array="second")
    told = call_progiso(
        tmp_path, "contour", "two.vti", "s.ply", "--isovalue", isovalue, "--array", "second"
    )
    assert f"{surface.GetNumberOfPolys()} triangles" in told and surface.GetNumberOfPolys() > 50
    least = call_progiso(tmp_path, "rate", "two.vti", "--tolerance", tolerance, "--array", "second")
    assert float(least) == progiso.least_rate(image, tolerance, array="second")
    assert float(least) != progiso.least_rate(image, tolerance, array="first")
    read = progiso.read(tmp_path / "two.vti", array="second")
    assert read.GetPointData().GetScalars().GetName() == "second"
    assert read.GetPointData().GetNumberOfArrays() == 2


# --- data -----------------------------------------------------------------------------------------


def gyroid(n, k):
    """Compute gyroid and noise by their definition, without any of the project's shortcuts."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n)] * 3, indexing="ij")
    w = np.pi * k
    field = (
        np.sin(w * x) * np.cos(w * y)
        + np.sin(w * y) * np.cos(w * z)
        + np.sin(w * z) * np.cos(w * x)
    )
    rng = np.random.default_rng(7)
    t = np.linspace(0, 1, n)
    total = np.zeros_like(field)
    for cells, weight in ((16, 1), (32, 0.5), (64, 0.25)):
        lattice = rng.standard_normal((cells + 1,) * 3)
        place = t * cells
        cell = np.minimum(place.astype(int), cells - 1)
        s = place - cell
        fade = 6 * s**5 - 15 * s**4 + 10 * s**3
        for axis in range(3):
            low, high = np.take(lattice, cell, axis), np.take(lattice, cell + 1, axis)
            f = fade.reshape([-1 if a == axis else 1 for a in range(3)])
            lattice = low * (1 - f) + high * f
        total += weight * lattice
    return field + 0.35 * total


def test_gyroid_is_as_defined(tmp_path):
    from progiso.data import fetch

    values = samples_of(progiso.read(fetch("gyroid", folder=tmp_path, size=40, k=6)))
    assert np.abs(values - gyroid(40, 6)).max() < 1e-5


def test_generators_make_what_can_be_shown(folder):
    from progiso.data import GENERATORS

    listed = call_progiso(folder, "data")
    environment = dict(os.environ, XDG_CACHE_HOME=str(folder / "cache"))
    for name, generator in GENERATORS.items():
        assert name in listed
        command = [sys.executable, "-m", "progiso", "data", name, "--size", "24"]
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=True
        )
        values = samples_of(progiso.read(done.stdout.strip()))
        assert values.shape == (24, 24, 24)
        assert values.min() < generator.isovalues[0] < values.max()
