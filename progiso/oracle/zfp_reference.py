"""Decode and encode fixed-rate streams by libzfp itself: its Python binding, or its tool."""

import pathlib
import shutil
import subprocess
import tempfile

import numpy as np

try:
    import zfpy
except ImportError:
    zfpy = None

VALUES_PER_BLOCK = 64


def decode(stream: bytes, dimensions: tuple[int, ...], block_bits: int) -> np.ndarray:
    """Decode a headerless fixed-rate stream of float32 blocks.

    Parameters
    ----------
    stream : bytes-like
    dimensions : (int, int, int)
        samples along x, y and z.
    block_bits : int
        bits per block of 4x4x4 values.

    Returns
    -------
    numpy.ndarray
        float32 [z, y, x]
    """
    return (_decode_by_binding if zfpy else _decode_by_tool)(
        bytes(stream), tuple(map(int, dimensions)), int(block_bits)
    )


def encode(values: np.ndarray, rate: float) -> bytes:
    """Encode float32 values [z, y, x] by the ``zfp`` tool; return the headerless stream."""
    values = np.ascontiguousarray(values, np.float32)
    with tempfile.TemporaryDirectory() as folder:
        raw, packed = pathlib.Path(folder, "values.raw"), pathlib.Path(folder, "values.zfp")
        values.tofile(raw)
        _zfp("-f", *_size(values.shape[::-1]), "-r", repr(float(rate)), "-i", raw, "-z", packed)
        return packed.read_bytes()


def has_tool() -> bool:
    """Tell whether the ``zfp`` command line tool is installed."""
    return shutil.which("zfp") is not None


def _decode_by_binding(stream: bytes, dimensions: tuple[int, ...], block_bits: int) -> np.ndarray:
    rate = block_bits / VALUES_PER_BLOCK
    return np.array(zfpy._decompress(stream, zfpy.type_float, dimensions[::-1], rate=rate))


def _decode_by_tool(stream: bytes, dimensions: tuple[int, ...], block_bits: int) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        packed, raw = pathlib.Path(folder, "values.zfp"), pathlib.Path(folder, "values.raw")
        packed.write_bytes(stream)
        _zfp(
            "-f",
            *_size(dimensions),
            "-r",
            repr(block_bits / VALUES_PER_BLOCK),
            "-z",
            packed,
            "-o",
            raw,
        )
        return np.fromfile(raw, np.float32).reshape(dimensions[::-1])


def _size(dimensions: tuple[int, ...]) -> list[str]:
    return ["-3", *map(str, dimensions)]


def _zfp(*arguments: object) -> None:
    subprocess.run(["zfp", "-q", *map(str, arguments)], check=True, capture_output=True, text=True)
