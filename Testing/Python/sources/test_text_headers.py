"""MetaImage and NRRD: every way to write their headers, samples in every encoding, by region."""

import bz2
import gzip
import pickle
import zlib
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import progiso
from progiso.cli import main
from progiso.geometry import samples_of
from progiso.io.formats import open_source
from progiso.io.source import Selection

SHAPE = (4, 5, 6)
X = np.arange(120).reshape(SHAPE).astype("<i2")
AXES = "0 1 0 -1 0 0 0 0 1"  # the axis along x points to y, that along y to -x


def meta(path, data=b"", without=(), **fields):
    """Write a MetaImage of X's shape; ElementDataFile comes last."""
    header = {
        "ObjectType": "Image",
        "NDims": 3,
        "BinaryData": True,
        "CompressedData": False,
        "DimSize": "6 5 4",
        "ElementType": "MET_SHORT",
    } | fields
    header["ElementDataFile"] = header.pop("ElementDataFile", "LOCAL")
    lines = [f"{key} = {value}\n" for key, value in header.items() if key not in without]
    path.write_bytes("".join(lines).encode() + data)
    return path


def nrrd(path, data=b"", without=(), **fields):
    """Write a NRRD of X's shape; underscores in the names of fields are blanks."""
    header = {
        "type": "int16",
        "dimension": 3,
        "sizes": "6 5 4",
        "endian": "little",
        "encoding": "raw",
    } | {key.replace("_", " "): value for key, value in fields.items()}
    lines = [f"{key}: {value}\n" for key, value in header.items() if key not in without]
    path.write_bytes(("NRRD0005\n" + "".join(lines) + "\n").encode() + data)
    return path


def text_of(values, separator=b" "):
    return separator.join(b"%d" % v for v in values.ravel()) + b"\n"


def check(path, expected=X, *, selection=None, component=None):
    """Compare the whole, regions in any order, threads, a pickled copy and compression."""
    source = open_source(path, selection)
    assert source.dtype == expected.dtype.newbyteorder("=") and source.dtype.isnative
    assert np.array_equal(source.read(), expected)
    regions = [
        (slice(2, 4), slice(1, 3), slice(2, 6)),
        (slice(0, 1), slice(0, 5), slice(0, 6)),
        (slice(3, 4), slice(4, 5), slice(5, 6)),
        (slice(1, 3), slice(0, 2), slice(0, 1)),
    ]
    for region in regions:
        assert np.array_equal(source.read(region), expected[region])
    with ThreadPoolExecutor(4) as pool:
        for region, found in zip(regions * 5, pool.map(source.read, regions * 5)):
            assert np.array_equal(found, expected[region])
    assert np.array_equal(pickle.loads(pickle.dumps(source)).read(regions[0]), expected[regions[0]])
    assert np.array_equal(np.concatenate(list(source.slabs())), expected)
    return source


# --- where samples are ----------------------------------------------------------------------------

PARTS = [X[:2].tobytes(), X[2:].tobytes()]

META_FILES = {
    "plain": (X.tobytes(), {}, {}),
    "no BinaryData": (X.tobytes(), {"without": ["BinaryData"]}, {}),
    "text": (text_of(X), {"BinaryData": False}, {}),
    "text with commas": (text_of(X, b", "), {"BinaryData": False}, {}),
    "zlib": (zlib.compress(X.tobytes()), {"CompressedData": True}, {}),
    "gzip": (gzip.compress(X.tobytes()), {"CompressedData": True}, {}),
    "wrong size": (
        zlib.compress(X.tobytes()),
        {"CompressedData": True, "CompressedDataSize": 20},
        {},
    ),
    "detached": (b"", {"ElementDataFile": "x y.raw"}, {"x y.raw": X.tobytes()}),
    "50 %": (b"", {"ElementDataFile": "50%.raw"}, {"50%.raw": X.tobytes()}),
    "UTF-8": (b"", {"ElementDataFile": "schädel.raw"}, {"schädel.raw": X.tobytes()}),
    "header": (
        b"",
        {"ElementDataFile": "x.raw", "HeaderSize": 7},
        {"x.raw": b"1234567" + X.tobytes() + b"more"},
    ),
    "from the end": (
        b"",
        {"ElementDataFile": "x.raw", "HeaderSize": -1},
        {"x.raw": b"123" + X.tobytes()},
    ),
    "list": (
        b"s0\ns1\ns2\ns3\n",
        {"ElementDataFile": "LIST"},
        {f"s{i}": X[i].tobytes() for i in range(4)},
    ),
    "list of slabs": (
        b"s0\r\ns1\r\n",
        {"ElementDataFile": "LIST 3D"},
        dict(zip(("s0", "s1"), PARTS)),
    ),
    "list of zlib": (
        b"s0\ns1\n",
        {"ElementDataFile": "LIST", "CompressedData": True},
        {"s0": zlib.compress(PARTS[0]), "s1": zlib.compress(PARTS[1])},
    ),
    "pattern": (
        b"",
        {"ElementDataFile": "s%03d.raw 7 13 2"},
        {f"s{7 + 2 * i:03}.raw": X[i].tobytes() for i in range(4)},
    ),
    "pattern without step": (
        b"",
        {"ElementDataFile": "s%d.raw 0 3"},
        {f"s{i}.raw": X[i].tobytes() for i in range(4)},
    ),
}


