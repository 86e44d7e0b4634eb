"""The plugin, script by script: each of scripts/ checks what it shows, and prints JSON."""

import json
import os
import re
import shutil
import subprocess

import pytest

from helpers.programs import SCRIPTS, displays, under_x

pytestmark = pytest.mark.paraview


def run(name, build, folder):
    """Run a script in pvpython and return what it found."""
    output = under_x("pvpython", SCRIPTS / f"{name}.py", build, folder)
    (found,) = [line for line in output.splitlines() if line.startswith("{")]
    return json.loads(found)


NAMES = "show_plain show_compressed opaque zfp_files interactive errors".split()
NAMES += "cell_data panel trace contour color_by hidden translucent blocks".split()
NAMES += "many_isovalues magnitude still volume_state grids ranges compress".split()
NAMES += "picking color_maps failures".split()
NAMES += "turning lights waiting mirrored levels".split()


@pytest.mark.parametrize("name", NAMES)
def test_script(name, build, tmp_path):
    run(name, build, tmp_path)


def test_state(build, tmp_path):
    """A state saved by one process looks the same in another."""
    assert run("state_save", build, tmp_path) == run("state_load", build, tmp_path)


def run_window(script, build, folder):
    """Run a script in ParaView's own window and return what it found."""
    if not shutil.which("paraview"):
        pytest.skip("there is no `paraview`, only its Python interpreters")
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    command = ["bash", SCRIPTS / "gui.sh", build, folder, f":{next(displays)}", script]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    assert "error" not in found, found["error"]
    return found


def test_window(build, tmp_path):
    """ParaView's own window shows an isosurface, refined by its event loop."""
    seen = run_window("gui_script.py", build, tmp_path)["seen"]
    completed = [image["completed"] for image in seen]
    assert completed[-1] == 1.0 and completed == sorted(completed) and completed[0] < 1.0
    assert (tmp_path / "gui_window.png").stat().st_size > 50_000
    # the panel's widget follows, image by image
    for image in seen:
        assert abs(image["bar"] - image["completed"]) < 2e-3 and (image["text"] == "100 %") == (
            image["completed"] == 1.0
        )
        assert image["rows"] == image["passes"] > 0 and image["image"].startswith(
            f"{image['passes']:.0f} pass"
        )
        assert (
            image["memory"] == f"{image['held'] / 2**20:.1f} of {image['budget'] / 2**20:.1f} MiB"
        )
        assert 0 < image["held"] <= image["budget"] and all(time >= 0 for time in image["times"])
    assert seen[-1]["rows"] > seen[0]["rows"] and sum(seen[-1]["times"]) > 0


def test_panel_in_the_window(build, tmp_path):
    """The panel's order, what it hides, its slider and what cuts, as a user has them."""
    found = run_window("gui_panel.py", build, tmp_path)
    assert found["default"] == "Progressive Isosurface"
    hidden = ("Isosurface Array", "Isosurface Component", "Mask NaN", "Speculation")
    hidden += ("Compression Rate (bits per voxel)", "Memory Budget (MiB)")
    hidden += ("Level Of Detail Tolerance (pixels)", "Levels", "Uncertain")
    simple, advanced, plain = found["simple"], found["advanced"], found["plain"]
    assert not set(hidden) & set(simple) and "Level Of Detail" in simple, simple
    assert (
        simple.index("Progressive Isosurface") < simple.index("Coloring") < simple.index("Lighting")
    )
    assert simple.count("Progressive Isosurface") == 1
    assert any("complete: 1 pass" in text for text in simple), simple
    assert {"Speculation", "Memory Budget (MiB)", "Completed"} <= set(advanced), advanced
    assert "Level Of Detail Tolerance (pixels)" in advanced, advanced
    assert not {"Isosurface Array", "Compression Rate (bits per voxel)"} & set(advanced), advanced
    assert not {"Levels", "Uncertain"} & set(advanced), advanced
    assert "0: 0.0 %, 1: 100 %" in found["levels"], found["levels"]
    fraction, shown = found["uncertain"], found["levels"]
    at_most = float(shown[shown.index("Uncertain") + 1].removesuffix(" %")) / 100
    assert 0 < fraction <= at_most < fraction + 0.0011, (fraction, shown)
    line = "100 % of the surface from coarser levels, "
    line += f"{100 * at_most:.1f} % of the pixels uncertain"
    assert any(line in text for text in found["coarse"]), found["coarse"]
    assert not any("coarser levels" in text for text in simple), simple
    assert {"Isosurface Array", "Compression Rate (bits per voxel)"} <= set(plain), plain
    assert "Isosurface Component" not in plain and "Isosurface Component" in found["vectors"]

    # a drag moves the surface at once, and is one step
    isovalues, made = zip(*found["dragged"], strict=True)
    assert list(isovalues) == sorted(set(isovalues)) and isovalues[0] > found["before"][0]
    assert list(made) == sorted(set(made)) and made[0] >= 1, made
    assert found["after"][0] >= isovalues[-1] and found["redone"] == found["after"]
    assert found["undone"] == found["before"]

    assert found["cropped"] == found["clipped"] == found["second"] == 1
    for name in ("simple", "slider", "cropping", "plane", "advanced", "levels", "coarse", "plain"):
        assert (tmp_path / f"gui_{name}.png").stat().st_size > 50_000


def test_scene_in_the_window(build, tmp_path):
    """Choosing the representation shows a bar, hovering finds cells and points, blocks show."""
    found = run_window("gui_scene.py", build, tmp_path)
    # compression may be over before the bar shows it: the script "waiting" has that
    loading = [part for text, part in found["choosing"] if text.startswith("Loading")]
    assert len(loading) >= 3 and loading == sorted(loading) and loading[-1] == 100, loading
    assert found["isovalue"] == [], found["isovalue"]

    assert found["chosen"] == found["blocks"] == "Progressive Isosurface"
    cell, point = re.search(r"Id: (\d+)", found["cell"]), re.search(r"Id: (\d+)", found["point"])
    assert cell and found["clicked"][-1] == int(cell[1]), (found["cell"], found["clicked"])
    corners = [
        int(cell[1]) % 40 + i + 41 * (int(cell[1]) // 40 % 40 + j + 41 * (int(cell[1]) // 1600 + k))
        for k in (0, 1)
        for j in (0, 1)
        for i in (0, 1)
    ]
    assert point and int(point[1]) in corners, (found["cell"], found["point"])
    assert found["summary"].startswith("100 % complete"), found["summary"]
    for name in ("loading", "blocks"):
        assert (tmp_path / f"gui_{name}.png").stat().st_size > 50_000


def test_help_pages(build):
    """ParaView's help has a page of each filter and of the representation, where it can be made."""
    contents = list(build.glob("**/paraview_help/ProgIso.qhp"))
    if not contents:
        pytest.skip("no help pages: they need Qt's Help module and xmlpatterns")
    listed, folder = contents[0].read_text(), contents[0].parent
    pages = [f"filters.ZFP{name}" for name in ("Compress", "Decompress", "Contour")]
    for page in (*pages, "representations.ProgressiveIsosurfaceRepresentation"):
        assert f"<file>{page}.html</file>" in listed, listed
    text = folder.joinpath(f"{page}.html").read_text()
    named = ("Isovalues", "Frame Time", "Clip Plane", "Resample Uneven Grids", "Level Of Detail")
    for words in named:
        assert words in text, words
