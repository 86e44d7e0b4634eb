"""Real scans, fetched on demand from Debian packages that carry them."""

from __future__ import annotations

import hashlib
import os
import plistlib
import shutil
import subprocess
import tarfile
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkImageData

from ..geometry import image_from_array
from ..io import read, save


@dataclass(frozen=True)
class Scan:
    """A real volume and where it comes from.

    Attributes
    ----------
    name : str
        What it is asked for by.
    description : str
        What it shows.
    dimensions : tuple of int
        Samples along x, y and z.
    spacing : tuple of float
        Millimetres.
    dtype : str
        Type of its samples.
    isovalues : dict
        Interesting isovalues by what they show.
    package, member : str
        Debian package, and the file in it.
    sha256 : str
        Digest of that file.
    source, licence : str
        Who made it, and under which terms the package distributes it.
    convert : callable
        Makes a `vtkImageData` of the file.
    """

    name: str
    description: str
    dimensions: tuple[int, int, int]
    spacing: tuple[float, float, float]
    dtype: str
    isovalues: dict[str, float]
    package: str
    member: str
    sha256: str
    source: str
    licence: str
    convert: Callable[[Path], vtkImageData]


def fetch_scan(scan: Scan, folder: str | os.PathLike[str]) -> Path:
    """Fetch a scan as ``.vti``, from the cache where it is there.

    Parameters
    ----------
    scan : Scan
        One of `SCANS`.
    folder : pathlib.Path
        Where to keep it.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    RuntimeError
        When the package cannot be fetched, or holds another file than expected.
    """
    path = Path(folder) / f"{scan.name}.vti"
    if path.is_file():
        return path
    with tempfile.TemporaryDirectory(prefix=".progiso-", dir=folder) as scratch:
        member = Path("/", scan.member)  # the package may be installed
        if not member.is_file():
            member = _unpack(scan.package, Path(scratch)) / scan.member
        _check(member, scan)
        image = scan.convert(member)
    if image.GetDimensions() != scan.dimensions:
        raise RuntimeError(
            f"{scan.name} has {image.GetDimensions()} samples, not {scan.dimensions}"
        )
    save(image, path)
    return path


def _unpack(package: str, folder: Path) -> Path:
    """Download a Debian package and unpack it, without installing it."""
    if not (shutil.which("apt-get") and shutil.which("dpkg")):
        raise RuntimeError(f"fetching the Debian package {package} needs apt-get and dpkg")
    download = _run(["apt-get", "download", package], folder)
    archives = list(folder.glob("*.deb"))
    if download.returncode or not archives:
        complaints = [line for line in download.stderr.splitlines() if line.startswith("E:")]
        reason = complaints[0][2:].strip() if complaints else "apt-get download failed"
        raise RuntimeError(
            f"cannot fetch the Debian package {package}: {reason} "
            "(is the package list there? try 'apt-get update' as root)"
        )
    unpacked = _run(["dpkg", "-x", archives[0].name, "unpacked"], folder)
    if unpacked.returncode:
        raise RuntimeError(f"cannot unpack {archives[0].name}: {unpacked.stderr.strip()}")
    return folder / "unpacked"


def _run(command: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def _check(path: Path, scan: Scan) -> None:
    """Check that a file is the expected one, so that all measure the same data."""
    if not path.is_file():
        raise RuntimeError(f"the Debian package {scan.package} no longer holds {scan.member}")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    if digest != scan.sha256:
        raise RuntimeError(f"{scan.member} of {scan.package} is not the expected file: {digest}")


def _read_invesalius(path: Path) -> vtkImageData:
    """Read an InVesalius project: a tar.gz of a property list and raw samples."""
    with tarfile.open(path) as archive:
        members = {Path(m.name).name: m for m in archive.getmembers() if m.isfile()}
        project = plistlib.loads(_member(archive, members["main.plist"]))
        matrix = project["matrix"]
        samples = _member(archive, members[matrix["filename"]])
    values = np.frombuffer(samples, np.dtype(matrix["dtype"]).newbyteorder("<"))
    image = image_from_array(values, matrix["shape"][::-1], name="HU")
    image.SetSpacing(project["spacing"])
    return image


def _member(archive: tarfile.TarFile, member: tarfile.TarInfo) -> bytes:
    """Read a file of an archive."""
    file = archive.extractfile(member)
    assert file is not None  # it is a file, not a folder
    return file.read()


SCANS = {
    scan.name: scan
    for scan in (
        Scan(
            name="ct-cranium",
            description="CT of a human head; face towards +y, top towards +z",
            dimensions=(256, 256, 108),
            spacing=(0.9570312, 0.9570312, 1.5),
            dtype="int16",
            isovalues={"bone": 226, "skin": -200, "teeth": 1200},
            package="invesalius-examples",
            member="usr/share/doc/invesalius-examples/examples/Cranium.inv3",
            sha256="3b34f11f7c4f557f4c65cd6543c412a2f6ceb0cfecfd9c41184420e02d9b7e2a",
            source="InVesalius, Centro de Tecnologia da Informação Renato Archer",
            licence="GPL-2",
            convert=_read_invesalius,
        ),
        Scan(
            name="mri-brain",
            description="T1 MRI of a human brain (Colin 27, skull stripped); face towards +y",
            dimensions=(301, 370, 316),
            spacing=(0.5, 0.5, 0.5),
            dtype="uint8",
            isovalues={"cortex": 45, "white matter": 100},
            package="mricron-data",
            member="usr/share/mricron/templates/ch2better.nii.gz",
            sha256="a094f3ccf383c495c9569625bd0c06993fd4b02d2a8d9966da5fea7d7e530e8d",
            source="MRIcron, Chris Rorden (ch2better)",
            licence="BSD-3-Clause",
            convert=read,
        ),
    )
}
