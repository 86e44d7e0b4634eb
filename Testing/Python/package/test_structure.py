"""The package as a whole: which parts may import which."""

import ast
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve()
PACKAGE = next(folder / "progiso" for folder in ROOT.parents if (folder / "progiso").is_dir())
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))

# What each folder of the package may import of the others; all may import the modules at the root.
MAY_IMPORT = {
    "io": set(),
    "pyvista": set(),
    "data": {"io"},
    "oracle": set(),
    "measure": {"io", "oracle"},
    "bench": {"data", "io", "measure", "oracle"},
    "verify": {"io", "measure", "oracle"},
    "cli": {"bench", "data", "io", "verify"},
}


def imported_folders(module):
    """Folders of the package that a module imports, by its relative imports."""
    tree = ast.parse((PACKAGE / module).read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            target = (PACKAGE / module).parents[node.level - 1] / (node.module or "").replace(
                ".", "/"
            )
            for name in [""] if node.module else [alias.name for alias in node.names]:
                parts = (target / name).relative_to(PACKAGE).parts
                if parts and parts[0] in MAY_IMPORT:
                    yield parts[0]


@pytest.mark.parametrize("folder", MAY_IMPORT)
def test_folders_import_one_way(folder):
    """There is no import loop; benchmarks and verification know nothing of each other."""
    modules = [module for module in MODULES if module.parts[0] == folder]
    assert modules
    for module in modules:
        beyond = set(imported_folders(module)) - MAY_IMPORT[folder] - {folder}
        assert not beyond, f"{module} imports {beyond}"


def test_no_folder_is_unknown():
    assert {module.parts[0] for module in MODULES if len(module.parts) > 1} == set(MAY_IMPORT)
