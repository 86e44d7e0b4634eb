"""Magnitudes of vectors in files: compressing takes them as component -1, reading says so."""

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy

import progiso
from progiso.cli import main
from progiso.io import Selection

VECTORS = np.random.default_rng(3).normal(size=(9, 10, 11, 3)).astype(np.float32)


def write_nifti(path):
    nibabel = pytest.importorskip("nibabel")
    values = VECTORS.transpose(2, 1, 0, 3)[:, :, :, np.newaxis]
    nibabel.save(nibabel.Nifti1Image(values, np.eye(4)), path / "v.nii")
    return path / "v.nii"


def write_hdf5(path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path / "v.h5", "w") as file:
        file["v"] = VECTORS
    return f"{path / 'v.h5'}:/v"


def write_nrrd(path):
    depth, height, width, _ = VECTORS.shape
    header = f"NRRD0005\ntype: float\ndimension: 4\nsizes: 3 {width} {height} {depth}\n"
    header += "kinds: vector space space space\nendian: little\nencoding: raw\n\n"
    (path / "v.nrrd").write_bytes(header.encode() + VECTORS.tobytes())
    return path / "v.nrrd"


@pytest.mark.filterwarnings("ignore:.*taken:UserWarning")
@pytest.mark.parametrize("write", [write_nifti, write_hdf5, write_nrrd])
def test_magnitude(write, tmp_path, capsys):
    path = write(tmp_path)
    volume = progiso.compress_file(path, rate=24, component=-1)
    found = vtk_to_numpy(progiso.decompress(volume).GetPointData().GetScalars())
    assert np.allclose(
        found.reshape(VECTORS.shape[:3]), np.linalg.norm(VECTORS, axis=-1), atol=1e-4
    )
    with pytest.raises(ValueError, match=r"v\.\w+.* holds no magnitudes.*compress"):
        progiso.read(path, component=-1)
    with pytest.raises(ValueError, match=r"holds no magnitudes"):
        progiso.compress_file(path, selection=Selection(component=-1))
    target = tmp_path / "v.vti"
    assert main(["compress", str(path), str(target), "--component", "-1", "--rate", "24"]) == 0
    assert progiso.describe(progiso.read(target))["component"] == -1
