"""Run a function once another package has been imported, without importing it ourselves."""

from __future__ import annotations

import importlib.abc
import importlib.util
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType


def after_import(package: str, function: Callable[[], object]) -> None:
    """Call ``function()`` now if `package` is imported already, else right after it is.

    A program that does not use pyvista does not pay for loading it, and the order in which the
    two packages are imported does not matter.
    """
    if package in sys.modules:
        function()
    else:
        sys.meta_path.insert(0, _Finder(package, function))


class _Finder(importlib.abc.MetaPathFinder):
    """Finds one package as everybody else does, and adds a call to the end of its import."""

    def __init__(self, package: str, function: Callable[[], object]) -> None:
        self._package, self._function = package, function

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != self._package:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(fullname)
        if spec is not None and spec.loader is not None:
            spec.loader = _Loader(spec.loader, self._function)
        return spec


class _Loader(importlib.abc.Loader):
    """Loads with another loader, then calls a function."""

    def __init__(self, loader: importlib.abc.Loader, function: Callable[[], object]) -> None:
        self._loader, self._function = loader, function

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        assert module.__spec__ is not None
        module.__spec__.loader = module.__loader__ = self._loader
        self._loader.exec_module(module)
        self._function()
