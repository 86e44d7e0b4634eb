"""Files of compressed volumes: zfp's own, against the zfp tool, and VTK's."""

import subprocess

import numpy as np
import pytest

import progiso
from helpers.filters import update
from helpers.images import (
    make_image,
    metadata,
    noise,
    reference_values,
    same_bits,
    samples_of,
    stream_of,
)
from helpers.messages import vtk_messages
from helpers.programs import run_progiso
from progiso import vtkCompressedVolume, vtkZFPReader, vtkZFPWriter
from progiso.oracle import zfp_reference


def test_vti_carries_the_stream_through_pyvista(tmp_path):
    """pyvista saves and reads a compressed volume untouched."""
    pyvista = pytest.importorskip("pyvista")
    compressed = progiso.compress(
        make_image(noise((7, 8, 9)), origin=(1, 2, 3), extent_start=(5, 6, 7)), rate=3
    )
    pyvista.wrap(compressed).save(tmp_path / "volume.vti")
    read = pyvista.read(tmp_path / "volume.vti")
    assert stream_of(read) == stream_of(compressed)
    assert read.GetExtent() == compressed.GetExtent()
    assert same_bits(samples_of(progiso.decompress(read)), reference_values(compressed))


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [0.25, 3, 8, 19.5])
def test_writer_against_the_tool(tmp_path, header, rate, lacking):
    if not zfp_reference.has_tool():
        lacking("the zfp command line tool is not installed (Debian: zfp)")
    values = noise((6, 9, 7), 6)
    compressed = progiso.compress(make_image(values), rate=rate)
    path = tmp_path / "volume.zfp"
    writer = vtkZFPWriter()
    writer.SetInputData(compressed)
    writer.SetFileName(str(path))
    writer.SetWriteHeader(header)
    assert writer.Write() == 1
    options = ["-h"] if header else ["-f", "-3", "7", "9", "6", "-r", str(rate)]
    subprocess.run(["zfp", "-q", *options, "-z", path, "-o", tmp_path / "raw"], check=True)
    assert same_bits(
        np.fromfile(tmp_path / "raw", np.float32).reshape(6, 9, 7), reference_values(compressed)
    )


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [0.25, 3, 8, 19.5])
def test_reader_against_the_tool(tmp_path, header, rate, lacking):
    if not zfp_reference.has_tool():
        lacking("the zfp command line tool is not installed (Debian: zfp)")
    values = noise((6, 9, 7), 7)
    values.tofile(tmp_path / "raw")
    options = [*(["-h"] if header else []), *"-f -3 7 9 6 -r".split(), str(rate)]
    path = tmp_path / "volume.zfp"
    subprocess.run(["zfp", "-q", *options, "-i", tmp_path / "raw", "-z", path], check=True)
    reader = vtkZFPReader()
    reader.SetFileName(str(path))
    if not header:
        reader.SetDataDimensions(7, 9, 6)
        reader.SetRate(rate)
    reader.SetDataSpacing(1, 2, 3)
    output, messages = update(reader)
    assert not messages
    expected = zfp_reference.encode(values, rate)
    assert stream_of(output).startswith(expected[: metadata(output, "BlockBits")[0] * 12 // 8])
    decoded = reference_values(output)
    assert same_bits(samples_of(progiso.decompress(output)), decoded)
    assert output.GetSpacing() == (1, 2, 3)
    assert list(metadata(output, "Range")) == [decoded.min(), decoded.max()]


@pytest.mark.parametrize("header", [False, True])
@pytest.mark.parametrize("rate", [9 / 64, 7.3, 32])
def test_reader_puts_parts_together(tmp_path, header, rate):
    """Files are read by several threads in parts of a quarter of a MiB."""
    compressed = progiso.compress(make_image(noise((61, 62, 65), 8)), rate=rate)
    writer = vtkZFPWriter()
    writer.SetInputData(compressed)
    writer.SetFileName(str(tmp_path / "volume.zfp"))
    writer.SetWriteHeader(header)
    assert writer.Write() == 1
    dimensions = None if header else (65, 62, 61)
    assert stream_of(
        progiso.read(tmp_path / "volume.zfp", dimensions=dimensions, rate=rate)
    ) == stream_of(compressed)


def test_vti_with_appended_data(tmp_path):
    """Raw bytes after the XML hold the same in less space."""
    compressed = progiso.compress(
        make_image(noise((30, 31, 32)), origin=(1, 2, 3), extent_start=(5, 6, 7)), rate=8
    )
    progiso.save(compressed, tmp_path / "in_line.vti")
    progiso.save(compressed, tmp_path / "appended.vti", appended=True)
    read = progiso.read(tmp_path / "appended.vti")
    assert stream_of(read) == stream_of(compressed)
    assert read.GetExtent() == compressed.GetExtent() and read.GetOrigin() == (1, 2, 3)
    assert (tmp_path / "appended.vti").stat().st_size < 0.8 * (
        tmp_path / "in_line.vti"
    ).stat().st_size
    with pytest.raises(ValueError, match="appended"):
        progiso.save(compressed, tmp_path / "volume.zfp", appended=True)


def test_appended_data_that_vtk_cannot_read(tmp_path, monkeypatch):
    """Where VTK's XML reader and libexpat do not go together, the message names the remedy."""
    progiso.save(make_image(noise((4, 4, 4))), tmp_path / "appended.vti", appended=True)
    monkeypatch.delenv("LD_PRELOAD", raising=False)
    done = run_progiso(tmp_path, "info", "appended.vti")
    assert done.returncode == 0 or "preload libEagerExpat.so" in done.stderr


def test_reader_refuses_what_is_no_zfp_file(tmp_path):
    path = tmp_path / "bad.zfp"
    for content, settings in (
        (b"not a zfp file", {}),
        (b"\0" * 10, {"DataDimensions": (8, 8, 8)}),
        (None, {}),
    ):
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_bytes(content)
        reader = vtkZFPReader()
        reader.SetFileName(str(path))
        for name, value in settings.items():
            getattr(reader, "Set" + name)(value)
        output, messages = update(reader)
        assert sum("vtkZFPReader" in m and "returned failure" not in m for m in messages) == 1, (
            messages
        )
        assert not vtkCompressedVolume.IsCompressed(output)


def test_writer_refuses_plain_images(tmp_path):
    writer = vtkZFPWriter()
    writer.SetInputData(make_image(noise((4, 4, 4))))
    writer.SetFileName(str(tmp_path / "none.zfp"))
    with vtk_messages() as messages:
        assert writer.Write() == 0
    assert len(messages) == 1
    assert not (tmp_path / "none.zfp").exists()
