"""The package as a whole: which parts may import which, and how functions take their options."""

import ast
import inspect
from dataclasses import fields

import pytest

import progiso
from helpers import REPOSITORY
from progiso import options

PACKAGE = REPOSITORY / "progiso"
MODULES = sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py"))

# What each folder of the package may import of the others; all may import the modules at the root.
MAY_IMPORT = {
    "io": set(),
    "pyvista": {"io"},
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


@pytest.mark.parametrize("name", progiso.__all__)
def test_few_parameters_are_positional(name):
    """Options are passed by name, so that nobody confuses two of them."""
    function = getattr(progiso, name)
    if inspect.isfunction(function):
        kinds = [parameter.kind for parameter in inspect.signature(function).parameters.values()]
        assert kinds.count(inspect.Parameter.POSITIONAL_OR_KEYWORD) <= 3


@pytest.mark.parametrize(
    "keywords, kind",
    [
        (options.CompressionKeywords, options.CompressionOptions),
        (options.RenderKeywords, options.RenderOptions),
        (options.MaterialKeywords, options.SurfaceStyle),
    ],
)
def test_keywords_are_fields(keywords, kind):
    """What editors are told of options is what there is."""
    names = {field.name for field in fields(kind)} - {"color", "opacity", "shade"}
    assert set(keywords.__annotations__) == names


@pytest.mark.parametrize(
    "function, kind",
    [
        (progiso.compress, options.CompressionOptions),
        (progiso.make_isosurface, options.SurfaceStyle),
        (progiso.make_isosurface, options.RenderOptions),
    ],
)
def test_defaults_are_those_of_the_fields(function, kind):
    """The functions that document options and the classes that hold them agree."""
    parameters = inspect.signature(function).parameters
    assert {field.name: parameters[field.name].default for field in fields(kind)} == {
        field.name: field.default for field in fields(kind)
    }


def test_actor_keywords_are_those_of_add_isosurface():
    surfaces = pytest.importorskip("progiso.pyvista.surfaces", exc_type=ImportError)
    parameters = inspect.signature(surfaces.add_isosurface).parameters.values()
    named = {p.name for p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY}
    assert set(surfaces.ActorKeywords.__annotations__) == named | set(
        options.PlotterKeywords.__annotations__
    )
