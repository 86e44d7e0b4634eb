"""Benchmarks: every set runs and reports, and goals are judged rightly.

Speed is no test's business.
"""

import copy
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from vtkmodules.util.numpy_support import vtk_to_numpy

import progiso
from helpers.programs import call_progiso
from progiso import _built
from progiso.bench import goals
from progiso.bench.bounds import OURS, THEIRS, averaged, color_error, depth_errors
from progiso.bench.fields import parse_field
from progiso.bench.literature import GPU
from progiso.bench.report import markdown
from progiso.bench.settings import PEERS, Settings
from progiso.bench.sheets import draw_sheet
from progiso.bench.soak import growth
from progiso.data import fetch
from progiso.measure.document import load_document, merge

FIELD = ("--fields", "gyroid-24-k2-r8", "--positions", 2)
TINY = (*FIELD, "--size", "64x48")
#: This package, which stands for an earlier one, too.
PACKAGE = Path(_built.__file__).parents[1]
KINDS = {
    "quick": {"peers", "protocol", "latency", "errors", "image_scaling", "volume_scaling"},
    "paper": {"protocol", "latency"},
    "scaling": {"image_scaling", "volume_scaling"},
    "peers": {"peers"},
    "errors": {"errors"},
    "rates": {"rates"},
    "levels": {"level_spheres", "levels"},
    "bounds": {"bounds"},
    "budget": {"budget"},
    "interactive": {"interactive"},
    "first-image": {"first_image"},
    "soak": {"soak"},
}
OPTIONS = {
    "quick": ("--isovalues", 2),
    "paper": ("--isovalues", 2),
    "scaling": ("--largest", 64, "--images", "64x48,96x72"),
    "bounds": ("--fields", "gyroid-72-k6-r8", "--images", "64x48", "--pictures", "sheets"),
    "interactive": ("--images", "64x48,48x64", "--frames", 3, "--baseline", PACKAGE),
    "first-image": ("--baseline", PACKAGE),
    "soak": ("--frames", 40),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return the folder where the sets leave their results, each in one of its own."""
    return tmp_path_factory.mktemp("bench")


@pytest.fixture(scope="module")
def results(folder):
    """Return a function that runs a set once and returns its folder."""

    def run(name):
        if not (folder / name).exists():
            images = FIELD if name in ("bounds", "interactive") else TINY
            call_progiso(folder, "bench", name, *images, *OPTIONS.get(name, ()), "--output", name)
        return folder / name

    return run


@pytest.mark.parametrize("name", KINDS)
def test_sets(results, name):
    """Each set leaves JSON with its measurements, Markdown with its tables, and the plots that it
    shows."""
    document = json.loads((results(name) / "results.json").read_text())
    assert set(document["measurements"]) == KINDS[name]
    assert document["runs"][0]["set"] == name and document["runs"][0]["complete"]
    assert {"cpu", "cores", "memory_bytes", "gl", "vtk"} <= set(document["machine"])
    text = (results(name) / "results.md").read_text()
    shown = re.findall(r"!\[\]\((.*)\)", text)
    assert shown or name == "latency"
    assert sorted(shown) == sorted(p.name for p in results(name).glob("*.png"))
    for plot in shown:
        assert (results(name) / plot).read_bytes()[:4] == b"\x89PNG"
    assert "nan" not in text and "None" not in text


def test_quick_names_the_peers(results):
    text = (results("quick") / "results.md").read_text()
    for peer in ("ProgIso", "VTK isosurface mapper", "VTK FlyingEdges"):
        assert re.search(rf"^\|.*\| {peer} \|", text, re.MULTILINE)


def test_protocol_counts(results):
    """Figures of the paper's tables agree with each other."""
    record = load_document(results("paper") / "results.json")["measurements"]["protocol"][0]
    assert record["time"]["count"] == len(record["isovalues"]) * record["positions"] == 4
    assert record["memory"]["blocks"] == 6**3 and record["memory"]["pixels"] == 64 * 48
    rows = record["by_pass"]["with"]
    assert len(rows) <= len(record["by_pass"]["without"])
    done = [row["completed"] for row in rows]
    assert done == sorted(done) and done[-1] == 1
    assert 0 < record["table2"]["visible_percent"] <= 100
    explicit = record["explicit"]
    assert all(m["triangles"] > 0 and m["bytes"] > 0 for m in explicit["meshes"])
    for ours, theirs in zip(
        np.repeat(explicit["active_percent"], 2), record["active"]["max_percent"]
    ):
        assert theirs <= ours + 1e-9 or ours == 100


def test_moved_bytes(results):
    """An image's time has a floor: its pixels, its blocks decoded and intersected, once."""
    record = load_document(results("paper") / "results.json")["measurements"]["protocol"][0]
    pixels = 64 * 48 * 32
    assert (
        pixels
        < record["moved_bytes"]
        < pixels + 6**3 * (256 + 64 + 256) * len(record["by_pass"]["with"])
    )


@pytest.mark.parametrize("name, kind", [("peers", "peers"), ("paper", "protocol")])
def test_largest_mesh(results, folder, name, kind):
    """Larger volumes have no meshes; everything else stays."""
    out = f"{name}-no-mesh"
    call_progiso(
        folder,
        "bench",
        name,
        *TINY,
        *OPTIONS.get(name, ()),
        "--largest-mesh",
        16,
        "--no-plots",
        "--output",
        out,
    )
    measured = [
        load_document(folder / of / "results.json")["measurements"][kind][0] for of in (name, out)
    ]
    text = json.dumps(measured[1])
    assert "no meshes of volumes larger than 16" in text and "triangles" not in text
    assert "triangles" in json.dumps(measured[0]) and measured[0].keys() == measured[1].keys()


def test_random_isovalues_are_seeded():
    field = parse_field("ct-cranium")
    low, high = min(field.isovalues), max(field.isovalues)
    values = field.random_isovalues(50, 3)
    assert values == field.random_isovalues(50, 3) != field.random_isovalues(50, 4)
    assert all(low <= v <= high for v in values)
    assert Settings((8, 8), PEERS, 2).isovalues_of(field) == list(field.isovalues)


def test_report_makes_the_same_of_json(results, folder):
    call_progiso(folder, "bench", "report", "quick/results.json", "--output", "again")
    for path in results("quick").glob("*.md"):
        assert (folder / "again" / path.name).read_bytes() == path.read_bytes()
    assert {p.name for p in (folder / "again").glob("*.png")} == {
        p.name for p in results("quick").glob("*.png")
    }


def test_report_as_a_page(results, folder):
    """A Markdown file of any name has its plots in a folder of that name."""
    call_progiso(
        folder, "bench", "report", results("quick") / "results.json", "--output", "pages/machine.md"
    )
    text = (folder / "pages" / "machine.md").read_text()
    shown = re.findall(r"!\[\]\((.*)\)", text)
    assert shown and all(name.startswith("machine/") for name in shown)
    assert sorted(shown) == sorted(
        f"machine/{p.name}" for p in (folder / "pages" / "machine").iterdir()
    )
    assert text == (results("quick") / "results.md").read_text().replace("![](", "![](machine/")


def test_reports_are_put_together(results, folder):
    paths = [results(name) / "results.json" for name in ("peers", "budget", "peers")]
    call_progiso(folder, "bench", "report", *paths, "--output", "both")
    text = (folder / "both" / "results.md").read_text()
    assert "## Side by side" in text and "## Memory budgets" in text
    merged = merge([load_document(path) for path in paths])
    assert len(merged["measurements"]["peers"]) == 1 and len(merged["runs"]) == 3


def test_measuring_needs_no_matplotlib(folder):
    """A machine without it leaves the plots to another one."""
    (folder / "bare").mkdir()
    (folder / "bare" / "matplotlib.py").write_text("raise ImportError('not here')")
    path = os.pathsep.join(filter(None, (str(folder / "bare"), os.environ.get("PYTHONPATH"))))
    environment = dict(os.environ, PYTHONPATH=path)
    command = [
        sys.executable,
        "-m",
        "progiso",
        "bench",
        "peers",
        *map(str, TINY),
        "--no-plots",
        "--output",
        "bare",
    ]
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    assert (folder / "bare" / "results.md").is_file() and not list((folder / "bare").glob("*.png"))


def test_soak_judges_what_is_left_behind(results):
    """Memory may not grow by more than the goal, steps and noise aside, and OpenGL may have no
    errors."""
    document = load_document(results("soak") / "results.json")
    (record,) = document["measurements"]["soak"]
    assert (
        record["samples"]["frame"] == list(range(41))
        and record["warm_up"] == 10
        and record["gl_errors"] == 0
    )
    assert sum(record["changes"].values()) > 0 and min(record["samples"]["rss"]) > 2**24
    assert all(
        peak >= rest > 2**16
        for peak, rest in zip(record["samples"]["peak"], record["samples"]["mapper"])
    )
    frames, noise = np.arange(0, 10001, 50), np.random.default_rng(1).normal(0, 2**18, 201)
    for slope, met in ((0.9, True), (1.1, False)):
        rss = 1e9 + slope * 2**20 * frames / 1000 + noise + 2**23 * (frames > 1000)
        record["growth"]["rss"] = growth({"frame": frames, "rss": rss}, "rss", 2000)
        assert record["growth"]["rss"] == pytest.approx(slope * 2**20 / 1000, rel=0.05)
        row = next(
            line
            for line in markdown(document, {}).splitlines()
            if line.startswith("| main memory of the process")
        )
        assert ("in 1000 frames: met |" in row) == met != ("**not met**" in row)
    record["gl_errors"] = 1
    assert "none: **not met**" in markdown(document, {})


FAILURES = {
    "set": (["fastest"], "fastest"),
    "field": (["peers", "--fields", "teapot-64"], "teapot-64"),
    "size of a scan": (["peers", "--fields", "ct-cranium-64"], "ct-cranium-64"),
    "k": (["peers", "--fields", "sphere-16-k3"], "sphere-16-k3"),
    "rate": (["peers", "--fields", "gyroid-16-r40"], "gyroid-16-r40"),
    "isovalues": (["paper", "--isovalues", "some"], "some"),
    "positions": (["paper", "--positions", "1"], "at least 2"),
    "image size": (["paper", "--size", "0x5"], "0x5"),
    "image too large": (["paper", "--size", "20000x5"], "16384"),
    "images": (["scaling", "--images", "64x48,wide"], "wide"),
    "largest": (["scaling", "--largest", "3"], "64"),
    "reference too large": (["bounds", "--images", "64x48,4000x40"], "2048"),
    "baseline": (["interactive", "--baseline", "no-such-thing"], "no-such-thing"),
    "baseline without a package": (["first-image", "--baseline", "an-empty-folder"], "holds no"),
    "baseline that is no archive": (["interactive", "--baseline", "a-file"], "no archive"),
    "frames": (["interactive", "--frames", "0"], "at least 1"),
    "output": (["peers", "--output", "a-file"], "a-file"),
    "no results": (["report", "none.json"], "none.json"),
    "not JSON": (["report", "a-file"], "a-file"),
    "other JSON": (["report", "other.json"], "schema"),
    "damaged JSON": (["report", "damaged.json"], "machine"),
}


@pytest.mark.parametrize("case", FAILURES)
def test_errors_are_one_line(folder, case):
    arguments, word = FAILURES[case]
    (folder / "a-file").write_text("?")
    (folder / "an-empty-folder").mkdir(exist_ok=True)
    (folder / "other.json").write_text('{"schema": 0}')
    (folder / "damaged.json").write_text('{"schema": 1}')
    lines = call_progiso(folder, "bench", *arguments, succeeds=False).strip().splitlines()
    assert len(lines) == 1, lines
    assert "error" in lines[0] and word in lines[0]


def test_machines_are_not_mixed(results):
    one = load_document(results("peers") / "results.json")
    other = copy.deepcopy(one)
    other["machine"]["cpu"] = "another"
    with pytest.raises(ValueError, match="cpu"):
        merge([one, other])


def test_rates_tell_what_they_cost(results):
    """Errors fall with the rate; the finest keeps the surface as it is."""
    record = load_document(results("rates") / "results.json")["measurements"]["rates"][0]
    points = record["points"]
    assert [point["rate"] for point in points] == sorted(point["rate"] for point in points)
    for key in ("max_error", "rms_error", "p99"):
        assert points[0][key] > 5 * points[4][key] > 500 * points[-1][key]
    assert points[-1]["wrong"] == 0 and points[-1]["triangles"] == record["topology"]["triangles"]
    values = progiso.read(fetch("gyroid", size=24, k=2)).GetPointData().GetScalars()
    decoded = progiso.decompress(
        progiso.compress(progiso.read(fetch("gyroid", size=24, k=2)), rate=points[2]["rate"])
    )
    off = vtk_to_numpy(decoded.GetPointData().GetScalars()).astype(float) - vtk_to_numpy(values)
    assert points[2]["max_error"] == np.abs(off).max()
    assert points[2]["rms_error"] == pytest.approx(np.sqrt(np.mean(off**2)))


def test_bounds_order_the_ways(results):
    """The volume itself is drawn exactly; levels spare blocks, and only where rays look at the
    volume, too, is nothing missed; VTK's errors grow with its steps."""
    record = load_document(results("bounds") / "results.json")["measurements"]["bounds"][0]
    assert record["exact"] == "caster"
    hits = [view["hits"] for view in record["views"]]
    assert hits == sorted(hits, reverse=True) and hits[-1] > 0
    for view in record["views"]:
        rows = {row["way"]: row for row in view["rows"]}
        assert list(rows) == [*OURS, *THEIRS]
        off, coarse, conservative = (rows[w] for w in ("Off", "On, 2 pixels", "Conservative"))
        assert off["largest"] < 1e-4 and off["missed"] == off["invented"] == off["uncertain"] == 0
        assert off["levels"]["0"] == view["hits"] and coarse["levels"]["0"] == 0
        assert coarse["blocks"] < off["blocks"] and coarse["uncertain"] > 0
        assert coarse["mean"] > 1000 * off["mean"] and coarse["mean"] > conservative["mean"]
        assert conservative["missed"] == conservative["uncertain"] == 0
        theirs = [rows[way]["mean"] for way in THEIRS]
        assert theirs == sorted(theirs) and theirs[0] > 100 * off["mean"]
        assert all(row["ms"] > 0 and 0 < row["color"] < 255 for row in rows.values())
    middle = {row["way"]: row["missed"] for row in record["views"][0]["rows"]}
    assert middle["On"] > 0 and middle["VTK, 4 voxels"] > middle["VTK, 1 voxel"] > 0


def test_bounds_of_what_fails(results):
    """A way or a field that cannot be drawn is told, and everything else stays."""
    document = load_document(results("bounds") / "results.json")
    before = markdown(document, {})
    document["measurements"]["bounds"][0]["views"][1]["rows"][-1] = {"way": "W", "failed": "no GPU"}
    text = markdown(document, {})
    assert "|  | W | no GPU |" in text and text.count("\n") == before.count("\n")
    widths = {line.count("|") for line in text.splitlines() if line.startswith("|  |")}
    assert len(widths) == 1
    document["measurements"]["bounds"][0] = {"field": "F", "size": [8, 6], "left_out": "too large"}
    document["measurements"]["bounds"][0]["others_cores"] = 0
    assert "F, 8×6: too large." in markdown(document, {})


def test_errors_in_footprints():
    """Depths are off in pixels' footprints where they are; missed and invented rays count apart."""
    inf = np.inf
    exact = np.array([10.0, 20.0, 40.0, 10.0, inf, inf])
    depth = np.array([10.0, 21.0, 38.0, inf, 5.0, inf])
    found = depth_errors(depth, exact, np.array([0.1, 0.1, 0.2, 0.1, 0.1, 0.1]))
    assert found["mean"] == pytest.approx((0 + 1 / 2 + 2 / 8) / 3)
    assert found["largest"] == pytest.approx(0.5) and 0.48 < found["p99"] < 0.5
    assert found["missed"] == found["invented"] == 1 / 4
    nothing = depth_errors(np.full(2, inf), np.full(2, inf), np.ones(2))
    assert nothing == {"mean": None, "p99": None, "largest": None, "missed": 0, "invented": 0}


def test_color_error_is_that_of_what_is_shown():
    reference = np.zeros((2, 3, 3), np.float32)
    picture = np.zeros((2, 3, 3), np.uint8)
    assert color_error(picture, reference) == 0
    reference[0, 0], picture[1, 2] = 4.0, 4
    assert color_error(picture, reference) == 4
    reference[0, 1], picture[0, 1] = 7.5, 7
    assert color_error(picture, reference) == pytest.approx(np.sqrt((4**2 + 4**2 + 0.5**2) / 3))


def test_averaged_squares():
    picture = np.zeros((4, 6, 3), np.uint8)
    picture[:2, 2:4] = 255
    picture[3, 5, 1] = 2
    expected = np.zeros((2, 3, 3))
    expected[0, 1], expected[1, 2, 1] = 255, 0.5
    assert np.array_equal(averaged(picture, 2), expected)


def test_sheets_show_what_is_wrong(results, folder):
    """There is one for every view, with all pictures; differences from the last are amplified."""
    results("bounds")
    names = {path.name for path in (folder / "sheets").iterdir()}
    assert names == {f"{view}-gyroid-72-k6-r8-64x48.png" for view in ("middle", "far", "farthest")}
    picture = np.zeros((60, 80, 3), np.uint8)
    picture[20:40, 10:30] = 90
    brighter = picture + np.uint8(10) * (picture > 0)
    draw_sheet({"one": picture, "other": brighter}, folder / "sheet.png")
    pixels = np.round(255 * imread(folder / "sheet.png")[..., :3]).astype(int)
    upper, lower = np.array_split(pixels, 2)
    for value, there in ((90, upper), (100, upper), (4 * 10, lower)):
        shown = int((there == value).all(axis=-1).sum())
        assert 180**2 <= shown < 180**2 + 200  # enlarged nine times; letters have such pixels, too


def test_goals_are_computed(results):
    """A figure beyond its goal turns the verdict, in the tables and in the summary."""
    document = load_document(results("paper") / "results.json")
    for records in document["measurements"].values():
        records[0]["others_cores"] = 0.0
    record = document["measurements"]["latency"][0]
    record["cold"]["mean"] = 100.0
    for milliseconds, verdict, met in (
        (49.0, "(50 ms): met", 1),
        (51.0, "(50 ms): **not met**", 0),
    ):
        record["moved"]["mean"] = milliseconds
        text = markdown(document, {})
        assert verdict in text
        assert f"## Goals: {1 + met} of 2 met" in text


def test_busy_machines_are_told(results):
    """Where other processes took the processor no time is judged; memory still is."""
    document = load_document(results("paper") / "results.json")
    records = [record for records in document["measurements"].values() for record in records]
    assert all(record["others_cores"] is None or record["others_cores"] >= 0 for record in records)
    document["machine"]["cores"] = 2
    for record in records:
        record["others_cores"] = 0.02
    assert "busy" not in markdown(document, {})
    for record in records:
        record["others_cores"] = 1.3
    record = document["measurements"]["latency"][0]
    for record["moved"]["mean"] in (0.1, 1e6):
        text = markdown(document, {})
        assert (
            "**The machine was busy**: other processes took up to 1.3 of its 2 cores during 2 of 2"
            in text
        )
        assert "## Goals: 1 of 1 met, 1 not judged" in text
        assert "not met" not in text


def test_goals_by_machine():
    gpu, software = {"gl": GPU, "cores": 16}, {"gl": "llvmpipe (LLVM 15)", "cores": 2}
    assert goals.complete_image(gpu, (1280, 720), 1024**3, 9.9).met
    assert not goals.complete_image(gpu, (1280, 720), 1024**3, 10.1).met
    assert goals.complete_image(gpu, (1280, 720), 2048 * 2048 * 1920, 19.0).met
    assert goals.complete_image(gpu, (640, 360), 1024**3, 9.9) is None
    assert goals.complete_image(software, (1280, 720), 1024**3, 9.9) is None
    published, strong = goals.against_paper(gpu, "gyroid-256-k6-r2", (1280, 720), 8.0)
    assert published.met and not strong.met
    assert [
        v.met for v in goals.against_paper(software, "gyroid-256-k6-r2", (640, 360), 500.0)
    ] == [True, True]
    assert goals.against_mapper(software, (1280, 720), "ct-cranium-r8", 7_000_000, 500.0, 600.0).met
    assert (
        goals.against_mapper(
            software, (1280, 720), "marschner-lobb-128-k6-r4", 2_000_000, 500.0, 600.0
        )
        is None
    )
