"""A volume compressed as it is read, some slices at a time, is that read and compressed whole."""

import bz2
import gzip
import subprocess
import zlib

import numpy as np
import pytest

import progiso
import progiso.io.volumes
from helpers.images import blobs, check_same, make_image
from helpers.programs import compress_command
from progiso.io import source, vtk_files, zfp

SHAPE = (13, 7, 9)  # slices, rows, columns


def values_as(kind, components=1):
    values = np.stack([blobs(SHAPE, seed) * 100 for seed in range(components)], axis=-1)
    return (values[..., 0] if components == 1 else values).astype(kind)


def write_raw(folder, kind):
    path = folder / f"volume_9x7x13_{kind}.raw"
    values_as(kind).astype(np.dtype(kind).newbyteorder("<")).tofile(path)
    return path


def write_nrrd(
    folder,
    encoding="raw",
    kind="<i2",
    components=1,
    detached=False,
    before=b"",
    byte_skip=0,
    line_skip=0,
):
    """Write the fields, then what `before` says, then the samples, encoded."""
    encode = {"raw": bytes, "gzip": gzip.compress, "bzip2": bz2.compress}[encoding]
    sizes, axes = "9 7 13", "(1,0,0) (0,2,0) (0,0.5,3)"
    if components > 1:
        sizes, axes = f"{components} {sizes}", f"none {axes}"
    kind = np.dtype(kind)
    header = [
        "NRRD0005",
        f"type: {({'i2': 'short', 'f4': 'float', 'u1': 'uint8'})[kind.str[1:]]}",
        f"dimension: {3 if components == 1 else 4}",
        f"sizes: {sizes}",
        f"endian: {'big' if kind.str[0] == '>' else 'little'}",
        f"encoding: {encoding}",
        "space: left-posterior-superior",
        f"space directions: {axes}",
        "space origin: (4,5,6)",
    ]
    header += [f"byte skip: {byte_skip}"] * bool(byte_skip) + [f"line skip: {line_skip}"] * bool(
        line_skip
    )
    lines = b"".join(b"line %d\n" % i for i in range(line_skip))
    skipped = b"x" * max(0, byte_skip)
    data = lines + encode(skipped + before + values_as(kind, components).tobytes())
    path = folder / ("volume.nhdr" if detached else "volume.nrrd")
    if detached:
        (folder / "volume.dat").write_bytes(data)
        header.append("data file: volume.dat")
        data = b""
    path.write_bytes(("\n".join(header) + "\n\n").encode() + data)
    return path


def write_metaimage(
    folder, kind="<i2", components=1, detached=False, packed=False, header_size=None
):
    kind = np.dtype(kind)
    element = {
        "i2": "MET_SHORT",
        "f4": "MET_FLOAT",
        "u1": "MET_UCHAR",
        "i1": "MET_CHAR",
        "f8": "MET_DOUBLE",
    }
    data = values_as(kind, components).tobytes()
    data = zlib.compress(data) if packed else data
    header = {
        "ObjectType": "Image",
        "NDims": 3,
        "BinaryData": True,
        "BinaryDataByteOrderMSB": kind.str[0] == ">",
        "CompressedData": packed,
        **({"CompressedDataSize": len(data)} if packed else {}),
        "TransformMatrix": "0 1 0 -1 0 0 0 0 1",
        "Offset": "4 5 6",
        "ElementSpacing": "1 2 3",
        "DimSize": "9 7 13",
        "ElementNumberOfChannels": components,
        **({} if header_size is None else {"HeaderSize": header_size}),
        "ElementType": element[kind.str[1:]],
        "ElementDataFile": "volume.bin" if detached else "LOCAL",
    }
    text = "".join(f"{key} = {value}\n" for key, value in header.items()).encode()
    path = folder / ("volume.mhd" if detached else "volume.mha")
    if detached:
        (folder / "volume.bin").write_bytes(b"x" * (11 if header_size else 0) + data)
        data = b""
    path.write_bytes(text + data)
    return path


