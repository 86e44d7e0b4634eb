"""What does not fit on the disk is an error that names the file, and leaves nothing behind."""

import json
import subprocess
import sys

import numpy as np
import pytest

import progiso
from helpers.images import blobs, make_image
from progiso.data import compressed, fetch

#: Tries to write every format where no file may have more than a number of bytes.
PROGRAM = """
import json, os, resource, sys
import numpy as np
import progiso
from progiso.io.files import atomic_path

limit = int(sys.argv[1])
z, y, x = np.mgrid[-1:1:24j, -1:1:24j, -1:1:24j]
field = np.sqrt(x**2 + y**2 + z**2) + 0.1 * np.random.default_rng(1).random(x.shape)
image = progiso.image_from_array(field.ravel().astype("f4"), x.shape, name="field")
volume = progiso.compress(image, rate=16)
surface = progiso.contour(image, 0.7)
pixels = np.random.default_rng(2).integers(0, 255, (80, 90, 3)).astype("u1")

def npy(path):
    with atomic_path(path) as temporary, open(temporary, "wb") as file:
        np.save(file, field)

def text(path):
    with atomic_path(path) as temporary:
        temporary.write_text("1234567890" * 10000, encoding="utf-8")

writers = {
    "plain.vti": lambda path: progiso.save(image, path),
    "plain_appended.vti": lambda path: progiso.save(image, path, appended=True),
    "packed.vti": lambda path: progiso.save(volume, path),
    "packed_appended.vti": lambda path: progiso.save(volume, path, appended=True),
    "packed.zfp": lambda path: progiso.save(volume, path),
    "v.mha": lambda path: progiso.save(image, path),
    "v.nii": lambda path: progiso.save(image, path),
    "v.nii.gz": lambda path: progiso.save(image, path),
    "v_24x24x24_float32.raw": lambda path: progiso.save(image, path),
    "s.vtp": lambda path: progiso.save_surface(surface, path),
    "s.stl": lambda path: progiso.save_surface(surface, path),
    "s.ply": lambda path: progiso.save_surface(surface, path),
    "s.obj": lambda path: progiso.save_surface(surface, path),
    "p.png": lambda path: progiso.write_png(pixels, path),
    "d.npy": npy,
    "t.json": text,
}
sizes = {}
for name, write in writers.items():
    write(name)
    sizes[name] = os.path.getsize(name)
    os.remove(name)
found = {}
for name, write in writers.items():
    for limit in (1000, 12345, sizes[name] - 1):
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
        try:
            write(name)
            found[f"{name} {limit}"] = "no error"
        except RuntimeError as error:
            found[f"{name} {limit}"] = str(error)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY,) * 2)
        if os.listdir("."):
            found[f"{name} {limit}"] = f"left behind: {os.listdir('.')}"
            for left in os.listdir("."):
                os.remove(left)
print(json.dumps(found))
"""


def test_no_format_is_cut_short(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, "0"], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert len(found) == 3 * 16
    for case, message in found.items():
        name = case.split()[0]
        assert message.startswith(f"cannot write '{name}': "), f"{case}: {message}"
        assert ".progiso-" not in message and "\n" not in message
        assert "disk" in message or "large" in message, f"{case}: {message}"


def test_the_command_line_tells(tmp_path):
    """Also of the paths that the user gave, in another folder."""
    progiso.save(make_image(blobs((24, 24, 24))), tmp_path / "plain.vti")
    command = (
        "import resource, sys; from progiso.cli import main;"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000)); sys.exit(main(sys.argv[1:]))"
    )
    (tmp_path / "out").mkdir()
    for arguments in (
        ["compress", "plain.vti", "out/c.vti"],
        ["contour", "plain.vti", "out/s.ply", "--isovalue", "0.1"],
        ["contour", "plain.vti", "out/s.obj", "--isovalue", "0.1"],
    ):
        done = subprocess.run(
            [sys.executable, "-c", command, *arguments],
            cwd=tmp_path,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 1 and not done.stdout
        assert len(done.stderr.splitlines()) == 1, done.stderr
        assert f"cannot write '{arguments[2]}'" in done.stderr
        assert not list((tmp_path / "out").iterdir())


@pytest.mark.parametrize("rate", [None, 8])
def test_what_cannot_fit_is_not_begun(tmp_path, rate):
    """2^19 samples a side need some hundred petabytes."""
    with pytest.raises(OSError, match=r"needs .* GiB, and the disk of .* has .* GiB left"):
        if rate is None:
            fetch("sphere", size=2**19, folder=tmp_path)
        else:
            compressed("sphere", size=2**19, rate=rate, folder=tmp_path)
    assert not list(tmp_path.iterdir())


def test_an_interrupted_write_leaves_the_old_file(tmp_path):
    from progiso.io.files import atomic_path

    path = tmp_path / "old.npy"
    np.save(path, np.arange(3))
    with pytest.raises(KeyboardInterrupt), atomic_path(path) as temporary:
        temporary.write_bytes(b"half")
        raise KeyboardInterrupt
    assert np.load(path).tolist() == [0, 1, 2] and list(tmp_path.iterdir()) == [path]
