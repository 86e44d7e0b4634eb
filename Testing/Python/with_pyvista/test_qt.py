"""In pyvistaqt's widget the image refines by Qt's event loop.

VTK's own widget for C++ is tested in Testing/Cxx/Qt.
"""

import importlib.util
import json
import sys

from helpers import TESTS
from helpers.programs import under_x


def test_qt_interactor_refines(lacking, tmp_path):
    for module in ("pyvistaqt", "qtpy", "PyQt5"):
        if not importlib.util.find_spec(module):
            lacking(f"there is no {module}")
    picture = tmp_path / "interactor.png"
    output = under_x(
        sys.executable, TESTS / "with_pyvista" / "qt_interactor.py", picture, python_path=sys.path
    )
    (found,) = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
    completed = [image["completed"] for image in found["images"]]
    assert completed == sorted(completed) and completed[-1] == 1 and len(set(completed)) > 3
    first = next(image for image in found["images"] if image["completed"] > 0)
    assert found["images"][-1]["turns"] > first["turns"], (
        "other events had to wait until the image was there"
    )
    assert found["at_once"] and found["same"] and found["hits"] > 1000 and found["errors"] == 0
    assert picture.stat().st_size > 5000
