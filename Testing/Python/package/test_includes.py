"""What includes what in C++ and GLSL: folders in one direction, shaders without loops."""

import graphlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
SHADERS = ROOT / "Kernels" / "Shaders"

# The folders of a module from top to bottom: a file includes those of its own folder and below.
FOLDERS = {
    "Kernels": ("Scene", "Pipeline", "Store", "GL", "Shaders"),
    "Filters": ("Contour", "Format", "Pieces", "Codec"),
}
# The VTK classes stand above the folders, but for the values that all parts of a module share.
VALUES = {"Status.h", "vtkBlockMask.h", "vtkBlockRanges.h", "vtkCompressedVolume.h"}
# Where samples are: the assembler pastes one of these.
BLOCK_ACCESS = ("Cache/CachedBlocks.glsl", "Cache/DecodedVolume.glsl")
SHADER_SUFFIXES = {".comp", ".frag", ".glsl", ".vert"}


def included(file):
    """Paths that a file includes in quotes, as they are written."""
    return re.findall(r'^\s*#include "([^"]+)"', file.read_text(encoding="utf-8"), re.M)


def sources(module):
    """C++ files of a module, by their paths in it; tests may include what they like."""
    files = (*(ROOT / module).rglob("*.cxx"), *(ROOT / module).rglob("*.h"))
    return [file.relative_to(ROOT / module) for file in files if not file.name.startswith("Test")]


def own_includes(module, file):
    """What a file includes of its own module, beside itself or from the root; by paths in it."""
    for target in included(ROOT / module / file):
        for path in (file.parent / target, Path(target)):
            if (ROOT / module / path).is_file():
                yield path
                break


@pytest.mark.parametrize("module", FOLDERS)
def test_folders_include_one_way(module):
    order = FOLDERS[module]
    for file in sources(module):
        for target in own_includes(module, file):
            if len(file.parts) == 1 or target.name in VALUES:
                continue
            allowed = order[order.index(file.parts[0]) :]
            assert target.parts[0] in allowed, f"{module}/{file} includes {target}"


@pytest.mark.parametrize("module", FOLDERS)
def test_headers_include_without_loops(module):
    headers = [file for file in sources(module) if file.suffix == ".h"]
    graph = {header: list(own_includes(module, header)) for header in headers}
    assert list(graphlib.TopologicalSorter(graph).static_order())


@pytest.mark.parametrize("module", FOLDERS)
def test_no_folder_is_unknown(module):
    assert {file.parts[0] for file in sources(module) if len(file.parts) > 1} <= set(
        FOLDERS[module]
    )


def shader_includes():
    """{shader: the shaders that it includes}, by their paths below Shaders."""
    graph = {}
    for file in SHADERS.rglob("*"):
        if file.suffix in SHADER_SUFFIXES:
            chosen = re.search(r"^#include BLOCK_ACCESS$", file.read_text("utf-8"), re.M)
            targets = [*included(file), *(BLOCK_ACCESS if chosen else ())]
            graph[file.relative_to(SHADERS).as_posix()] = targets
    assert graph
    return graph


def test_shaders_include_without_loops():
    assert list(graphlib.TopologicalSorter(shader_includes()).static_order())


def test_every_shader_include_exists():
    for shader, targets in shader_includes().items():
        for target in targets:
            assert (SHADERS / target).is_file(), f"{shader} includes {target}"


def test_every_included_shader_is_used():
    """No file of functions is left over that no stage includes."""
    graph = shader_includes()
    used = {target for targets in graph.values() for target in targets}
    assert {shader for shader in graph if shader.endswith(".glsl")} <= used
