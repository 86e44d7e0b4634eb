"""A volume computed and compressed a few slices at a time is that computed and compressed whole."""

import os
import subprocess
import sys

import numpy as np
import pytest

import progiso
from helpers.images import check_same, make_image, noise, stream_of
from helpers.programs import PEAK
from progiso.data import GENERATORS, compressed, fetch
from progiso.io.slabs import compute_slabs


def dealt(values, depth):
    """Deal out a volume's slices, `depth` at a time, from memory that is used again."""
    memory = np.empty((depth, *values.shape[1:]), values.dtype)
    for first in range(0, len(values), depth):
        slab = values[first : first + depth]
        memory[: len(slab)] = slab
        yield memory[: len(slab)]
        memory[:] = 77


@pytest.mark.parametrize("depth", [1, 3, 4, 7, 8, 40])
@pytest.mark.parametrize("rate", [9 / 64, 1, 2.51, 5.25, 16, 32])
def test_however_the_slices_are_dealt(rate, depth):
    values = noise((27, 9, 13), 1)
    expected = progiso.compress(make_image(values, "name"), rate=rate)
    check_same(
        progiso.compress_slabs(dealt(values, depth), (13, 9, 27), rate=rate, name="name"), expected
    )


@pytest.mark.parametrize(
    "shape", [(a, b, c) for a in (2, 5, 8, 11) for b in (3, 8) for c in (2, 9, 20)]
)
def test_partial_blocks(shape):
    values = noise(shape, 2)
    expected = progiso.compress(make_image(values, "name"), rate=3)
    check_same(progiso.compress_slabs(dealt(values, 4), shape[::-1], rate=3, name="name"), expected)
    check_same(
        progiso.compress_slabs(values.__getitem__, shape[::-1], rate=3, name="name", threads=3),
        expected,
    )


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8", ">f4"])
def test_sample_types(kind):
    values = (noise((9, 6, 7), 3) * 30).astype(kind)
    expected = progiso.compress(
        make_image(values.astype(values.dtype.newbyteorder("=")), "name"), rate=8
    )
    check_same(progiso.compress_slabs(dealt(values, 4), (7, 6, 9), rate=8, name="name"), expected)


def test_memory_in_another_order():
    """Views with strides, and slices in place of slabs, are taken too."""
    values = noise((7, 6, 12), 4)
    expected = progiso.compress(make_image(values[::-1, :, ::2], "name"), rate=8)
    check_same(
        progiso.compress_slabs([values[::-1, :, ::2]], (6, 6, 7), rate=8, name="name"), expected
    )
    check_same(
        progiso.compress_slabs(iter(values[::-1, :, ::2]), (6, 6, 7), rate=8, name="name"), expected
    )


def test_progress_rises():
    seen = []
    progiso.compress_slabs(dealt(noise((16, 4, 4)), 4), (4, 4, 16), progress=seen.append)
    assert seen == [0.25, 0.5, 0.75, 1]


def with_value(value):
    values = noise((12, 6, 5))
    values[5, 2, 3] = values[6, 1, 1] = value
    return values


