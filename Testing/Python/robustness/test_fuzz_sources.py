"""Damaged files of every format are refused in words: a short run of the fuzzer of sources."""

import subprocess
import sys

from helpers import REPOSITORY


def test_a_short_run(tmp_path):
    script = REPOSITORY / "Testing" / "Fuzz" / "fuzz_sources.py"
    command = [sys.executable, str(script), "--cases", "3", "--seed", "7"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    assert " 0 faults" in done.stdout
