"""Files that appear under their names only when they are complete."""

from __future__ import annotations

import errno
import fcntl
import os
import re
import shutil
import signal
import stat
import tempfile
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

from .._typing import FilePath

#: What temporary folders begin with, and the file in them that their writer keeps locked.
_PREFIX = ".progiso-"
_LOCK = ".lock"

#: Seconds after which a folder that no process keeps locked is left over, and one without a lock.
_YOUNG, _OLD = 60, 86400

#: Suffixes of headers that name their data's files, and of pairs of files.
_HEADERS = (".mhd", ".mha", ".nhdr", ".nrrd", ".pvti", ".vtm", ".xmf", ".xdmf")
_PAIRS = (
    {".hdr", ".img", ".img.gz", ".mat"},
    {".head", ".brik", ".brik.gz"},
    {".par", ".rec"},
)

#: Why less is in a file than was written to it.
DISK_FULL = "the disk is full, or files may not be so large"

#: Temporary folders to remove when the process is told to end.
_open_folders: set[str] = set()


# --- before work ----------------------------------------------------------------------------------


def check_output(
    path: FilePath,
    suffixes: Iterable[str] | None = None,
    *,
    inputs: Iterable[FilePath] = (),
    needed: int = 0,
) -> None:
    """Check, before long work, that its result can be written, and overwrites nothing that is read.

    Parameters
    ----------
    path : str or os.PathLike
        The file to create or replace. Of a link, the file that it leads to; a device or a pipe is
        written to.
    suffixes : iterable of str, optional
        What its name may end in.
    inputs : iterable of str or os.PathLike, optional
        Files that the work reads, with all that belongs to them: the data of detached headers, the
        slices in a folder.
    needed : int, default: 0
        Bytes that will be written at least.

    Raises
    ------
    ValueError
        When the name ends in something else, or the file is one of the inputs.
    FileNotFoundError, IsADirectoryError, PermissionError
        When the folder does not exist or is not writable, or `path` is a folder.
    OSError
        When the disk has less room than is needed.
    """
    path = Path(path)
    if suffixes is not None and not path.name.lower().endswith(tuple(suffixes)):
        raise ValueError(f"do not know how to write '{path}': use one of {', '.join(suffixes)}")
    target = _resolved(path)
    if _is_special(target):
        return
    if not target.parent.is_dir():
        raise FileNotFoundError(f"cannot write '{path}': folder '{target.parent}' does not exist")
    if target.is_dir():
        raise IsADirectoryError(f"cannot write '{path}': it is a folder")
    if not os.access(target.parent, os.W_OK):
        raise PermissionError(f"cannot write '{path}': folder '{target.parent}' is not writable")
    for read in inputs:
        if _belongs_to(target, Path(read)):
            raise ValueError(
                f"cannot write '{path}': it is, or belongs to, the input '{read}', which would be "
                "lost; name another file"
            )
    _check_space(path, target.parent, needed)


def check_outputs(paths: Iterable[FilePath | None], inputs: Iterable[FilePath] = ()) -> None:
    """Check several results of one command as `check_output` does, and that they are different.

    Raises
    ------
    ValueError
        When two are the same file.
    """
    seen: dict[str, FilePath] = {}
    for path in paths:
        if path is None:
            continue
        check_output(path, inputs=inputs)
        target = _resolved(Path(path))
        name = os.path.realpath(target)
        if name in seen and not _is_special(target):
            raise ValueError(f"cannot write '{path}': '{seen[name]}' is the same file")
        seen[name] = path


def _check_space(path: Path, folder: Path, needed: int) -> None:
    """Raise where a disk has less room than is needed."""
    free = shutil.disk_usage(folder).free
    if needed > free:
        sizes = [f"{size / 2**30:.3g} GiB" for size in (needed, free)]
        message = f"it needs {sizes[0]}, and the disk of '{folder}' has {sizes[1]} left"
        raise OSError(f"cannot write '{path}': {message}")


