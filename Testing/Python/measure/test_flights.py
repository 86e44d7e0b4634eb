"""Fly-throughs and first images: what is shown, by whose package, and how it is judged."""

import json
import shutil
import sys
import tarfile
from pathlib import Path

import numpy as np
import pytest
from vtkmodules.vtkCommonDataModel import vtkImageData

import progiso
from helpers.programs import call_progiso
from progiso import _built
from progiso.bench import driver, first_image, goals, interactive, processes
from progiso.bench.fields import parse_field
from progiso.bench.literature import GPU
from progiso.bench.report import markdown
from progiso.bench.settings import PEERS, Settings
from progiso.bench.timing import summary
from progiso.measure.document import load_document

PACKAGE = Path(_built.__file__).parents[1]
FIELD = parse_field("gyroid-24-k2-r8")
FAST = {"gl": GPU, "cores": 16}
SLOW = {"gl": "llvmpipe (LLVM 15)", "cores": 2}
HD = (1280, 720)


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    """Return the document of a fly-through, beside this package as the earlier one."""
    folder = tmp_path_factory.mktemp("flight")
    call_progiso(
        folder, "bench", "interactive", "--fields", FIELD.name, "--positions", 2, "--images",
        "64x48", "--frames", 12, "--repeat", 2, "--baseline", PACKAGE, "--no-plots",
        "--output", "out",
    )  # fmt: skip
    return load_document(folder / "out" / "results.json")


def cameras(count=3):
    image = vtkImageData()
    image.SetDimensions(9, 9, 9)
    return [progiso.orbit_camera(image, i, count) for i in range(count)]


def frames_of(name, frames=8, isovalues=(0.0, -1.0, 2.0)):
    return driver.MOVEMENTS[name](cameras(), list(isovalues), frames)


def offset(frame):
    return np.subtract(frame.camera.position, frame.camera.focal_point)


def angle(one, other):
    a, b = offset(one), offset(other)
    return np.degrees(np.arccos(a @ b / np.linalg.norm(a) / np.linalg.norm(b)))


@pytest.mark.parametrize("name", ["orbit", "far view"])
def test_orbits_turn_by_two_degrees(name):
    shown = frames_of(name)
    assert [frame.counted for frame in shown] == [False, *[True] * 8]
    for one, other in zip(shown, shown[1:]):
        assert angle(one, other) == pytest.approx(2.0)
        assert np.linalg.norm(offset(other)) == pytest.approx(np.linalg.norm(offset(one)))


def test_dollies_follow_each_other():
    """In from the orbit's distance, then out from where that ended; the same step every time."""
    near, far = frames_of("dolly in"), frames_of("dolly out")
    first = np.linalg.norm(offset(frames_of("orbit")[0]))
    distances = [[np.linalg.norm(offset(frame)) / first for frame in part] for part in (near, far)]
    assert distances[0][0] == pytest.approx(1) and distances[0][-1] == pytest.approx(driver.NEAREST)
    assert distances[1][0] == pytest.approx(driver.NEAREST)
    assert distances[1][-1] == pytest.approx(driver.FARTHEST)
    assert np.linalg.norm(offset(frames_of("far view")[0])) == pytest.approx(driver.FAR * first)
    assert frames_of("orbit")[-1].camera == near[0].camera and near[-1].camera == far[0].camera
    for part in distances:
        steps = np.divide(part[1:], part[:-1])
        assert steps == pytest.approx(steps[0])


def test_moves_begin_with_an_empty_cache():
    shown = frames_of("moved by 2°")
    assert [(frame.emptied, frame.counted) for frame in shown] == [(True, False), (False, True)] * 3
    for one, other in zip(shown[::2], shown[1::2]):
        assert angle(one, other) == pytest.approx(2.0)


def test_isovalues():
    values = [frame.isovalue for frame in frames_of("isovalue sweep")]
    assert values[0] == -1.0 and values[-1] == 2.0 and np.diff(values) == pytest.approx(3 / 8)
    assert [frame.isovalue for frame in frames_of("next view")] == [0.0] * 3 + [-1.0] * 3 + [
        2.0
    ] * 3


def test_every_way_makes_every_frame(flight):
    (record,) = flight["measurements"]["interactive"]
    rows = {row["peer"]: row for row in record["rows"]}
    assert list(rows) == [
        "ProgIso", "ProgIso, baseline", "VTK isosurface mapper", "VTK FlyingEdges",
    ]  # fmt: skip
    for peer, row in rows.items():
        times = 2 if peer.startswith("ProgIso") else 1
        assert row["processes"] == times and row["commit"] == rows["ProgIso"]["commit"]
        counts = {name: len(frames["ms"]) for name, frames in row["movements"].items()}
        expected = dict.fromkeys(driver.MOVEMENTS, 12 * times)
        expected["next view"] = 2 * len(FIELD.isovalues) * times
        expected["moved by 2°"] = 2 * times
        if peer == "VTK FlyingEdges":
            expected["isovalue sweep"] = driver.MESH_SWEEP
        assert counts == expected
        for frames in row["movements"].values():
            assert min(frames["ms"]) > 0 and frames["cpu_ms"] > 0
            assert frames["time"] == summary(frames["ms"])