@pytest.mark.parametrize("case", META_FILES)
def test_metaimage_data(case, tmp_path):
    data, fields, others = META_FILES[case]
    for name, content in others.items():
        (tmp_path / name).write_bytes(content)
    path = meta(tmp_path / "schädel.mhd", data, **fields)
    check(path)
    volume = progiso.decompress(progiso.compress_file(path, rate=24))
    assert np.allclose(samples_of(volume), X, atol=0.01)


ENCODED = {
    "raw": X.tobytes(),
    "text": text_of(X),
    "ascii": text_of(X, b", "),
    "txt": text_of(X, b"\n"),
    "hex": X.tobytes().hex().encode(),
    "gzip": gzip.compress(X.tobytes()),
    "gz": gzip.compress(PARTS[0]) + gzip.compress(PARTS[1]),
    "bzip2": bz2.compress(X.tobytes()),
    "bz2": bz2.compress(PARTS[0]) + bz2.compress(PARTS[1]),
    "RAW": X.tobytes(),
}


@pytest.mark.parametrize("encoding", ENCODED)
def test_nrrd_encodings(encoding, tmp_path):
    check(nrrd(tmp_path / "x.nrrd", ENCODED[encoding], encoding=encoding))


NRRD_FILES = {
    "data file": ({"data_file": "schädel.raw"}, {"schädel.raw": X.tobytes()}),
    "datafile": ({"datafile": "x.raw"}, {"x.raw": X.tobytes()}),
    "byte skip": ({"byte_skip": 16, "data_file": "x.raw"}, {"x.raw": b"0" * 16 + X.tobytes()}),
    "byteskip": ({"byteskip": 16, "data_file": "x.raw"}, {"x.raw": b"0" * 16 + X.tobytes()}),
    "byteskip -1": ({"byteskip": -1, "data_file": "x.raw"}, {"x.raw": b"0" * 9 + X.tobytes()}),
    "byteskip -1, gzip": (
        {"byteskip": -1, "data_file": "x", "encoding": "gzip"},
        {"x": gzip.compress(b"0" * 9 + X.tobytes())},
    ),
    "lineskip": ({"lineskip": 2, "data_file": "x.raw"}, {"x.raw": b"a\nb\n" + X.tobytes()}),
    "line skip": (
        {"line_skip": 1, "byte_skip": 3, "datafile": "x", "encoding": "gz"},
        {"x": b"a\n" + gzip.compress(b"abc" + X.tobytes())},
    ),
    "byteskip, text": (
        {"byteskip": 5, "data_file": "x", "encoding": "text"},
        {"x": b"a b c" + text_of(X)},
    ),
    "list": ({"data_file": "LIST\ns0\ns1\ns2\ns3"}, {f"s{i}": X[i].tobytes() for i in range(4)}),
    "list of slabs": (
        {"byte_skip": 1, "encoding": "gzip", "data_file": "LIST 3\na\nb"},
        {name: gzip.compress(b"0" + part) for name, part in zip("ab", PARTS)},
    ),
    "pattern": (
        {"data_file": "s%02d.raw 3 0 -1"},
        {f"s{3 - i:02}.raw": X[i].tobytes() for i in range(4)},
    ),
}


