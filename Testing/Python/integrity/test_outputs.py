"""Outputs replace no input, no device and no link, and signals leave nothing behind."""

import os
import signal
import stat
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image, samples_of
from progiso.cli import main
from progiso.io.files import atomic_path, check_output

SIZE = ("--size", "32x24")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder, the current one, with two volumes."""
    monkeypatch.chdir(tmp_path)
    image = make_image(blobs((12, 12, 12)))
    progiso.save(image, "in.vti")
    progiso.save(progiso.compress(image), "packed.vti")
    return tmp_path


def render(name, *arguments):
    return main(["render", name, "--isovalue", "0.1", *SIZE, *arguments])


# --- inputs ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("output", ["in.vti", "./in.vti", "soft.vti", "hard.vti", "deep/soft.vti"])
def test_an_input_is_not_replaced(folder, output, capsys):
    os.symlink("in.vti", "soft.vti")
    os.link("in.vti", "hard.vti")
    os.mkdir("deep")
    os.symlink("../soft.vti", "deep/soft.vti")
    before = (folder / "in.vti").read_bytes()
    for arguments in (
        ["compress", "in.vti", output, "--rate", "1"],
        ["decompress", "in.vti", output],
        ["render", "in.vti", "--isovalue", "0.1", "--depth", output],
        ["render", "in.vti", "--isovalue", "0.1", "--stats", output],
    ):
        assert main(arguments) == 1
        assert "is, or belongs to, the input 'in.vti'" in capsys.readouterr().err
        assert (folder / "in.vti").read_bytes() == before
    assert main(["compress", output, "in.vti", "--rate", "1"]) == 1


def test_other_commands_replace_no_input(folder, capsys):
    os.symlink("in.vti", "surface.ply")
    os.symlink("in.vti", "picture.png")
    assert main(["contour", "in.vti", "surface.ply", "--isovalue", "0.1"]) == 1
    assert render("in.vti", "--output", "picture.png") == 1
    assert capsys.readouterr().err.count("the input 'in.vti'") == 2
    assert os.path.islink("surface.ply") and os.path.islink("picture.png")


def test_outputs_are_different_files(folder, capsys):
    os.symlink("new.npy", "other.npy")
    for pair in (("a", "a"), ("a", "./a"), ("new.npy", "other.npy")):
        assert render("in.vti", "--depth", pair[0], "--stats", pair[1]) == 1
        assert "is the same file" in capsys.readouterr().err
        assert not os.path.exists(pair[0])


def test_data_of_headers_are_inputs(folder, capsys):
    """The samples of a header lie in another file, which no output replaces."""
    text = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
    os.mkdir("slices")
    for name in ("x_2x2x2_uint8.raw", "schädel.raw", "slices/s7.raw"):
        (folder / name).write_bytes(bytes(8))
    for header, output in (
        (f"{text}ElementDataFile = x_2x2x2_uint8.raw\n", "x_2x2x2_uint8.raw"),
        (f"{text}ElementDataFile = schädel.raw\n", "schädel.raw"),
        (f"{text}ElementDataFile = LIST\nslices/s7.raw\n", "slices/s7.raw"),
        (f"{text}ElementDataFile = slices/s%d.raw 1 9 1\n", "slices/s7.raw"),
    ):
        (folder / "x.mhd").write_text(header, encoding="utf-8")
        assert render("x.mhd", "--depth", output) == 1
        assert "belongs to, the input 'x.mhd'" in capsys.readouterr().err
    (folder / "b.hdr").write_bytes(b"")
    (folder / "b.img").write_bytes(b"")
    assert render("b.hdr", "--stats", "b.img") == 1
    assert "belongs to, the input 'b.hdr'" in capsys.readouterr().err


def test_parts_of_folders_are_inputs(folder):
    """Slices, chunks of Zarr and data sets of HDF5 are no outputs; other files beside them are."""
    for name in ("slices/1.png", "slices/2.png", "slices/stats.json", "a.zarr/c/0", "a.h5"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"")
    for read, output in (("slices", "slices/2.png"), ("a.zarr", "a.zarr/c/0"), ("a.h5:/x", "a.h5")):
        with pytest.raises(ValueError, match="belongs to, the input"):
            check_output(output, inputs=[read])
    check_output("slices/stats.json", inputs=["slices"])
    check_output("slices/3.png", inputs=["slices"])


def test_outputs_may_be_replaced(folder):
    """Results of an earlier run, and inputs of the same name elsewhere, are no inputs."""
    os.mkdir("there")
    for _ in range(2):
        assert main(["compress", "in.vti", "there/in.vti"]) == 0
    assert progiso.is_compressed(progiso.read("there/in.vti"))


# --- links, devices, pipes ------------------------------------------------------------------------


def test_links_stay(folder):
    os.mkdir("disk")
    os.symlink("disk/out.vti", "out.vti")
    os.symlink("out.vti", "again.vti")
    for name in ("out.vti", "again.vti"):  # the file is made, and then replaced
        assert main(["compress", "in.vti", name]) == 0
        assert os.path.islink("out.vti") and os.path.islink("again.vti")
        assert not os.path.islink("disk/out.vti")
        assert progiso.is_compressed(progiso.read("disk/out.vti"))
        assert os.listdir("disk") == ["out.vti"]


def test_the_temporary_file_lies_beside_the_links_target(folder):
    os.mkdir("disk")
    os.symlink("disk/out.txt", "out.txt")
    with atomic_path("out.txt") as temporary:
        assert temporary.parent.parent.resolve() == (folder / "disk").resolve()
        assert temporary.name == "out.txt"
        temporary.write_text("text")
    assert (folder / "disk" / "out.txt").read_text() == "text"


def test_links_that_lead_nowhere(folder, capsys):
    os.symlink("loop.vti", "loop.vti")
    os.symlink("nowhere/out.vti", "lost.vti")
    for name, words in (("loop.vti", "links lead nowhere"), ("lost.vti", "'nowhere' does not")):
        assert main(["compress", "in.vti", name]) == 1
        assert words in capsys.readouterr().err


def test_permissions_stay(folder):
    (folder / "out.vti").write_bytes(b"")
    os.chmod("out.vti", 0o600)
    assert main(["compress", "in.vti", "out.vti"]) == 0
    assert stat.S_IMODE(os.stat("out.vti").st_mode) == 0o600


def test_devices_and_pipes_are_written_to(folder):
    """A named pipe gets the bytes, /dev/null swallows them, and both stay what they are."""
    os.mkfifo("pipe")
    os.symlink("/dev/null", "null.png")
    found = []
    reader = threading.Thread(target=lambda: found.append((folder / "pipe").read_bytes()))
    reader.start()
    before = os.stat("/dev/null")
    assert render("in.vti", "--depth", "pipe", "--output", "null.png", "--stats", "/dev/null") == 0
    reader.join(10)
    (folder / "depth.npy").write_bytes(found[0])
    assert np.load("depth.npy").shape == (24, 32)
    assert stat.S_ISFIFO(os.stat("pipe").st_mode) and os.path.islink("null.png")
    after = os.stat("/dev/null")
    assert (after.st_rdev, after.st_ino) == (before.st_rdev, before.st_ino)


@pytest.mark.parametrize("to", ["file", "pipe"])
def test_standard_output(folder, to):
    """It is written to in its turn, also where it leads to a file; statistics come first."""
    os.symlink("/proc/self/fd/1", "stdout")
    program = "import sys; from progiso.cli import main; sys.exit(main(sys.argv[1:]))"
    for name in ("stdout", "/dev/stdout"):
        command = [sys.executable, "-c", program, "render", "in.vti", "--isovalue", "0.1", *SIZE]
        command += ["--stats", name]
        if to == "pipe":
            text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        else:
            with open("out.txt", "w", encoding="utf-8") as file:
                subprocess.run(command, check=True, stdout=file)
            text = (folder / "out.txt").read_text()
        assert text.startswith("{") and "pixels hit" in text.split("}\n")[-1]
        assert os.path.islink("stdout")


# --- signals and left-overs -----------------------------------------------------------------------

WAITING = """
import sys, time
from progiso.io.files import atomic_path
with atomic_path("out.txt") as temporary:
    temporary.write_text("half")
    print("ready", flush=True)
    time.sleep(60)
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_signals_leave_nothing(tmp_path, number):
    (tmp_path / "out.txt").write_text("old")
    process = subprocess.Popen(
        [sys.executable, "-c", WAITING], cwd=tmp_path, stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(number, signal.default_int_handler
                                         if number == signal.SIGINT else signal.SIG_DFL),
    )  # fmt: skip
    assert process.stdout.readline() == b"ready\n" and len(list(tmp_path.iterdir())) == 2
    process.send_signal(number)
    assert process.wait(20) in (-number, 1)
    process.stdout.close()
    assert [p.name for p in tmp_path.iterdir()] == ["out.txt"]
    assert (tmp_path / "out.txt").read_text() == "old"


