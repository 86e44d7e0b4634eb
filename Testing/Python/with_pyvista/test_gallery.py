"""The gallery's examples run, on less data and in small windows, and their pictures are there."""

import importlib.util

import numpy as np
import pytest

from helpers import REPOSITORY
from helpers.pictures import read_png

pytest.importorskip("pyvista")

GALLERY = REPOSITORY / "Data" / "Gallery"
EXAMPLES = sorted(path.stem for path in GALLERY.glob("*.py"))
LESS = {
    "gyroid": {"samples": 48},
    "mesh_export": {"samples": 16},
    "small_gpu": {"samples": 64, "budget": 8 * 2**20},
}


def drawn(name, size):
    """Run an example; return the picture."""
    spec = importlib.util.spec_from_file_location(name, GALLERY / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    result = module.draw(size=size, **LESS.get(name, {}))
    if isinstance(result, np.ndarray):
        return result
    pixels = result.screenshot(return_img=True)
    result.close()
    return pixels


def shown(pixels):
    """Return the share of pixels that are not the background, which is in a bottom corner."""
    return np.mean(np.abs(pixels.astype(int) - pixels[-1, 0]).max(axis=2) > 20)


@pytest.mark.parametrize("name", EXAMPLES)
def test_example(name):
    pixels = drawn(name, (240, 160))
    assert pixels.shape == (160, 240, 3)
    halves = np.hsplit(pixels, 2)
    assert all(0.05 < shown(half) < 0.95 for half in halves)
    assert all(half.std(axis=(0, 1)).max() > 15 for half in halves)


@pytest.mark.parametrize("name", EXAMPLES)
def test_picture(name):
    """The picture is there, small, and in the table."""
    file = GALLERY / f"{name}.png"
    assert file.stat().st_size < 150 * 1024 and 0.1 < shown(read_png(file)) < 0.95
    table = (GALLERY / "README.md").read_text(encoding="utf-8")
    assert f"({name}.png)" in table and f"({name}.py)" in table


def test_there_are_examples():
    assert len(EXAMPLES) >= 6