def write_nifti(
    folder, suffix=".nii", kind="<i2", slope=None, flipped=False, times=1, second=False
):
    nibabel = pytest.importorskip("nibabel")
    values = np.stack([values_as(kind).T + t for t in range(times)], axis=-1).astype(kind)
    affine = np.array([[0, -2, 0, 4], [1, 0, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1.0]])
    if flipped:
        affine[:3, 0] *= -1
    make, header = (
        (nibabel.Nifti2Image, nibabel.Nifti2Header)
        if second
        else (nibabel.Nifti1Image, nibabel.Nifti1Header)
    )
    header = header(endianness=np.dtype(kind).str[0] if np.dtype(kind).str[0] in "<>" else "<")
    header.set_data_dtype(kind)
    image = make(values[..., 0] if times == 1 else values, affine, header)
    if slope is not None:
        image.header.set_slope_inter(slope, 1.5)
    path = folder / f"volume{suffix}"
    nibabel.save(image, path)
    return path


FILES = {
    **{
        f"raw {kind}": (write_raw, {"kind": kind})
        for kind in ("uint8", "int16", "uint32", "float32", "float64")
    },
    "nrrd": (write_nrrd, {}),
    "nrrd big": (write_nrrd, {"kind": ">f4"}),
    "nrrd gzip": (write_nrrd, {"encoding": "gzip"}),
    "nrrd bzip2": (write_nrrd, {"encoding": "bzip2", "kind": ">i2"}),
    "nrrd components": (write_nrrd, {"components": 3}),
    "nrrd detached": (write_nrrd, {"detached": True, "kind": "u1"}),
    "nrrd detached gzip": (write_nrrd, {"detached": True, "encoding": "gzip"}),
    "nrrd skipping": (write_nrrd, {"byte_skip": 5, "line_skip": 2}),
    "nrrd skipping in gzip": (write_nrrd, {"byte_skip": 5, "line_skip": 1, "encoding": "gzip"}),
    "nrrd from the end": (write_nrrd, {"byte_skip": -1, "before": b"anything"}),
    "mha": (write_metaimage, {}),
    "mha signed": (write_metaimage, {"kind": "i1"}),
    "mha big": (write_metaimage, {"kind": ">f4"}),
    "mha components": (write_metaimage, {"kind": "u1", "components": 3}),
    "mha packed": (write_metaimage, {"packed": True, "kind": "<f8"}),
    "mhd": (write_metaimage, {"detached": True}),
    "mhd packed": (write_metaimage, {"detached": True, "packed": True}),
    "mhd header": (write_metaimage, {"detached": True, "header_size": 11}),
    "mhd from the end": (write_metaimage, {"detached": True, "header_size": -1}),
    "nii": (write_nifti, {}),
    "nii big": (write_nifti, {"kind": ">f4"}),
    "nii unsigned": (write_nifti, {"kind": "u1"}),
    "nii.gz": (write_nifti, {"suffix": ".nii.gz"}),
    "nii rescaled": (write_nifti, {"slope": 0.1}),
    "nii.gz rescaled": (write_nifti, {"suffix": ".nii.gz", "slope": 0.1, "kind": "<f4"}),
    "nii flipped": (write_nifti, {"flipped": True}),
    "nii flipped rescaled": (write_nifti, {"flipped": True, "slope": 2, "kind": ">i2"}),
    "nii.gz flipped": (write_nifti, {"suffix": ".nii.gz", "flipped": True}),
    "nii series": (write_nifti, {"times": 3}),
    "nii 2": (write_nifti, {"second": True, "suffix": ".nii.gz"}),
}


@pytest.mark.parametrize("case", FILES)
def test_equals_reading_whole(case, tmp_path, monkeypatch):
    """Stream, metadata and geometry are the same, whatever a slab's depth, and without `read`."""
    write, options = FILES[case]
    path = write(tmp_path, **options)
    component = options.get("components", 1) - 1
    image = progiso.read(path)
    expected = progiso.compress(image, rate=6, component=component)
    assert np.ptp(np.array(progiso.describe(expected)["range"])) > 10
    monkeypatch.setattr(progiso.io.volumes, "read", None)
    for slab_bytes in (1, 9 * 7 * 2 * 8, 2**25):
        monkeypatch.setattr(source, "_SLAB_BYTES", slab_bytes)
        volume = progiso.compress_file(path, rate=6, component=component)
        check_same(volume, expected)
        assert volume.GetExtent() == image.GetExtent()
        assert volume.GetSpacing() == image.GetSpacing() and volume.GetOrigin() == image.GetOrigin()
        for row in range(3):
            for column in range(3):
                mine, theirs = (
                    i.GetDirectionMatrix().GetElement(row, column) for i in (volume, image)
                )
                assert mine == theirs


