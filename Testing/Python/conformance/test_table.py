"""The page Testing/conformance.md names tests that are there."""

import re

from helpers import TESTS


def test_the_table_names_tests_that_are_there():
    """A test is in the file named before it, or in this folder."""
    sources = {path.name: path.read_text() for path in TESTS.rglob("test_*.py")}
    here = "".join(path.read_text() for path in (TESTS / "conformance").glob("test_*.py"))
    table = (TESTS.parent / "conformance.md").read_text()
    for row in re.findall(r"^\|.*\|$", table, re.MULTILINE):
        source = here
        for name in re.findall(r"test_\w+(?:\.py)?", row.rsplit("|", 2)[1]):
            if name.endswith(".py"):
                source = sources[name] + here
            else:
                assert f"def {name}(" in source, f"{name} is neither in the file named nor here"
