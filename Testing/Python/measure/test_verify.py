"""`progiso verify`: the quick table holds, and would tell if it did not."""

import dataclasses
import json
import re

import numpy as np
import pytest

from helpers.programs import call_progiso
from progiso.cli import main
from progiso.measure import agreement
from progiso.oracle.caster import Camera, Cast
from progiso.verify import command, cracks, level_cracks, levels, scene
from progiso.verify.case import FAILED, LIMIT, OK, Case, Outcome, Settings, row_of, worst_of
from progiso.verify.table import SECTIONS, cases

PLAIN = "plain: smooth field"
KEYS = {"case", "verdict", "error", "limit", "time_ms"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("verify")


def test_quick_table(folder):
    """Every row has its verdict, and none fails. JSON, page and terminal agree."""
    printed = call_progiso(
        folder, "verify", "--quick", "--json", "rows.json", "--output", "page.md"
    )
    document = json.loads((folder / "rows.json").read_text())
    assert {"cpu", "cores", "gl", "vtk"} <= set(document["machine"]) and document["runs"][0][
        "complete"
    ]
    rows, page = document["rows"], (folder / "page.md").read_text()
    assert [row["case"] for row in rows] == [case.name for _, case in cases(quick=True)]
    for row in rows:
        assert KEYS <= set(row) and row["verdict"] in (OK, LIMIT), row
        assert 0 <= row["error"] <= row["limit"], row
        assert row["case"] in page
    assert len(re.findall(r"\bok\b", printed)) >= sum(row["verdict"] == OK for row in rows)


def test_names_are_unique():
    names = [case.name for listed in SECTIONS.values() for case in listed]
    assert len(names) == len(set(names))
    assert 0 < len(cases(quick=True)) <= len(cases()) == len(names)


# --- what would fail ------------------------------------------------------------------------------


def measured():
    (section, case), *others = cases(containing=PLAIN)
    assert not others
    return row_of(section, case, Settings((64, 48), 1))


@pytest.fixture
def broken(monkeypatch):
    """Have the caster see something else."""

    def change(function):
        cast = scene.caster.cast
        monkeypatch.setattr(
            scene.caster, "cast", lambda *given, **more: function(cast(*given, **more))
        )

    return change


def test_a_picture_as_it_should_be():
    row = measured()
    assert row["verdict"] == OK and 0 < row["error"] < row["limit"] and row["time_ms"] > 0


def test_a_shift_fails(broken):
    """All three depths are off by a thousandth of a voxel."""
    broken(
        lambda cast: Cast(
            *(part + 1e-3 / cast.voxels for part in (cast.depth, cast.early, cast.late)),
            cast.voxels,
        )
    )
    row = measured()
    assert row["verdict"] == FAILED and row["error"] == pytest.approx(1e-3, rel=0.02)


@pytest.mark.parametrize("value", [np.inf, 40.0])
def test_a_wrong_hit_fails(broken, value):
    """One ray misses that should hit, or hits that should miss."""

    def change(cast):
        at = np.flatnonzero(np.isfinite(cast.depth.flat) == np.isinf(value))[0]
        for part in (cast.depth, cast.early, cast.late):
            part.flat[at] = value
        return cast

    broken(change)
    row = measured()
    assert (
        row["verdict"] == FAILED
        and row["error"] is None
        and "1 rays hit where they cannot" in row["note"]
    )


def test_too_many_grazing_rays_fail(broken):
    broken(lambda cast: dataclasses.replace(cast, early=cast.early - 0.01))
    row = measured()
    assert row["verdict"] == FAILED and "graze" in row["note"] and row["error"] < row["limit"]


def test_an_exception_fails():
    def measure(_settings):
        raise RuntimeError("no luck")

    row = row_of("section", Case("case", measure), Settings())
    assert row["verdict"] == FAILED and row["error"] is None and "no luck" in row["note"]


@pytest.mark.parametrize(
    "outcome, verdict",
    [
        (Outcome(1.0, 1.0), OK),
        (Outcome(1.1, 1.0), FAILED),
        (Outcome(float("nan"), 1.0), FAILED),
        (Outcome(0.5, 1.0, documented=True), LIMIT),
        (Outcome(1.5, 1.0, documented=True), FAILED),
        (Outcome(0.0, 1.0, defect="not complete"), FAILED),
    ],
)
def test_verdicts(outcome, verdict):
    assert (
        row_of("section", Case("case", lambda _settings: outcome), Settings())["verdict"] == verdict
    )


def test_the_worst_counts():
    worst = worst_of(
        [Outcome(1e-5, 1e-4, 3.0), Outcome(2.0, 10.0, 1.0), Outcome(0.0, 1.0, 2.0, defect="bad")]
    )
    assert (worst.error, worst.time_ms, worst.defect) == (2.0, 3.0, "bad")


def test_the_command_fails_with_a_case(monkeypatch, capsys):
    """The exit status is 1, and the case is named."""
    monkeypatch.setattr(agreement.tolerances, "DEPTH_VOXELS", 1e-12)
    monkeypatch.setattr(agreement.tolerances, "DEPTH_RELATIVE", 0.0)
    monkeypatch.setattr(command, "QUICK", Settings((64, 48), 1))
    assert main(["verify", "--quick", "--cases", PLAIN]) == 1
    captured = capsys.readouterr()
    assert f"1 of 1 cases failed: {PLAIN}" in captured.err and "failed" in captured.out


@pytest.mark.parametrize(
    "arguments, message",
    [(["--cases", "no such thing"], "no case has"), (["--output", "page.txt"], "use one of .md")],
)
def test_errors_name_what_is_wrong(arguments, message, capsys):
    assert main(["verify", *arguments]) == 1
    assert message in capsys.readouterr().err


def test_agreement_of_grazing_rays():
    """Anything goes between the first possible and the first certain crossing; beyond, the distance
    to them counts."""
    early, late = (
        np.array([[1.0, 1.0, 1.0, 1.0, np.inf]]),
        np.array([[3.0, 3.0, np.inf, np.inf, np.inf]]),
    )
    cast = Cast(np.full((1, 5), 2.0), early, late, np.full((1, 5), 10.0))
    found = agreement.compare(np.array([[2.5, 3.5, np.inf, 0.5, np.inf]], np.float32), cast)
    assert found.error.tolist() == [[0, 5, 0, 5, 0]] and found.grazing == 1 and found.hits == 3
    assert found.wrong.tolist() == [[False, True, False, True, False]]


def test_rays_through_a_hole_fail(monkeypatch):
    """A closed field loses its skin after it was checked: the table counts the rays and says how to
    repeat the first."""
    closed = cracks.compressed_field

    def opened(field, rate):
        closed(field, rate)
        return scene.compressed(np.where(field.skin, 1.0, field.values).astype(np.float32), rate)

    monkeypatch.setattr(cracks, "compressed_field", opened)
    ((section, case),) = cases(containing="box of noise")
    row = row_of(section, case, Settings(rays=40_000))
    assert (
        row["verdict"] == FAILED
        and row["limit"] == 0 < row["error"]
        and "first wrong: row" in row["note"]
    )
    rays = int(re.fullmatch(r"of (\d+) rays", row["unit"])[1])
    assert rays >= 10_000 and row["error"] <= rays


# --- levels of detail -----------------------------------------------------------------------------


def row_named(text):
    ((section, case),) = cases(containing=text)
    return row_of(section, case, Settings((64, 48), 1, 10_000))


def test_another_law_of_levels_fails(monkeypatch):
    """The caster goes over to the next level a hundredth too late."""
    cast = levels.levels.cast
    monkeypatch.setattr(
        levels.levels,
        "cast",
        lambda *given, tolerance, **more: cast(*given, tolerance=0.99 * tolerance, **more),
    )
    row = row_named("levels, spacing 0.7")
    assert row["verdict"] == FAILED and row["error"] > 10 * row["limit"]


def test_levels_that_nobody_sees_fail(monkeypatch):
    monkeypatch.setattr(levels, "_SEEN", 0.9)
    row = row_named("levels, spacing 0.7")
    assert row["verdict"] == FAILED and "levels [1] are hardly seen" in row["note"]


def test_a_displaced_level_fails(monkeypatch):
    """[1 2 1]/4 on top of the filter moves surfaces inwards."""
    octant = levels._octant

    def filtered(*given):
        values, centre = octant(*given)
        for axis in range(3):
            inner = np.moveaxis(values, axis, 0)
            inner[1:-1] = 0.5 * inner[1:-1] + 0.25 * (inner[2:] + inner[:-2])
        return values, centre

    monkeypatch.setattr(levels, "_octant", filtered)
    row = row_named("voxels of level 1")
    assert row["verdict"] == FAILED and row["limit"] < row["error"] < 2 * row["limit"]


def test_a_jump_between_levels_fails(monkeypatch):
    """From frame to frame levels change by a tenth, as if they went over to the next at once."""
    monkeypatch.setattr(levels, "_STEPS", (1.0, 1.1))
    row = row_named("rays held still")
    assert row["verdict"] == FAILED and row["limit"] < row["error"] < 1


def test_a_lost_sheet_fails(monkeypatch):
    """The picture is not conservative."""
    shoot = levels.shoot

    def shoot_on(view, *given):
        view.mapper.SetLevelOfDetailToOn()
        return shoot(view, *given)

    monkeypatch.setattr(levels, "shoot", shoot_on)
    row = row_named("conservative: sheets")
    assert row["verdict"] == FAILED and row["error"] is None
    assert re.search(r"^\d+ rays miss", row["note"])


@pytest.mark.parametrize("kind", ["plane", "sphere"])
def test_rays_that_slip_through_levels_fail(kind, monkeypatch):
    """A hole of some voxels: rays pass that must hit, or hit its rim, where no surface is."""
    compress = level_cracks.with_levels

    def opened(values):
        values = values.copy()
        middle = tuple(slice(n // 2 - 12, n // 2 + 12) for n in values.shape)
        values[middle] = -10
        return compress(values)

    monkeypatch.setattr(level_cracks, "with_levels", opened)
    row = row_named(f"levels: no crack in a {kind}")
    assert row["verdict"] == FAILED and row["error"] > 100 and "first wrong: row" in row["note"]


def test_judging_rays_at_a_plane():
    """A plane halfway, seen at a right angle and from within: each kind of wrong ray is found."""
    shape, plane = (81, 81, 81), level_cracks.Surface(np.full(3, 40.0), np.array([0.0, 0.0, 1.0]))
    eye = Camera((40.0, 40.0, -60.0), (40.0, 40.0, 40.0), parallel_scale=50.0)
    origins, directions = eye.rays((20, 20))
    inside = ((origins[:, :2] > 0) & (origins[:, :2] < 80)).all(axis=1).reshape(20, 20)
    depth = np.where(inside, 100.0, np.inf)

    def judge(depth, clip=(0.0, 1e3)):
        return level_cracks.judge_rays(depth, plane, shape, eye, clip, 1.0, 4)

    wrong, judged, worst = judge(depth)
    assert not wrong.any() and judged.all() and worst < 1e-6
    missing, invented, early = depth.copy(), depth.copy(), depth.copy()
    missing[10, 10], invented[0, 0], early[8, 9] = np.inf, 100.0, 99.99
    for changed, place in ((missing, (10, 10)), (invented, (0, 0)), (early, (8, 9))):
        assert np.argwhere(judge(changed)[0]).tolist() == [list(place)]
    # rays that end before it, or begin behind it, must not hit
    for clip in ((0.0, 90.0), (110.0, 1e3)):
        assert (judge(depth, clip)[0] == inside).all()
        assert not judge(np.full((20, 20), np.inf), clip)[0].any()


@pytest.mark.parametrize("rays", ["0", "many", "-1e6", "nan", "1e300"])
def test_a_wrong_number_of_rays(rays, capsys):
    with pytest.raises(SystemExit):
        main(["verify", f"--rays={rays}"])
    assert "is no number from 1 to 1e12" in capsys.readouterr().err
