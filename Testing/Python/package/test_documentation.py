"""The pages of the project: their links lead somewhere, and the layout names every folder."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = ("Data", "docs", "Filters", "Kernels", "Plugin", "progiso", "Testing")
PAGES = sorted(
    page.relative_to(ROOT)
    for page in (*ROOT.glob("*.md"), *(page for f in FOLDERS for page in (ROOT / f).rglob("*.md")))
)


def links(page):
    """Targets of a page's links and pictures, but for those on the web, without their anchors."""
    text = re.sub(r"```.*?```|`[^`\n]*`", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        path = target.split("#")[0]
        if path and "://" not in path:
            yield path


@pytest.mark.parametrize("page", PAGES, ids=str)
def test_links_resolve(page):
    for target in links(page):
        assert (ROOT / page.parent / target).exists(), f"{page} links to {target}"


@pytest.mark.parametrize("top", ["Filters", "Kernels", "Plugin", "progiso"])
def test_architecture_names_every_folder(top):
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    sources = (file for file in (ROOT / top).rglob("*") if "__pycache__" not in file.parts)
    for folder in sorted({file.parent.relative_to(ROOT).as_posix() for file in sources}):
        assert f"`{folder}/`" in text, f"docs/architecture.md does not name {folder}/"


def test_ways_through_the_files_exist():
    """Steps are given as `file`: `function`; a renamed function has to be renamed there too."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    steps = re.findall(r"`([\w./]+\.\w+)`:\s+`(\w+)`(?:[^`;.]*(?:and|or)\s+`(\w+)`)?", text)
    assert len(steps) > 20
    for file, *functions in steps:
        source = (ROOT / file).read_text(encoding="utf-8")
        for function in filter(None, functions):
            assert re.search(rf"\b{function}\(", source), f"{file} has no {function}"