def test_incomplete_frames_are_errors(tmp_path):
    """A frame counts as shown only where its image is complete."""
    path = interactive.save_compressed(FIELD, tmp_path)
    way = driver._Ours(str(path), 0.0, (64, 48))
    shown = [driver.Frame(camera, 0.0) for camera in cameras()]
    driver._time_frames(way, shown)
    way.view.mapper.SetDecodeWholeVolume(False)
    way.view.set_passes_per_render(1)
    way.view.mapper.SetSpeculationLimit(1)
    with pytest.raises(RuntimeError, match="not complete"):
        driver._time_frames(way, shown)
    way.view.close()


def test_large_volumes_are_left_to_the_mapper(monkeypatch):
    """VTK's ways are left out, with the reason, where they are told to be or memory lacks."""

    def reason(peer, **limits):
        return interactive._reason_against(peer, FIELD, Settings((64, 48), PEERS, 2, **limits))

    assert reason("mapper", largest_plain=16) == "no plain volumes larger than 16"
    assert reason("mapper", largest_plain=24) is None
    assert reason("mapper", largest_mesh=16) is None
    assert reason("mesh", largest_mesh=16) == "no meshes of volumes larger than 16"
    monkeypatch.setattr(interactive, "available_bytes", lambda: 1000)
    assert "main memory" in reason("mapper")


# ---- packages


@pytest.fixture
def earlier(tmp_path):
    """Return a folder in which a package lies as `cmake --install` leaves it."""
    package = tmp_path / "installed" / "lib" / "python3.11" / "site-packages" / "progiso"
    package.mkdir(parents=True)
    (package / "_built.py").write_text('COMMIT = "abc"\n')
    (package / "__init__.py").write_text("")
    return tmp_path / "installed"


def test_baselines_are_found(earlier, tmp_path):
    """A folder of packages, one above it, and an archive of it, which is unpacked for a while."""
    site = earlier / "lib" / "python3.11" / "site-packages"
    for given in (site, earlier):
        with processes.baseline_package(given) as found:
            assert found == site.resolve()
    with tarfile.open(tmp_path / "earlier.tar.xz", "w:xz") as archive:
        archive.add(earlier, "bundle")
    with processes.baseline_package(tmp_path / "earlier.tar.xz") as found:
        assert (found / "progiso" / "_built.py").is_file() and tmp_path not in found.parents
    assert not found.exists()
    with processes.baseline_package(None) as found:
        assert found is None


def test_processes_import_what_they_are_told_to(tmp_path):
    """A process of the earlier package has nothing of this one, not even the driver's folder."""
    site = tmp_path / "site"
    (site / "progiso" / "measure").mkdir(parents=True)
    for name, text in {
        "__init__": "",
        "_built": "COMMIT = 'an earlier one'",
        "_vtk": "vtk_errors = None",
        "measure/__init__": "",
        "measure/isosurface": "Isosurface = None",
        "measure/view": "import sys\nturned = None\nraise SystemExit(repr(sys.path))",
    }.items():
        (site / "progiso" / f"{name}.py").write_text(text)
    with pytest.raises(RuntimeError) as error:
        processes.run_job(site, "interactive")
    assert str(site) in str(error.value)
    if sys.version_info >= (3, 11):
        assert str(Path(driver.__file__).parent) not in str(error.value)
    assert str(PACKAGE / "progiso") not in str(error.value)


def test_what_a_process_says_is_the_error(tmp_path):
    with pytest.raises(RuntimeError, match="no-such-volume"):
        processes.run_job(
            None, "first_image",
            path=str(tmp_path / "no-such-volume.vti"), size=[8, 8], isovalue=0.0, images=1,
        )  # fmt: skip


# ---- first images