@pytest.mark.parametrize("case", NRRD_FILES)
def test_nrrd_data(case, tmp_path):
    fields, others = NRRD_FILES[case]
    for name, content in others.items():
        (tmp_path / name).write_bytes(content)
    check(nrrd(tmp_path / "x.nhdr", **fields))


def test_old_encoding_of_names(tmp_path):
    """Headers in Latin-1 name files, too."""
    (tmp_path / "schädel.raw").write_bytes(X.tobytes())
    for write, field in ((meta, "ElementDataFile"), (nrrd, "data_file")):
        path = write(tmp_path / "x", **{field: "schädel.raw"})
        target = tmp_path / ("x.mhd" if write is meta else "x.nhdr")
        target.write_bytes(path.read_text("utf-8").encode("latin-1"))
        check(target)


# --- types, components, time ----------------------------------------------------------------------

ELEMENTS = {
    "MET_CHAR": "i1",
    "MET_UCHAR": "u1",
    "MET_USHORT": "u2",
    "MET_INT": "i4",
    "MET_LONG": "i4",
    "MET_ULONG": "u4",
    "MET_LONG_LONG": "i8",
    "MET_ULONG_LONG": "u8",
    "MET_FLOAT": "f4",
    "MET_DOUBLE": "f8",
}


@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize("element", ELEMENTS)
def test_metaimage_types(element, big, tmp_path):
    values = X.astype((">" if big else "<") + ELEMENTS[element])
    for key in ("BinaryDataByteOrderMSB", "ElementByteOrderMSB"):
        path = meta(tmp_path / "x.mha", values.tobytes(), ElementType=element, **{key: big})
        check(path, values)


NRRD_TYPES = {
    "i1": ["signed char", "int8", "int8_t"],
    "u1": ["uchar", "unsigned char", "uint8", "uint8_t"],
    "i2": ["short", "short int", "signed short", "signed short int", "int16", "int16_t"],
    "u2": ["ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"],
    "i4": ["int", "signed int", "int32", "int32_t"],
    "u4": ["uint", "unsigned int", "uint32", "uint32_t"],
    "i8": [
        "longlong",
        "long long",
        "long long int",
        "signed long long",
        "signed long long int",
        "int64",
        "int64_t",
    ],
    "u8": ["ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"],
    "f4": ["float"],
    "f8": ["double", "Double"],
}


@pytest.mark.parametrize("kind", NRRD_TYPES)
def test_nrrd_types(kind, tmp_path):
    for name in NRRD_TYPES[kind]:
        for endian in ("big", "Little"):
            values = X.astype((">" if endian == "big" else "<") + kind)
            path = nrrd(tmp_path / "x.nrrd", values.tobytes(), type=name, endian=endian)
            assert np.array_equal(open_source(path).read(), values)


def test_64_bits_come_back(tmp_path):
    """What ProgIso writes, it reads: integers of 64 bits, too."""
    for kind in (np.int64, np.uint64):
        progiso.save(X.T.astype(kind), tmp_path / "i.mha")
        check(tmp_path / "i.mha", X.astype(kind))


