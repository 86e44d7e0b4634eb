"""Run a function once another package has been imported, without importing it ourselves."""

from __future__ import annotations

import importlib.abc
import importlib.util
import sys


def after_import(package, function):
    """Call ``function()`` now if `package` is imported already, else right after it is.

    progiso registers itself with pyvista this way in whichever order the two are imported, and
    a program that does not use pyvista does not pay for loading it.
    """
    if package in sys.modules:
        function()
    else:
        sys.meta_path.insert(0, _Finder(package, function))


class _Finder(importlib.abc.MetaPathFinder):
    """Finds one package as everybody else does, and adds a call to the end of its import."""

    def __init__(self, package, function):
        self._package, self._function = package, function

    def find_spec(self, fullname, path=None, target=None):
        if fullname != self._package:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(fullname)
        if spec is not None:
            spec.loader = _Loader(spec.loader, self._function)
        return spec


class _Loader(importlib.abc.Loader):
    """Loads with another loader, then calls a function."""

    def __init__(self, loader, function):
        self._loader, self._function = loader, function

    def create_module(self, spec):
        return self._loader.create_module(spec)

    def exec_module(self, module):
        module.__spec__.loader = module.__loader__ = self._loader
        self._loader.exec_module(module)
        self._function()