def _belongs_to(output: Path, read: Path) -> bool:
    """Tell whether an output is a file that is read, or one that belongs to it."""
    if not read.exists():  # "file.h5:/group/array"
        read = Path(str(read).partition(":/")[0])
    if not output.exists() or not read.exists():
        return False
    if os.path.samefile(output, read):
        return True
    if read.is_dir():
        return _is_one_of_many(output, read)
    suffixes = {_suffix(output), _suffix(read)}
    if any(suffixes <= pair for pair in _PAIRS):
        return os.path.samefile(output.parent, read.parent) and _stem(output) == _stem(read)
    return _suffix(read) in _HEADERS and _is_named_in(output, read)


def _suffix(path: Path) -> str:
    name = path.name.lower()
    suffix = Path(name).suffix
    return Path(name.removesuffix(".gz")).suffix + ".gz" if suffix == ".gz" else suffix


def _stem(path: Path) -> str:
    return path.name[: len(path.name) - len(_suffix(path))]


def _is_one_of_many(output: Path, folder: Path) -> bool:
    """Tell whether a file lies in a folder of others of its kind, or in a store of chunks."""
    if _suffix(folder) == ".zarr":
        return Path(os.path.realpath(output)).is_relative_to(os.path.realpath(folder))
    if not os.path.samefile(output.parent, folder):
        return False
    others = (other for other in folder.iterdir() if other.name != output.name)
    return any(_suffix(other) == _suffix(output) for other in others)


def _is_named_in(output: Path, header: Path) -> bool:
    """Tell whether a header names a file as its data, by its name or by a pattern of numbers."""
    with open(header, "rb") as file:
        text = file.read(2**16)
    relative = os.path.relpath(os.path.realpath(output), os.path.realpath(header.parent))
    names = {relative, str(output), os.path.realpath(output)}
    if any(name.encode(code) in text for name in names for code in _codes(name)):
        return True
    patterns = re.findall(rb"[^\s\"=]*%0?\d*d[^\s\"=]*", text)
    found = (re.split(r"%0?\d*d", p.decode("utf-8", "replace")) for p in patterns)
    return any(re.fullmatch(r"\d+".join(map(re.escape, parts)), relative) for parts in found)


def _codes(name: str) -> tuple[str, ...]:
    try:
        name.encode("latin-1")
    except UnicodeEncodeError:
        return ("utf-8",)
    return ("utf-8", "latin-1")


# --- links, devices and pipes ---------------------------------------------------------------------


def _resolved(path: Path) -> Path:
    """Follow links to the file that they lead to; links to open files are left as they are."""
    for _ in range(40):
        if _is_descriptor(path) or not path.is_symlink():
            return path
        path = path.parent / os.readlink(path)
    raise OSError(errno.ELOOP, f"cannot write '{path}': its links lead nowhere")


def _is_descriptor(path: Path) -> bool:
    """Tell whether a name is that of an open file, as /dev/stdout is in the end."""
    folder = os.path.realpath(path.parent)
    return re.fullmatch(r"/proc/\d+(/task/\d+)?/fd", folder) is not None


def _is_special(target: Path) -> bool:
    """Tell whether a file is to be written to, and not replaced: a device, a pipe, an open file."""
    if _is_descriptor(target):
        return True
    try:
        mode = target.stat().st_mode
    except OSError:
        return False
    return not stat.S_ISREG(mode) and not stat.S_ISDIR(mode)


def _pour(source: Path, target: Path) -> None:
    """Write a file's bytes to a device, a pipe or an open file."""
    own = target.parent.as_posix() in ("/proc/self/fd", "/dev/fd", f"/proc/{os.getpid()}/fd")
    place: int | Path = os.dup(int(target.name)) if own and target.name.isdecimal() else target
    with open(source, "rb") as data, open(place, "wb", buffering=0) as sink:
        while chunk := data.read(2**20):
            left = memoryview(chunk)
            while left:
                left = left[sink.write(left) :]


# --- writing --------------------------------------------------------------------------------------


