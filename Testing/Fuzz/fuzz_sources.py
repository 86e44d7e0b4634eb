#!/usr/bin/env python
"""Fuzzes the readers of files: small files of every format are damaged, opened and read.

    python Testing/Fuzz/fuzz_sources.py [--minutes M | --cases N] [--formats SUFFIX ...] [--seed S]

A worker process reads; this one watches it. A fault is a crash, a hang, or an exception other than
those that tell a user what is wrong with a file. The damaged file is then kept in `faults/` of the
present folder. Exits with 1 where there was a fault.
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

#: Seconds after which a case counts as a hang; a worker starts in some.
PATIENCE = 60

#: Address space of a worker: a header that announces more has to fail, not fill the machine.
MEMORY = 6 * 2**30

#: Samples of files whose header announces more bytes are not read.
READABLE = 2**25

#: What a user is told by; anything else would be a traceback.
TOLD = (ValueError, RuntimeError, OSError, ImportError, MemoryError)

SHAPE = (5, 6, 7)


def samples(kind: str = "<i2") -> np.ndarray:
    """Return slices of a small volume."""
    return (np.arange(np.prod(SHAPE)).reshape(SHAPE) % 120).astype(kind)


# --- seeds ----------------------------------------------------------------------------------------


def write_with_progiso(path: Path) -> None:
    import progiso

    image = progiso.image_from_array(samples().reshape(-1), SHAPE[::-1])
    if "compressed" in path.name or path.suffix == ".zfp":
        image = progiso.compress(image, rate=4)
    progiso.save(image, path, **({"appended": True} if "appended" in path.name else {}))


def write_legacy(path: Path) -> None:
    from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter

    import progiso

    writer = vtkStructuredPointsWriter()
    writer.SetInputData(progiso.image_from_array(samples().reshape(-1), SHAPE[::-1]))
    writer.SetFileName(str(path))
    writer.Write()


def write_nrrd(path: Path) -> None:
    import gzip

    header = (
        "NRRD0004\ntype: short\ndimension: 3\nsizes: 7 6 5\nendian: little\nencoding: gzip\n"
        "space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0) (0,0,3)\n"
        "space origin: (1,2,3)\n\n"
    )
    path.write_bytes(header.encode() + gzip.compress(samples().tobytes()))


def write_nibabel(path: Path) -> None:
    import nibabel

    kind = {".mgz": nibabel.MGHImage, ".mgh": nibabel.MGHImage}.get(path.suffix)
    image = (kind or nibabel.Nifti1Image)(samples().T, np.diag([1.0, 2, 3, 1]))
    nibabel.save(image, path)


def write_tiff(path: Path) -> None:
    import tifffile

    imagej = "imagej" in path.name
    options = {"imagej": True, "metadata": {"axes": "ZYX", "spacing": 3}} if imagej else {}
    if "ome" in path.name:
        options = {"metadata": {"axes": "ZYX", "PhysicalSizeZ": 3.0}, "ome": True}
    tifffile.imwrite(path, samples(), **options)


def write_hdf5(path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        array = file.create_dataset("volume", data=samples(), chunks=(2, 3, 4), compression="gzip")
        array.attrs["element_size_um"] = (3.0, 2.0, 1.0)


def write_npy(path: Path) -> None:
    np.save(path, samples())


def write_simpleitk(path: Path) -> None:
    import SimpleITK

    SimpleITK.WriteImage(SimpleITK.GetImageFromArray(samples()), str(path))


def write_dicom(path: Path) -> None:
    from pydicom.data import get_testdata_file

    shutil.copy(str(get_testdata_file("MR_small.dcm")), path)


#: Writers of seeds by name.
SEEDS: dict[str, Callable[[Path], None]] = {
    "plain.vti": write_with_progiso,
    "appended.vti": write_with_progiso,
    "compressed.vti": write_with_progiso,
    "compressed-appended.vti": write_with_progiso,
    "volume.zfp": write_with_progiso,
    "volume_7x6x5_int16.raw": write_with_progiso,
    "volume.mha": write_with_progiso,
    "packed.mha": write_simpleitk,
    "volume.vtk": write_legacy,
    "volume.nrrd": write_nrrd,
    "volume.nii": write_nibabel,
    "volume.nii.gz": write_nibabel,
    "volume.mgz": write_nibabel,
    "volume.gipl": write_simpleitk,
    "volume.dcm": write_dicom,
    "volume.tif": write_tiff,
    "imagej.tif": write_tiff,
    "volume.ome.tif": write_tiff,
    "volume.h5": write_hdf5,
    "volume.npy": write_npy,
}


# --- damage ---------------------------------------------------------------------------------------

_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?")
_HOSTILE = b"0 -1 1 255 65536 2147483647 2147483648 4294967295 -2147483648 1e308 nan 1e-320".split()


def damage(data: bytes, rng: random.Random) -> bytes:
    """Change some bytes, mostly of the header."""
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        if not changed:
            break
        end = max(1, min(len(changed), rng.choice((64, 512, 4096, len(changed)))))
        place = rng.randrange(end)
        how = rng.randrange(6)
        if how == 0:
            changed[place] ^= 1 << rng.randrange(8)
        elif how == 1:
            changed[place] = rng.choice((0, 1, 0x7F, 0x80, 0xFF))
        elif how == 2:
            changed[place : place + 4] = rng.choice((b"\xff" * 4, b"\0" * 4, b"\xff\xff\xff\x7f"))
        elif how == 3:
            del changed[place : place + rng.choice((1, 2, 8, 64))]
        elif how == 4:
            changed[place:place] = changed[place : place + rng.choice((1, 2, 8, 64))]
        else:
            numbers = list(_NUMBER.finditer(bytes(changed[:4096])))
            if numbers:
                found = rng.choice(numbers)
                changed[found.start() : found.end()] = rng.choice(_HOSTILE)
    if rng.random() < 0.2:
        del changed[rng.randrange(len(changed) + 1) :]
    return bytes(changed)


# --- the worker -----------------------------------------------------------------------------------


def read_one(path: str) -> str:
    """Open and read a file; tell what came of it."""
    from progiso.io import open_source

    try:
        with open_source(path) as source:
            if source.about.sample_bytes > READABLE:
                return "announces much"
            source.read()
            source.image()
    except TOLD as error:
        return "told: " + " ".join(f"{type(error).__name__}: {error}".split())[:200]
    except Exception as error:  # what a user would see as a traceback
        return "FAULT: " + " ".join(f"{type(error).__name__}: {error}".split())[:200]
    return "read"


def work() -> None:
    """Read the files that standard input names; answer with a line each."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("ignore")
    import progiso  # noqa: F401

    print("ready", flush=True)
    for line in sys.stdin:
        print(read_one(line.strip()).replace("\n", " "), flush=True)


