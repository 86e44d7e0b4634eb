"""Large files are compressed some slices at a time, and an interruption leaves nothing behind."""

import gzip
import os
import pathlib
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import progiso
import progiso.io.volumes
from helpers.images import stream_of
from helpers.programs import PEAK, compress_command

SIDES = (512, 512, 400)  # of float32: 400 MiB, which take no place on the disk


def sparse(folder, kind):
    """Write a file of zeros behind a header; also a compressed one is small."""
    size = 4 * int(np.prod(SIDES))
    sides = " ".join(map(str, SIDES))
    if kind == ".raw":
        path = folder / "large_512x512x400_float32.raw"
        header = b""
    elif kind.startswith(".nrrd"):
        path = folder / "large.nrrd"
        encoding = "gzip" if kind.endswith("gzip") else "raw"
        header = (
            f"NRRD0004\ntype: float\ndimension: 3\nsizes: {sides}\n"
            f"endian: little\nencoding: {encoding}\n\n"
        ).encode()
    elif kind == ".mha":
        path = folder / "large.mha"
        header = (
            f"ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = {sides}\n"
            "ElementType = MET_FLOAT\nElementDataFile = LOCAL\n"
        ).encode()
    else:
        nibabel = pytest.importorskip("nibabel")
        path = folder / "large.nii"
        small = nibabel.Nifti1Header()
        small.set_data_dtype("<f4")
        small.set_data_shape(SIDES)
        small["magic"], small["vox_offset"] = b"n+1", 352
        header = small.binaryblock + bytes(4)
    with open(path, "wb") as file:
        file.write(header)
        if kind.endswith("gzip"):
            with gzip.GzipFile(fileobj=file, mode="wb", compresslevel=1) as packed:
                for _ in range(size // 2**20):
                    packed.write(bytes(2**20))
        else:
            file.truncate(len(header) + size)
    return path


MEASURED = f"""
{PEAK}
import sys
import progiso, progiso.cli
progiso.compress(progiso.image_from_array(__import__("numpy").zeros(64**3, "f4"), (64, 64, 64)))
before = peak()
assert progiso.cli.main(sys.argv[1:]) == 0
print(peak() - before)
"""


@pytest.mark.parametrize("kind", [".raw", ".nrrd", ".nrrd gzip", ".mha", ".nii"])
def test_memory_is_that_of_slabs(kind, tmp_path):
    """400 MiB of samples and 12.5 MiB of stream take less than 130 MiB. 45 are usual, 82 with gzip;
    reading the whole file takes 414."""
    path = sparse(tmp_path, kind)
    arguments = compress_command(path, tmp_path / "out.vti")[3:]
    done = subprocess.run(
        [sys.executable, "-c", MEASURED, *arguments], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout.split()[-1]) < 130 * 2**20
    volume = progiso.read(tmp_path / "out.vti")
    assert volume.GetDimensions() == SIDES and not np.frombuffer(stream_of(volume), np.uint64).any()


def is_reading(process, path):
    """Tell whether a process holds a file open."""
    try:
        return any(
            link.resolve() == path for link in pathlib.Path(f"/proc/{process.pid}/fd").iterdir()
        )
    except FileNotFoundError:
        return False


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="tells when to interrupt by /proc")
def test_interrupted_leaves_nothing(tmp_path):
    """Ctrl-C while the file is read leaves no output."""
    source = tmp_path / "large_1024x1024x1024_float32.raw"
    with open(source, "wb") as file:
        file.truncate(4 * 1024**3)
    (tmp_path / "out").mkdir()
    process = subprocess.Popen(
        compress_command(source, tmp_path / "out" / "x.vti"), stderr=subprocess.PIPE, text=True
    )
    while process.poll() is None and not is_reading(process, source):
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, message = process.communicate()
    assert process.returncode == 130 and message.strip() == "progiso: interrupted"
    assert not list((tmp_path / "out").iterdir())