def test_components_and_times(tmp_path):
    colours = np.stack([X, X + 1000, X + 2000], axis=-1)
    for path in (
        meta(tmp_path / "c.mha", colours.tobytes(), ElementNumberOfChannels=3),
        nrrd(tmp_path / "c.nrrd", colours.tobytes(), dimension=4, sizes="3 6 5 4"),
        nrrd(
            tmp_path / "d.nrrd",
            colours.tobytes(),
            dimension=4,
            sizes="3 6 5 4",
            kinds="list domain domain domain",
        ),
        nrrd(
            tmp_path / "e.nrrd",
            np.moveaxis(colours, -1, 0).tobytes(),
            dimension=4,
            sizes="6 5 4 3",
            kinds="domain domain domain RGB-color",
        ),
    ):
        check(path, colours)
        check(path, colours[..., 2], selection=Selection(component=2))
        with pytest.raises(ValueError, match=f"{path.name}.*component 3"):
            open_source(path, Selection(component=3))
    times = np.stack([X, X + 1000, X + 2000])
    for path in (
        meta(tmp_path / "t.mha", times.tobytes(), NDims=4, DimSize="6 5 4 3"),
        nrrd(
            tmp_path / "t.nrrd",
            times.tobytes(),
            dimension=4,
            sizes="6 5 4 3",
            space="LPST",
            space_directions="(1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,9)",
            space_origin="(4,5,6,0)",
        ),
        nrrd(
            tmp_path / "u.nrrd",
            gzip.compress(times.tobytes()),
            dimension=4,
            sizes="6 5 4 3",
            encoding="gzip",
            kinds="space space space time",
        ),
    ):
        source = check(path, X)
        assert source.about.times == 3 and "0 of 3: choose by --time" in source.about.notes[-1]
        chosen = check(path, X + 2000, selection=Selection(time=2))
        assert not chosen.about.notes
        with pytest.raises(ValueError, match=f"{path.name}.*time point 3"):
            open_source(path, Selection(time=3))
    both = np.stack([colours, colours + 5000])
    path = nrrd(tmp_path / "b.nrrd", both.tobytes(), dimension=5, sizes="3 6 5 4 2")
    check(path, colours[..., 1] + 5000, selection=Selection(time=1, component=1))


def test_two_dimensions_are_one_slice(tmp_path):
    for path in (
        meta(tmp_path / "x.mha", X[0].tobytes(), NDims=2, DimSize="6 5", ElementSpacing="2 3"),
        nrrd(tmp_path / "x.nrrd", X[0].tobytes(), dimension=2, sizes="6 5", spacings="2 3"),
    ):
        source = open_source(path)
        assert np.array_equal(source.read(), X[:1])
        assert np.array_equal(np.diag(source.about.geometry.axes), [2, 3, 1])


# --- where they lie -------------------------------------------------------------------------------


def axes_and_origin(path):
    geometry = open_source(path).about.geometry
    return geometry.axes.tolist(), geometry.origin.tolist()


@pytest.mark.parametrize("tag", ["TransformMatrix", "Orientation", "Rotation"])
def test_orientation_has_three_names(tag, tmp_path):
    path = meta(tmp_path / "o.mha", X.tobytes(), ElementSpacing="2 3 4", **{tag: AXES})
    assert axes_and_origin(path)[0] == [[0, -3, 0], [2, 0, 0], [0, 0, 4]]
    matrix = progiso.read(path).GetDirectionMatrix()
    assert [matrix.GetElement(i, j) for i in range(3) for j in range(3)] == [
        0, -1, 0, 1, 0, 0, 0, 0, 1,
    ]  # fmt: skip


@pytest.mark.parametrize("tag", ["Origin", "Offset", "Position", "ImagePosition"])
def test_origin_has_four_names(tag, tmp_path):
    path = meta(tmp_path / "o.mha", X.tobytes(), ElementSize="2 3 4", **{tag: "7 8 9"})
    assert axes_and_origin(path) == ([[2, 0, 0], [0, 3, 0], [0, 0, 4]], [7, 8, 9])


def test_places_are_those_of_itk(tmp_path):
    """Also where a header has several names for one thing, corner by corner."""
    itk = pytest.importorskip("SimpleITK")
    names = [("Origin", "Offset", "Position"), ("TransformMatrix", "Rotation", "Orientation")]
    values = [("1 1 1", "2 2 2"), (AXES, "1 0 0 0 1 0 0 0 1")]
    paths = [
        meta(tmp_path / f"{a}{b}.mha", X.tobytes(), **{a: first, b: second})
        for tags, (first, second) in zip(names, values)
        for a in tags
        for b in tags
        if a != b
    ]
    paths.append(meta(tmp_path / "minus.mha", X.tobytes(), ElementSpacing="-1 2 3"))
    for name, fields in {
        "spacings": {"spacings": "1 2 3"},
        "mins": {"spacings": "1 2 3", "axis_mins": "10 20 30"},
        "axismins": {"spacings": "1 2 3", "axismins": "10 20 30", "centerings": "cell cell node"},
        "node": {"spacings": "1 2 3", "axis_mins": "10 20 30", "centers": "node node node"},
        "ras": {
            "space": "RAS",
            "space_directions": "(1,0,0) (0, 0,2) (0,-3,0)",
            "space_origin": "(1,2,3)",
        },
        "las": {
            "space": "left-anterior-superior",
            "space_directions": "( 1, 0, 0 ) (0,0,2) (0,-3,0)",
        },
    }.items():
        paths.append(nrrd(tmp_path / f"{name}.nrrd", X.tobytes(), **fields))
    for path in paths:
        image, geometry = itk.ReadImage(str(path)), open_source(path).about.geometry
        if geometry.space is not None:
            geometry = geometry.in_space("LPS")
        for corner in np.ndindex(2, 2, 2):
            index = np.array(corner) * (5, 4, 3)
            place = image.TransformIndexToPhysicalPoint(index.tolist())
            assert np.allclose(geometry.origin + geometry.axes @ index, place), path.name


