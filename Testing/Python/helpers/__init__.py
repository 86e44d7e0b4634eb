"""What the tests share; and where things lie."""

import pathlib

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
TESTS = REPOSITORY / "Testing" / "Python"