def test_the_drivers_cache_is_emptied_and_kept(monkeypatch):
    """Of two processes the first finds an empty folder, the second what the first has left."""
    seen = []

    def run(package, task, variables, **job):
        folder = Path(variables["__GL_SHADER_DISK_CACHE_PATH"])
        assert variables["MESA_SHADER_CACHE_DIR"] == str(folder) and task == "first_image"
        seen.append((package, folder, sorted(path.name for path in folder.iterdir())))
        (folder / "compiled").write_text("")
        times = {key: float(len(seen)) for key in first_image.TIMES}
        return {**times, "next_ms": [2.0, 4.0], "commit": "abc", "statistics": {}}

    monkeypatch.setattr(first_image, "run_job", run)
    settings = Settings((64, 48), PEERS, 2, repeat=2, baseline=PACKAGE)
    record = first_image.measure_first_image(FIELD, settings)
    assert [(package, names) for package, _, names in seen] == [
        (package, names)
        for _ in range(2)
        for package in (None, PACKAGE)
        for names in ([], ["compiled"])
    ]
    folders = [folder for _, folder, _ in seen]
    assert folders[::2] == folders[1::2] and len(set(folders)) == 4
    assert not any(folder.exists() for folder in folders)
    rows = {(row["peer"], row["cache"]): row for row in record["rows"]}
    assert rows["ProgIso", "emptied"]["first_ms"]["median"] == 3.0  # of the first and the fifth
    assert rows["ProgIso, baseline", "kept"]["complete_ms"]["median"] == 6.0
    assert rows["ProgIso", "kept"]["next_ms"] == [2.0, 4.0]
    assert rows["ProgIso", "kept"]["next"]["count"] == 4


def test_pictures_come_in_order(tmp_path):
    """A volume that is decoded as rays meet it has a first picture before the complete one."""
    path = first_image.save_compressed(parse_field("gyroid-48-k6-r4"), tmp_path)
    result = processes.run_job(
        None, "first_image", path=str(path), size=[160, 120], isovalue=0.0, images=3
    )
    assert 0 < result["read_ms"] < result["first_ms"] <= result["complete_ms"]
    assert len(result["next_ms"]) == 3 and min(result["next_ms"]) > 0
    assert result["statistics"]["converged"] and "passes" not in result["statistics"]


# ---- goals


def times(*ms):
    return summary(ms)


def test_frames_are_judged_by_the_mapper():
    slower, faster = times(5, 5, 9), times(4, 4, 8)
    judge = goals.movement_against_mapper
    assert judge(FAST, "gyroid-256-k6-r2", "orbit", faster, slower).met
    assert not judge(FAST, "gyroid-256-k6-r2", "orbit", times(4, 4, 9.5), slower).met
    assert not judge(FAST, "gyroid-256-k6-r2", "orbit", slower, slower).met
    for other in ("far view", "next view", "moved by 2°"):
        assert judge(FAST, "gyroid-256-k6-r2", other, faster, slower) is None
    assert judge(SLOW, "ct-cranium-r8", "next view", times(4, 4, 100), slower).met
    assert judge(SLOW, "ct-cranium-r8", "orbit", faster, slower) is None
    assert judge(SLOW, "gyroid-512-k12-r4", "next view", faster, slower) is None


@pytest.mark.parametrize(
    "field, movement, limit",
    [
        ("gyroid-256-k6-r2", "next view", 0.65),
        ("gyroid-512-k12-r4", "moved by 2°", 0.65),
        ("gyroid-1024-k24-r4", "next view", 0.5),
        ("gyroid-1024-k6-r2", "moved by 2°", 0.5),
        ("gyroid-2048x2048x1920-k6-r1", "next view", 0.5),
    ],
)
def test_frames_are_judged_by_the_baseline(field, movement, limit):
    base = {"time": times(10, 10, 90), "cpu_ms": 10.0}
    for share, met in ((limit - 0.01, True), (limit + 0.01, False)):
        ours = {"time": times(10 * share, 10 * share, 95), "cpu_ms": 20.0}
        assert goals.movement_against_baseline(FAST, field, HD, movement, ours, base).met == met
        assert goals.movement_against_baseline(FAST, field, (64, 48), movement, ours, base) is None
        assert goals.movement_against_baseline(FAST, field, HD, "orbit", ours, base) is None


def test_processor_time_is_judged_without_a_gpu():
    base = {"time": times(10, 10), "cpu_ms": 10.0}
    for cpu, met in ((5.9, True), (6.1, False)):
        ours = {"time": times(20, 20), "cpu_ms": cpu}
        for field in ("ct-cranium-r8", "mri-brain-r8", "gyroid-256-k6-r2"):
            verdict = goals.movement_against_baseline(SLOW, field, HD, "next view", ours, base)
            assert verdict.met == met and "CPU" in verdict.goal


def test_hitches():
    """No frame over three times the median, nor over 33 ms."""
    assert goals.no_hitch(FAST, "orbit", times(5, 5, 5, 14.9)).met
    assert not goals.no_hitch(FAST, "orbit", times(5, 5, 5, 15.1)).met
    assert not goals.no_hitch(FAST, "dolly in", times(20, 20, 20, 33.1)).met
    assert goals.no_hitch(FAST, "next view", times(5, 5, 500)) is None
    assert goals.no_hitch(SLOW, "orbit", times(5, 5, 500)) is None