def test_a_programs_own_handler_stays(tmp_path):
    def own(*_):
        """Handle a signal as a program might."""

    before = signal.signal(signal.SIGTERM, own)
    try:
        with atomic_path(tmp_path / "a") as temporary:
            assert signal.getsignal(signal.SIGTERM) is own
            temporary.write_text("")
        assert signal.getsignal(signal.SIGTERM) is own
    finally:
        signal.signal(signal.SIGTERM, before)
    assert signal.getsignal(signal.SIGTERM) is before


def left_over(tmp_path, name, age, lock=True):
    folder = tmp_path / f".progiso-{name}"
    folder.mkdir()
    (folder / "half.vti").write_bytes(b"half")
    if lock:
        (folder / ".lock").write_bytes(b"")
    os.utime(folder, (time.time() - age,) * 2)
    return folder


def test_left_overs_are_removed(tmp_path):
    """Those of killed processes, but no young ones, none that is locked, and no other's file."""
    killed = left_over(tmp_path, "killed", 3600)
    young = left_over(tmp_path, "young", 5)
    old_version = left_over(tmp_path, "old", 1e6, lock=False)
    perhaps = left_over(tmp_path, "perhaps", 3600, lock=False)
    file = tmp_path / ".progiso-file"
    file.write_text("")
    os.utime(file, (0, 0))
    elsewhere = left_over(tmp_path / "..", tmp_path.name, 3600)
    (tmp_path / ".progiso-link").symlink_to(elsewhere)
    with atomic_path(tmp_path / "a") as working:
        os.utime(working.parent, (0, 0))
        with atomic_path(tmp_path / "b") as temporary:
            temporary.write_text("")
        assert working.parent.is_dir()
        working.write_text("")
    assert not killed.exists() and not old_version.exists()
    assert young.exists() and perhaps.exists() and file.exists() and elsewhere.exists()


# --- names of raw files ---------------------------------------------------------------------------

KINDS = ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8")


@pytest.mark.parametrize("kind", KINDS)
def test_the_name_advised_is_valid(tmp_path, kind):
    """Saving under the name that the message asks for works, and reading it back, too."""
    image = make_image(np.arange(24).reshape(2, 3, 4).astype(kind))
    with pytest.raises(ValueError, match="call it name_4x3x2_") as error:
        progiso.save(image, tmp_path / "x_9x9x9_uint8.raw")
    name = str(error.value).split("call it ")[1]
    progiso.save(image, tmp_path / name)
    read = samples_of(progiso.read(tmp_path / name))
    assert read.dtype == np.dtype(kind) and np.array_equal(read, samples_of(image))


def test_advice_for_what_no_raw_file_holds(tmp_path):
    image = make_image(np.zeros((4, 4, 4), np.float32))
    image.GetPointData().GetScalars().SetNumberOfComponents(2)
    image.SetDimensions(4, 4, 2)
    with pytest.raises(ValueError, match="2 components: write it as .vti"):
        progiso.save(image, tmp_path / "x_4x4x2_float32.raw")
    progiso.save(image, tmp_path / "x.vti")
