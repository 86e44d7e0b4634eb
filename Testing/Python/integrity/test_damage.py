"""Files that are truncated, or in which bits have flipped, are refused; `info --verify` tells."""

import json

import numpy as np
import pytest

import progiso
from helpers.images import (
    blobs,
    copy_of,
    make_image,
    metadata,
    same_bits,
    samples_of,
    stream_of,
    without_checksums,
)
from progiso.cli import main


def volume():
    image = make_image(
        blobs((20, 22, 24)), spacing=(0.5, 2, 3), origin=(1, 2, 3), direction=np.diag([1, -1, 1])
    )
    return progiso.compress(image, rate=6)


def plain():
    return make_image(blobs((20, 22, 24)), spacing=(0.5, 2, 3), origin=(1, 2, 3))


def old_version():
    return without_checksums(copy_of(volume()))


KINDS = {"compressed": volume, "plain": plain, "old version": old_version}


@pytest.mark.parametrize("appended", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_truncated_files(tmp_path, kind, appended):
    path = tmp_path / "a.vti"
    progiso.save(KINDS[kind](), path, appended=appended)
    whole = path.read_bytes()
    end = whole.rindex(b"</VTKFile>") + 9
    for length in (
        0,
        1,
        100,
        len(whole) // 4,
        len(whole) // 2,
        len(whole) * 9 // 10,
        end - 10,
        end,
    ):
        path.write_bytes(whole[:length])
        with pytest.raises((ValueError, RuntimeError), match=r"a\.vti"):
            progiso.read(path)


@pytest.mark.parametrize("appended", [False, True])
def test_files_of_vtk_and_of_older_versions(tmp_path, appended):
    """Without the last line they are read; truncated ones are not, where data are appended, too."""
    path = tmp_path / "a.vti"
    progiso.save(old_version(), path, appended=appended)
    whole = path.read_bytes()
    without = whole[: whole.rindex(b"<!-- ProgIso")]
    for ending in (b"", b"\n", b"<!-- edited -->\n"):
        path.write_bytes(without + ending)
        assert stream_of(progiso.read(path)) == stream_of(volume())
    for length in (len(without) // 2, without.rindex(b"</VTKFile>")):
        path.write_bytes(without[:length])
        with pytest.raises((ValueError, RuntimeError), match=r"a\.vti"):
            progiso.read(path)


@pytest.mark.parametrize("appended", [False, True])
@pytest.mark.parametrize("kind", ["compressed", "plain"])
def test_flipped_bits(tmp_path, kind, appended):
    """Wherever a bit flips, the file is refused, or what is read is the same."""
    path = tmp_path / "a.vti"
    image = KINDS[kind]()
    progiso.save(image, path, appended=appended)
    whole = path.read_bytes()
    expected = samples_of(progiso.decompress(image) if kind == "compressed" else image)
    rng = np.random.default_rng(7)
    refused = 0
    for place in [*rng.integers(0, len(whole), 60), *rng.integers(0, 2500, 60)]:
        data = bytearray(whole)
        data[place] ^= 1 << rng.integers(8)
        path.write_bytes(data)
        try:
            read = progiso.read(path)
        except (ValueError, RuntimeError) as error:
            assert "a.vti" in str(error)
            refused += 1
            continue
        assert read.GetSpacing() == image.GetSpacing() and read.GetOrigin() == image.GetOrigin()
        if kind == "compressed":
            read = progiso.decompress(read)
        assert same_bits(samples_of(read), expected)
    assert refused > 110


def test_what_was_left_out_is_noticed(tmp_path):
    """Bytes that are gone from the middle, or came in, are told by the length."""
    path = tmp_path / "a.vti"
    progiso.save(volume(), path, appended=True)
    whole = path.read_bytes()
    for changed in (whole[:4000] + whole[4001:], whole[:4000] + b"x" + whole[4000:]):
        path.write_bytes(changed)
        with pytest.raises(
            ValueError, match="bytes before it, and there are .*remove its last line"
        ):
            progiso.read(path)


def test_geometry_is_covered(tmp_path):
    path = tmp_path / "a.vti"
    progiso.save(volume(), path)
    text = path.read_text()
    assert 'Spacing="0.5 2 3"' in text
    path.write_text(text.replace('Spacing="0.5 2 3"', 'Spacing="0.5 2 2"'))
    with pytest.raises(ValueError, match="from byte 0 to .*; .* remove its last line"):
        progiso.read(path)
    path.write_text(path.read_text()[: text.rindex("<!--")])  # on purpose, but of the image alone
    with pytest.raises(ValueError, match="moved or resampled.*Place"):
        progiso.read(path)


def test_pyvista_takes_the_last_line(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    for appended in (False, True):
        progiso.save(volume(), tmp_path / "a.vti", appended=appended)
        assert stream_of(pyvista.read(tmp_path / "a.vti")) == stream_of(volume())


# --- info --verify --------------------------------------------------------------------------------


def verified(capsys, path):
    """Return the exit status, what is printed, and the error."""
    status = main(["info", "--verify", "--json", str(path)])
    captured = capsys.readouterr()
    return status, captured.out, captured.err


@pytest.mark.parametrize("appended", [False, True])
def test_verify_tells_what_is_right(tmp_path, capsys, appended):
    path = tmp_path / "a.vti"
    progiso.save(volume(), path, appended=appended)
    status, text, _ = verified(capsys, path)
    facts = json.loads(text)["verified"]
    assert status == 0
    assert facts["file"].endswith("bytes match their checksums")
    assert facts["stream"] == "1 pages match their checksums"
    assert facts["blocks"].startswith("180 decode to values from -")
    values = samples_of(progiso.decompress(volume()))
    assert facts["blocks"].endswith(f"from {values.min():.9g} to {values.max():.9g}")


def test_verify_tells_what_has_no_checksums(tmp_path, capsys):
    progiso.save(volume(), tmp_path / "a.zfp")
    progiso.save(plain(), tmp_path / "a.mha")
    status, text, _ = verified(capsys, tmp_path / "a.zfp")
    assert status == 0 and json.loads(text)["verified"]["stream"] == "has no checksums"
    assert "180 decode" in json.loads(text)["verified"]["blocks"]
    status, text, _ = verified(capsys, tmp_path / "a.mha")
    assert status == 0 and "have no checksums" in json.loads(text)["verified"]["samples"]


@pytest.mark.parametrize("appended", [False, True])
def test_verify_refuses_any_flipped_bit(tmp_path, capsys, appended):
    """Also of raw bytes that nothing else covers, as another array's are."""
    path = tmp_path / "a.vti"
    image = volume()
    extra = make_image(np.arange(64).reshape(4, 4, 4).astype("f4")).GetPointData().GetScalars()
    extra.SetName("extra")
    image.GetFieldData().AddArray(extra)
    progiso.save(image, path, appended=appended)
    whole = path.read_bytes()
    rng = np.random.default_rng(8)
    for place in rng.integers(0, whole.rindex(b"<!--"), 40):
        data = bytearray(whole)
        data[place] ^= 1 << rng.integers(8)
        path.write_bytes(data)
        status, text, error = verified(capsys, path)
        assert status == 1 and not text and len(error.splitlines()) == 1 and "a.vti" in error


def test_verify_finds_damage_without_checksums(tmp_path, capsys):
    """A block that begins with 9 bits of 1 has the largest exponent, beyond that of float32."""
    image = without_checksums(progiso.compress(make_image(blobs((20, 22, 24))), rate=16))
    blocks = metadata(image, "Stream").reshape(-1, 128)
    blocks[7] = np.random.default_rng(3).integers(0, 256, 128)
    blocks[7, :2] = 0xFF, 0x01 | blocks[7, 1]
    progiso.save(image, tmp_path / "a.vti")
    status, _, error = verified(capsys, tmp_path / "a.vti")
    assert status == 1 and "not finite" in error


def test_a_last_line_that_cannot_be_read(tmp_path):
    """What begins as a line of checksums, and is none, is no file without checksums."""
    path = tmp_path / "a.vti"
    progiso.save(make_image(blobs((5, 6, 7))), path)
    path.write_bytes(path.read_bytes().replace(b"MiB of the ", b"MiB of the -"))
    with pytest.raises(ValueError, match="its last line, which has its checksums, cannot be read"):
        progiso.read(path)