REFUSALS = {
    "rate": (noise((12, 6, 5)), (5, 6, 12), 33, "33"),
    "flat": (noise((1, 6, 5)), (5, 6, 1), 8, "5 x 6 x 1"),
    "too few": (noise((11, 6, 5)), (5, 6, 12), 8, "11 slices of 12|8 slices of 12|multiple of 4"),
    "too many": (noise((13, 6, 5)), (5, 6, 12), 8, "where"),
    "nan": (with_value(np.nan), (5, 6, 12), 8, "Slices 4 to 7 have 2 NaN"),
    "infinite": (with_value(np.inf), (5, 6, 12), 8, "Slices 4 to 7 have 0 NaN and 2 infinite"),
    "tiny": (np.full((12, 6, 5), 1e-31), (5, 6, 12), 8, "too small"),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_refusals_are_clear(case):
    values, dimensions, rate, words = REFUSALS[case]
    with pytest.raises(ValueError if case == "rate" else RuntimeError, match=words):
        progiso.compress_slabs(dealt(values, 4), dimensions, rate=rate, mask_nan=False)


def test_shapes_are_checked():
    with pytest.raises(ValueError, match=r"slab 1 has shape \(4, 5, 6\), not \(any depth, 6, 5\)"):
        progiso.compress_slabs([np.zeros((4, 6, 5)), np.zeros((4, 5, 6))], (5, 6, 8))


def test_types_must_agree():
    with pytest.raises(RuntimeError, match="double"):
        progiso.compress_slabs([np.zeros((4, 6, 5), np.int16), np.zeros((4, 6, 5))], (5, 6, 8))
    with pytest.raises(TypeError, match="slice 3 is of type float64, not int16"):
        progiso.compress_slabs(
            lambda z: np.zeros((6, 5), np.int16 if z < 3 else float), (5, 6, 8), threads=1
        )


def test_errors_of_a_function_come_through():
    with pytest.raises(ZeroDivisionError):
        progiso.compress_slabs(lambda z: np.full((4, 4), 1 / (z - 6)), (4, 4, 8))


# --- generators -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", GENERATORS)
def test_threads_do_not_show(name):
    generator = GENERATORS[name]
    axes = [np.linspace(-1, 1, n) for n in (150, 130, 9)]
    options = {key: option.default for key, option in generator.options.items()}
    slice_at = generator.make(axes, **options)
    whole = np.stack([slice_at(z) for z in range(9)]).astype(np.float32)
    for threads in (1, 3):
        slabs = compute_slabs(slice_at, (150, 130, 9), threads=threads)
        assert np.array_equal(np.concatenate([slab.copy() for slab in slabs]), whole)


@pytest.mark.parametrize("rate", [1, 2.5])
def test_compressed_is_what_fetch_gives_compressed(tmp_path, rate):
    options = {"size": (44, 30, 37), "k": 3}
    path = compressed("gyroid", rate=rate, folder=tmp_path, **options)
    raw = progiso.read(fetch("gyroid", folder=tmp_path, **options))
    assert stream_of(progiso.read(path)) == stream_of(progiso.compress(raw, rate=rate))
    made = path.stat().st_mtime_ns
    assert compressed("gyroid", rate=rate, folder=tmp_path, **options) == path
    assert path.stat().st_mtime_ns == made


def test_compressed_names_what_is_wrong(tmp_path):
    for arguments, words in (
        ({"name": "ct-cranium"}, "ct-cranium.*gyroid"),
        ({"name": "gyroid", "rate": 0}, "rate"),
        ({"name": "gyroid", "size": 1}, "size"),
        ({"name": "gyroid", "frequency": 1}, "frequency"),
    ):
        with pytest.raises(ValueError, match=words):
            compressed(folder=tmp_path, **arguments)
    assert not list(tmp_path.iterdir())


def test_interrupted_leaves_nothing(tmp_path):
    def interrupt(fraction):
        raise KeyboardInterrupt

    for get in (compressed, fetch):
        with pytest.raises(KeyboardInterrupt):
            get("sphere", size=16, folder=tmp_path, progress=interrupt)
        assert not list(tmp_path.iterdir())


def test_command_line(tmp_path):
    """The command prints the path of a file that holds what the library makes."""
    command = [
        sys.executable,
        "-m",
        "progiso",
        "data",
        "porous",
        "--size",
        "24x20x17",
        "--rate",
        "3",
        "--seed",
        "5",
    ]
    done = subprocess.run(
        command,
        env=dict(os.environ, XDG_CACHE_HOME=str(tmp_path)),
        capture_output=True,
        text=True,
        check=True,
    )
    expected = progiso.compress(
        progiso.read(fetch("porous", size=(24, 20, 17), seed=5, folder=tmp_path)), rate=3
    )
    assert stream_of(progiso.read(done.stdout.strip())) == stream_of(expected)


MEASURED = f"""
{PEAK}
import sys
from progiso.data import compressed
compressed("sphere", size=64, folder=sys.argv[1])
before = peak()
compressed("sphere", size=(512, 512, 320), rate=1, folder=sys.argv[1])
print(peak() - before)
"""


def test_memory_is_bounded_by_slabs(tmp_path):
    """320 MiB of samples and 10 MiB of stream are made in less than a third of that.

    About 52 MiB are usual.
    """
    done = subprocess.run(
        [sys.executable, "-c", MEASURED, tmp_path], capture_output=True, text=True, check=True
    )
    assert int(done.stdout) < 100 * 2**20
