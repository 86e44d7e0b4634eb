"""`progiso verify`: the quick table holds, and would tell if it did not."""

import dataclasses
import json
import re

import numpy as np
import pytest

from helpers.programs import call_progiso
from progiso.cli import main
from progiso.measure import agreement
from progiso.oracle.caster import Cast
from progiso.verify import command, cracks, scene
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


@pytest.mark.parametrize("rays", ["0", "many", "-1e6", "nan", "1e300"])
def test_a_wrong_number_of_rays(rays, capsys):
    with pytest.raises(SystemExit):
        main(["verify", f"--rays={rays}"])
    assert "is no number from 1 to 1e12" in capsys.readouterr().err