@contextmanager
def atomic_path(path: FilePath) -> Iterator[Path]:
    """Yield a temporary path to write to, renamed to `path` when the block succeeds.

    A link stays one: the file that it leads to is replaced. What is no regular file, such as
    ``/dev/null``, a pipe, or ``/dev/stdout``, is not replaced but written to. The new file has the
    permissions of the old one.

    Parameters
    ----------
    path : str or os.PathLike
        The file to create or replace. Its folder must exist.

    Yields
    ------
    pathlib.Path
        A path in the same folder, with the same name inside a temporary folder of its own, so
        that writers that go by the suffix work.

    Raises
    ------
    OSError
        When `path` cannot be written, see `check_output`.
    RuntimeError
        When writing fails in the block, or the disk is full. The message names `path`, and nothing
        is left behind.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with atomic_path(Path(folder) / "note.txt") as temporary:
    ...         _ = temporary.write_text("complete")
    ...     (Path(folder) / "note.txt").read_text()
    'complete'
    """
    path = Path(path)
    check_output(path)
    target = _resolved(path)
    special = _is_special(target)
    with _temporary_folder(None if special else target.parent) as folder:
        temporary = folder / path.name
        with _failures_named(path, temporary):
            yield temporary
            _flush(temporary)
            if special:
                _pour(temporary, target)
            else:
                with suppress(FileNotFoundError):
                    shutil.copymode(target, temporary)
                os.replace(temporary, target)


def check_bytes(path: Path, expected: int) -> None:
    """Raise `RuntimeError` unless a file that has been written has so many bytes."""
    actual = path.stat().st_size if path.is_file() else 0
    if actual != expected:
        raise RuntimeError(
            f"cannot write '{path}': {actual} bytes of {expected} were written; {DISK_FULL}"
        )


@contextmanager
def _failures_named(path: Path, temporary: Path) -> Iterator[None]:
    """Have exceptions speak of the file that is asked for, not of the temporary one."""
    try:
        yield
    except OSError as error:
        short = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, None)
        reason = (
            f"{DISK_FULL} ({error.strerror or error})" if short else error.strerror or str(error)
        )
        raise RuntimeError(f"cannot write '{path}': {reason}") from error
    except (RuntimeError, ValueError) as error:
        text = str(error)
        if str(temporary) not in text:
            raise
        raise type(error)(text.replace(str(temporary), str(path))) from error


def _flush(temporary: Path) -> None:
    """Have a file written to its disk: some tell only then that they are full."""
    with open(temporary, "rb+") as file:
        os.fsync(file.fileno())


@contextmanager
def _temporary_folder(parent: Path | None) -> Iterator[Path]:
    """Make a folder that is gone in the end, and after SIGTERM or SIGHUP; remove old left-overs."""
    if parent is not None:
        _remove_stale(parent)
    with tempfile.TemporaryDirectory(prefix=_PREFIX, dir=parent) as name:
        _open_folders.add(name)
        lock = os.open(Path(name) / _LOCK, os.O_CREAT | os.O_RDWR)
        try:
            with suppress(OSError):  # not every file system has locks
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with _removed_by_signals():
                yield Path(name)
        finally:
            os.close(lock)
            _open_folders.discard(name)


@contextmanager
def _removed_by_signals() -> Iterator[None]:
    """Remove temporary folders before a signal ends the process, unless the program handles it."""
    numbers = []
    if threading.current_thread() is threading.main_thread():
        wanted = (signal.SIGTERM, signal.SIGHUP)
        numbers = [number for number in wanted if signal.getsignal(number) is signal.SIG_DFL]
    for number in numbers:
        signal.signal(number, _end)
    try:
        yield
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)


def _end(number: int, _frame: FrameType | None) -> None:
    """Remove temporary folders, and end as the signal would have it."""
    for name in list(_open_folders):
        shutil.rmtree(name, ignore_errors=True)
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


def _remove_stale(parent: Path) -> None:
    """Remove the temporary folders of processes that were killed."""
    with suppress(OSError), os.scandir(parent) as entries:
        for entry in entries:
            if entry.name.startswith(_PREFIX) and _is_stale(entry):
                shutil.rmtree(entry.path, ignore_errors=True)


def _is_stale(entry: os.DirEntry[str]) -> bool:
    """Tell whether a temporary folder is ours, not new, and no process works on it."""
    about = entry.stat(follow_symlinks=False)
    age = time.time() - about.st_mtime
    if not stat.S_ISDIR(about.st_mode) or about.st_uid != os.geteuid() or age < _YOUNG:
        return False
    try:
        lock = os.open(Path(entry.path) / _LOCK, os.O_RDWR)
    except FileNotFoundError:  # of a version that knew no locks
        return age > _OLD
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(lock)
    return True