class Worker:
    """A process that reads, and is started again where it ends or hangs."""

    def __init__(self) -> None:
        self._start()

    def _start(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, __file__, "--work"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        if self._answer() != "ready":
            raise RuntimeError("the worker does not start")

    def _answer(self) -> str | None:
        import select

        stdout = self._process.stdout
        ready, _, _ = select.select([stdout], [], [], PATIENCE)
        return stdout.readline().strip() if ready and stdout else None

    def read(self, path: Path) -> str:
        stdin = self._process.stdin
        assert stdin
        stdin.write(f"{path}\n")
        stdin.flush()
        answer = self._answer()
        if answer:
            return answer
        self._process.kill()
        code = self._process.wait()
        self._start()
        return "FAULT: hang" if answer is None else f"FAULT: crash, exit status {code}"

    def close(self) -> None:
        self._process.kill()
        self._process.wait()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--cases", type=int, help="of each seed, instead of a time")
    parser.add_argument("--formats", nargs="*", help="only seeds whose names contain one of these")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    parsed = parser.parse_args()
    if parsed.work:
        work()
        return 0
    names = [n for n in SEEDS if not parsed.formats or any(f in n for f in parsed.formats)]
    outcomes: Counter[tuple[str, str]] = Counter()
    faults = fuzz(names, parsed, outcomes)
    print(f"{'seed':28}{'cases':>8}{'read':>8}{'told':>8}{'much':>8}{'faults':>8}")
    for name in names:
        counts = [outcomes[name, kind] for kind in ("read", "told", "announces much", "FAULT")]
        print(f"{name:28}{sum(counts):8}" + "".join(f"{count:8}" for count in counts))
    print(f"{sum(outcomes.values())} cases, {faults} faults")
    return 1 if faults else 0


def fuzz(names: list[str], parsed: argparse.Namespace, outcomes: Counter[tuple[str, str]]) -> int:
    """Damage and read until the time or the number of cases is over; return the faults."""
    rng, faults, worker = random.Random(parsed.seed), 0, Worker()
    end = time.monotonic() + parsed.minutes * 60
    with tempfile.TemporaryDirectory() as folder:
        seeds = {}
        for name in names:
            SEEDS[name](Path(folder) / name)
            seeds[name] = (Path(folder) / name).read_bytes()
            answer = worker.read(Path(folder) / name)
            if answer != "read":
                raise RuntimeError(f"the seed {name} itself is not read: {answer}")
        number = 0
        while number < parsed.cases if parsed.cases else time.monotonic() < end:
            number += 1
            for name in names:
                path = Path(folder) / name
                path.write_bytes(damage(seeds[name], rng))
                answer = worker.read(path)
                outcomes[name, answer.split(":")[0]] += 1
                if answer.startswith("FAULT"):
                    faults += 1
                    kept = Path("faults") / f"{parsed.seed}-{number}-{name}"
                    kept.parent.mkdir(exist_ok=True)
                    shutil.copy(path, kept)
                    print(f"{kept}: {answer}", flush=True)
    worker.close()
    return faults


if __name__ == "__main__":
    sys.exit(main())