def test_shears_stay(tmp_path):
    path = nrrd(
        tmp_path / "x.nrrd",
        X.tobytes(),
        space="RAS",
        space_directions="(1,0,0) (0,2,0) (0,0.5,3)",
        space_origin="(1,2,3)",
        space_units='"um" "um" "um"',
    )
    assert axes_and_origin(path) == ([[1, 0, 0], [0, 2, 0.5], [0, 0, 3]], [1, 2, 3])
    assert open_source(path).about.geometry.space == "RAS"
    assert open_source(path).about.geometry.units == "um"


# --- what is wrong --------------------------------------------------------------------------------

BAD_META = {
    "DimSize": ({"DimSize": "6 5 four"}, "DimSize.*6 5 four"),
    "two sizes": ({"DimSize": "6 5"}, "DimSize"),
    "no size": ({"without": ["DimSize"]}, "lacks the field 'DimSize'"),
    "negative": ({"DimSize": "6 -5 4"}, "no samples"),
    "underscore": ({"DimSize": "6 5 1_0"}, "DimSize"),
    "matrix": ({"TransformMatrix": "1 0 0 a 1 0 0 0 1"}, "TransformMatrix.*'1 0 0 a"),
    "singular": ({"TransformMatrix": "1 0 0 1 0 0 0 0 1"}, "span"),
    "spacing": ({"ElementSpacing": "0 1 1"}, "unusable"),
    "infinite": ({"Offset": "inf 0 0"}, "unusable"),
    "type": ({"ElementType": "MET_OTHER"}, "MET_OTHER"),
    "flag": ({"CompressedData": "maybe"}, "CompressedData.*maybe"),
    "kind": ({"ObjectType": "Mesh"}, "Mesh"),
    "step": ({"ElementDataFile": "s%d.raw 0 3 0"}, "step"),
    "no list": ({"ElementDataFile": "LIST"}, "lists no"),
    "huge": ({"DimSize": "99999999 99999999 99999999"}, "truncated"),
    "huge packed": (
        {"DimSize": "99999999 99999999 99999999", "CompressedData": True},
        "truncated",
    ),
    "device": ({"ElementDataFile": "/dev/zero"}, "regular"),
    "channels": ({"ElementNumberOfChannels": 0}, "no samples"),
}


@pytest.mark.parametrize("case", BAD_META)
def test_bad_metaimages(case, tmp_path):
    fields, words = BAD_META[case]
    path = meta(tmp_path / "x.mha", b"" if case == "no list" else X.tobytes(), **fields)
    with pytest.raises(ValueError, match=f"x.mha'.*{words}"):
        open_source(path)


BAD_NRRD = {
    "sizes": ({"sizes": "6 five 4"}, "sizes.*6 five 4"),
    "product": ({"sizes": "6 -5 4"}, "no samples"),
    "dimension": ({"dimension": 6, "sizes": "1 1 1 1 1 1"}, "dimension is 6"),
    "directions": ({"space_directions": "(1,0,0) (0,a,0) (0,0,1)"}, "spacedirections|0 a 0"),
    "two directions": ({"space_directions": "(1,0,0) (0,1,0)"}, "3 vectors"),
    "origin": ({"space_origin": "(1,2)"}, "origin"),
    "type": ({"type": "block"}, "block"),
    "endian": ({"endian": "middle"}, "endian.*middle"),
    "encoding": ({"encoding": "zip"}, "zip"),
    "skip": ({"byteskip": -5}, "byteskip"),
    "text": ({"encoding": "text"}, "truncated|damaged"),
    "missing": ({"without": ["sizes"]}, "lacks"),
    "kinds": ({"kinds": "domain domain"}, "kinds"),
    "middle": (
        {"dimension": 4, "sizes": "6 1 5 4", "space_directions": "(1,0,0) none (0,1,0) (0,0,1)"},
        "axes",
    ),
}