def test_files_that_are_read_whole(tmp_path):
    """So are VTK's formats."""
    path = tmp_path / "volume.vti"
    progiso.save(make_image(values_as("i2")), path)
    seen = []
    volume = progiso.compress_file(path, rate=6, progress=seen.append)
    check_same(volume, progiso.compress(progiso.read(path), rate=6))
    assert seen == sorted(seen) and seen[-1] == 1


def test_progress_rises(tmp_path, monkeypatch):
    monkeypatch.setattr(source, "_SLAB_BYTES", 1)
    seen = []
    progiso.compress_file(write_raw(tmp_path, "int16"), progress=seen.append)
    assert seen == [4 / 13, 8 / 13, 12 / 13, 1]


# --- errors ---------------------------------------------------------------------------------------


def cut(path, keep):
    """Keep a part of a file; return its path."""
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * keep)])
    return path


BAD_FILES = {
    "nrrd": (lambda folder: cut(write_nrrd(folder), 0.6), "truncated: it ends in slice"),
    "nrrd gzip": (lambda folder: cut(write_nrrd(folder, "gzip"), 0.6), "damaged|truncated"),
    "mha": (lambda folder: cut(write_metaimage(folder), 0.6), "truncated: it ends in slice"),
    "mha packed": (
        lambda folder: cut(write_metaimage(folder, packed=True), 0.6),
        "damaged|truncated",
    ),
    "nii": (lambda folder: cut(write_nifti(folder), 0.6), "truncated: it ends in slice"),
    "nii.gz": (lambda folder: cut(write_nifti(folder, ".nii.gz"), 0.6), "damaged|truncated"),
    "raw": (lambda folder: cut(write_raw(folder, "int16"), 0.6), "announces"),
}


@pytest.mark.parametrize("case", BAD_FILES)
def test_damaged_files_are_named(case, tmp_path):
    """The command line says the same in one line, and leaves no file."""
    write, words = BAD_FILES[case]
    path = write(tmp_path)
    with pytest.raises(ValueError, match=f"{path.name}.*({words})"):
        progiso.compress_file(path)
    (tmp_path / "out").mkdir()
    done = subprocess.run(
        compress_command(path, tmp_path / "out" / "x.vti"), capture_output=True, text=True
    )
    assert (
        done.returncode == 1
        and len(done.stderr.strip().splitlines()) == 1
        and path.name in done.stderr
    )
    assert not list((tmp_path / "out").iterdir())


def test_garbage_in_a_packed_file(tmp_path):
    path = write_metaimage(tmp_path, packed=True)
    data = bytearray(path.read_bytes())
    data[-400:-300] = b"\xff" * 100
    path.write_bytes(data)
    with pytest.raises(ValueError, match="volume.mha.*damaged"):
        progiso.compress_file(path)


def test_errors_name_the_argument(tmp_path):
    path = write_raw(tmp_path, "int16")
    for file, options, kind, words in (
        (path, {"rate": 33}, ValueError, "rate"),
        (path, {"array": "none"}, ValueError, "'none'.*'volume'"),
        (path, {"component": 1}, RuntimeError, "Component is 1"),
        (tmp_path / "none.raw", {}, FileNotFoundError, "none.raw"),
    ):
        with pytest.raises(kind, match=words):
            progiso.compress_file(file, **options)


@pytest.mark.parametrize("kind", [".vti", ".zfp"])
def test_interrupted_writing_keeps_what_was_there(kind, tmp_path, monkeypatch):
    """After Ctrl-C in the middle of writing the old file is still there, and no other."""
    from progiso import cli

    target = tmp_path / f"out{kind}"
    target.write_text("before")
    source = write_raw(tmp_path, "int16")
    writing = vtk_files.write_with

    def interrupt(writer, path):
        writing(writer, path)
        assert path.stat().st_size > 0
        raise KeyboardInterrupt

    for module in (vtk_files, zfp):
        monkeypatch.setattr(module, "write_with", interrupt)
    assert cli.main(compress_command(source, target)[3:]) == 130
    assert target.read_text() == "before"
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([source.name, target.name])