def test_first_pictures_are_judged():
    def row(first, complete):
        return {"first_ms": times(first), "complete_ms": times(complete)}

    def judge(field, *pair):
        return [v.met for v in goals.first_picture(FAST, field, HD, row(*pair))]

    assert judge("gyroid-256-k6-r2", 499, 999) == [True, True]
    assert judge("gyroid-256-k6-r2", 501, 1001) == [False, False]
    assert judge("gyroid-1024-k6-r2", 1190, 1710) == [True, False]
    assert judge("gyroid-512-k12-r4", 1, 1) == []
    assert goals.first_picture(SLOW, "gyroid-256-k6-r2", HD, row(1, 1)) == []
    kept = {"next": times(4, 4)}
    assert goals.next_images(FAST, {"next": times(4.9, 4.9)}, kept).met
    assert not goals.next_images(FAST, {"next": times(5.1, 5.1)}, kept).met


def test_the_page_judges_a_flight(flight):
    """On a GPU's machine the page tells every goal, and turns with the figures."""
    document = json.loads(json.dumps(flight))
    document["machine"].update(FAST)
    (record,) = document["measurements"]["interactive"]
    record.update(field="gyroid-1024-k24-r4", size=list(HD), others_cores=0.0)
    for row in record["rows"]:
        factor = {"ProgIso": 1.0, "ProgIso, baseline": 2.1}.get(row["peer"], 1.5)
        for frames in row["movements"].values():
            frames["time"] = times(*[factor * ms for ms in (4.0, 4.0, 5.0)])
    text = markdown(document, {})
    # four movements beside the mapper, two beside the baseline, five without a hitch
    assert "## Goals: 11 of 11 met" in text
    record["rows"][0]["movements"]["orbit"]["time"] = times(4.0, 4.0, 40.0)
    assert "## Goals: 9 of 11 met" in markdown(document, {})
    record["rows"][2] = {"peer": record["rows"][2]["peer"], "failed": "takes 80 GiB"}
    text = markdown(document, {})
    assert "takes 80 GiB" in text and "## Goals: 6 of 7 met" in text


def test_the_page_tells_how_the_first_image_splits(flight):
    document = json.loads(json.dumps(flight))
    loading = {
        "input_ms": 1.0, "upload_ms": 2.0, "preparation_ms": 3.0,
        "programs": {"CastRays": {"ms": 70.0, "waited_ms": 50.0},
                     "PlanPass": {"ms": 90.0, "waited_ms": 6.0}},
    }  # fmt: skip
    base = {key: times(7.0) for key in first_image.TIMES}
    base.update(commit="abc", next_ms=[1.0], next=times(1.0), statistics={})
    rows = [
        {**base, "peer": peer, "cache": cache}
        for peer in ("ProgIso", "ProgIso, baseline")
        for cache in ("emptied", "kept")
    ]
    rows[0]["statistics"] = {"loading": loading}
    record = {"field": FIELD.name, "size": [64, 48], "rows": rows, "others_cores": 0.0}
    document["measurements"] = {"first_image": [record]}
    text = markdown(document, {})
    assert "| 1 ms | 2 ms | 3 ms | 56 ms | PlanPass 90 (6), CastRays 70 (50) |" in text
    rows[0]["statistics"] = {}
    assert "waits for programs" not in markdown(document, {})


def test_an_archive_of_this_package_is_a_baseline(tmp_path):
    """A packed package is imported from where it was unpacked."""
    site = tmp_path / "copy" / PACKAGE.relative_to(PACKAGE.parents[2]) / "progiso"
    shutil.copytree(PACKAGE / "progiso", site, ignore=shutil.ignore_patterns("__pycache__"))
    for library in PACKAGE.parents[1].glob("libvtkProgIso*"):  # a build has them apart
        shutil.copy(library, tmp_path / "copy" / "lib")
    with tarfile.open(tmp_path / "packed.tar.gz", "w:gz") as archive:
        archive.add(tmp_path / "copy", ".")
    call_progiso(
        tmp_path, "bench", "interactive", "--fields", FIELD.name, "--positions", 2, "--images",
        "32x24", "--frames", 1, "--baseline", "packed.tar.gz", "--largest-plain", 8, "--no-plots",
        "--output", "out",
    )  # fmt: skip
    (record,) = load_document(tmp_path / "out" / "results.json")["measurements"]["interactive"]
    assert [row["peer"] for row in record["rows"] if "failed" not in row] == [
        "ProgIso", "ProgIso, baseline",
    ]  # fmt: skip