@pytest.mark.parametrize("case", BAD_NRRD)
def test_bad_nrrds(case, tmp_path):
    fields, words = BAD_NRRD[case]
    path = nrrd(tmp_path / "x.nrrd", X.tobytes(), **fields)
    with pytest.raises(ValueError, match=f"x.nrrd'.*({words})"):
        open_source(path).read()


def test_missing_data_are_named(tmp_path, capsys):
    """The file that is missing is named, and nothing else is printed."""
    for path in (
        meta(tmp_path / "x.mhd", ElementDataFile="gone.raw"),
        nrrd(tmp_path / "x.nhdr", data_file="gone.raw"),
    ):
        with pytest.raises(FileNotFoundError, match=f"{path.name}.*gone.raw"):
            open_source(path)
        assert main(["info", str(path)]) == 1
        error = capsys.readouterr().err
        assert "gone.raw" in error and len(error.splitlines()) == 1


@pytest.mark.parametrize("encoding", ["raw", "gzip", "bzip2", "text", "hex"])
def test_truncated_data_are_an_error(encoding, tmp_path):
    values = np.random.default_rng(0).integers(0, 30000, SHAPE).astype("<i2")
    data = {
        "raw": bytes,
        "gzip": gzip.compress,
        "bzip2": bz2.compress,
        "hex": lambda b: b.hex().encode(),
        "text": lambda b: text_of(np.frombuffer(b, "<i2")),
    }[encoding](values.tobytes())
    for keep in (0, 1, len(data) // 2, len(data) - 3):
        if encoding == "text" and keep == len(data) - 3:
            continue  # the last number may have been that
        path = nrrd(tmp_path / "x.nrrd", data[:keep], encoding=encoding)
        with pytest.raises(ValueError, match="x.nrrd'.*(truncated|damaged)"):
            open_source(path).read()


@pytest.mark.parametrize("what", ["checksum", "length", "plain"])
def test_damaged_streams_are_an_error(what, tmp_path):
    """Also where all samples come out, but not those that were written."""
    packed = bytearray(zlib.compress(X.tobytes()))
    if what == "checksum":
        packed[-1] ^= 1
    elif what == "length":
        packed = bytearray(zlib.compress(X.tobytes()[:200]))
    else:
        packed = bytearray(X.tobytes())
    path = meta(tmp_path / "x.mha", bytes(packed), CompressedData=True)
    with pytest.raises(ValueError, match="x.mha'.*(damaged|truncated)"):
        open_source(path).read()
    squeezed = bytearray(gzip.compress(X.tobytes()))
    squeezed[-8] ^= 1
    path = nrrd(tmp_path / "x.nrrd", bytes(squeezed), encoding="gzip")
    with pytest.raises(ValueError, match="x.nrrd'.*damaged"):
        open_source(path).read()


def test_text_must_be_numbers(tmp_path):
    for text in (b"1 2 x " * 40, b"1.5 " * 120, b"99999 " * 120, b"9" * 5000):
        path = nrrd(tmp_path / "x.nrrd", text, encoding="text")
        with pytest.raises(ValueError, match="x.nrrd'.*damaged"):
            open_source(path).read()
    path = nrrd(tmp_path / "x.nrrd", b"1.5 " * 119 + b"nan", encoding="text", type="float")
    assert np.isnan(open_source(path).read()[-1, -1, -1])


def test_misspelt_fields_are_told(tmp_path):
    path = meta(tmp_path / "x.mha", X.tobytes(), ElementSpacng="1 2 3", Hospital="A")
    assert "ElementSpacng" in open_source(path).about.notes[0]
    assert len(open_source(path).about.notes) == 1
    path = nrrd(tmp_path / "x.nrrd", X.tobytes(), spacng="1 2 3")
    assert "spacng" in open_source(path).about.notes[0]
