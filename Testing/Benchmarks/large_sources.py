"""Compress volumes larger than memory from TIFF, HDF5 and Zarr, and tell how much memory it took.

    python Testing/Benchmarks/large_sources.py [--gib 20] [--limit 500] [KIND ...]

The files are made on the fly in a temporary folder: every tenth layer of chunks holds samples of a
wave, the others share one chunk or have none, so that they are small. Each is compressed in a
process of its own at 1 bit a sample; the peak of its resident memory is that of the whole process,
with Python, VTK and the compressed volume. The exit status is 1 where it is above the limit.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

import numpy as np

#: Rows and columns, and slices of a layer of chunks.
SIDE, LAYER = 512, 4

#: Layers of which one holds a wave.
PERIOD = 10

CHILD = """
import json, sys, time, warnings
warnings.simplefilter("ignore")
import progiso
from progiso.io import open_source
def peak():
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024
before, start = peak(), time.perf_counter()
if sys.argv[2] == "compress":
    found = progiso.compress_file(sys.argv[1], rate=1)
else:
    with open_source(sys.argv[1]) as source:
        for samples in source.slabs():
            pass
print(json.dumps({"before": before, "peak": peak(), "seconds": time.perf_counter() - start}))
"""


def layer(number: int) -> np.ndarray:
    """Return a layer of chunks, shape (LAYER, SIDE, SIDE), float64."""
    z, y, x = np.ogrid[number * LAYER : (number + 1) * LAYER, :SIDE, :SIDE]
    return np.round(np.sin(z / 50.0) + np.sin(y / 40.0) + np.sin(x / 30.0), 2)


def write_tiff(path: Path, slices: int, *, kind: str = "strips") -> None:
    """Write pages; those without a wave share what is compressed once."""
    import tifffile

    if kind == "contiguous":  # a hole in the file is zeros
        shape = (slices, SIDE, SIDE)
        tifffile.memmap(path, shape=shape, dtype="f8", bigtiff=True, photometric="minisblack")
        return
    tile = 256 if kind == "tiles" else None

    def segments(page: np.ndarray) -> list[bytes]:
        if tile is None:
            return [zlib.compress(page[y : y + 128].tobytes(), 1) for y in range(0, SIDE, 128)]
        return [
            zlib.compress(page[y : y + tile, x : x + tile].tobytes(), 1)
            for y in range(0, SIDE, tile)
            for x in range(0, SIDE, tile)
        ]

    empty = segments(np.zeros((SIDE, SIDE)))

    def encoded():
        for number in range(0, slices, LAYER):
            if number // LAYER % PERIOD:
                for _ in range(LAYER):
                    yield from empty
            else:
                for page in layer(number // LAYER):
                    yield from segments(page)

    where = {"tile": (tile, tile)} if tile else {"rowsperstrip": 128}
    with tifffile.TiffWriter(path, bigtiff=True) as file:
        file.write(
            encoded(),
            shape=(slices, SIDE, SIDE),
            dtype="f8",
            compression="zlib",
            photometric="minisblack",
            **where,
        )


def write_hdf5(path: Path, slices: int) -> None:
    """Write chunks of the layers with a wave only."""
    import h5py

    with h5py.File(path, "w") as file:
        array = file.create_dataset(
            "volume",
            shape=(slices, SIDE, SIDE),
            dtype="f8",
            chunks=(LAYER, 256, 256),
            compression="gzip",
            compression_opts=1,
        )
        _fill(array, slices)


def write_zarr(path: Path, slices: int, **options: object) -> None:
    """Write chunks of the layers with a wave only."""
    import zarr

    chunks = (LAYER, 128, 128)
    shape = (slices, SIDE, SIDE)
    _fill(zarr.create_array(path, shape=shape, dtype="f8", chunks=chunks, **options), slices)


def write_slices(path: Path, slices: int) -> None:
    """Write a folder of TIFF files."""
    import tifffile

    path.mkdir()
    for number in range(slices):
        waves = number // LAYER % PERIOD == 0
        page = layer(number // LAYER)[number % LAYER] if waves else np.zeros((SIDE, SIDE))
        tifffile.imwrite(path / f"slice_{number:05}.tif", page, compression="zlib")


def _fill(array: object, slices: int) -> None:
    for number in range(0, slices // LAYER, PERIOD):
        array[number * LAYER : (number + 1) * LAYER] = layer(number)  # type: ignore[index]


KINDS = {
    "tiff": ("a.tif", write_tiff),
    "hdf5": ("a.h5", write_hdf5),
    "zarr": ("a.zarr", lambda path, n: write_zarr(path, n, shards=(LAYER, SIDE, SIDE))),
    "tiff-tiles": ("t.tif", lambda path, n: write_tiff(path, n, kind="tiles")),
    "tiff-contiguous": ("c.tif", lambda path, n: write_tiff(path, n, kind="contiguous")),
    "zarr2": ("b.zarr", lambda path, n: write_zarr(path, n, zarr_format=2)),
    "slices": ("slices", write_slices),
}


def main() -> int:
    """Make, compress and measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", default=["tiff", "hdf5", "zarr"], metavar="KIND")
    parser.add_argument("--gib", type=float, default=20, help="size of the samples")
    parser.add_argument("--limit", type=float, default=500, help="MiB of resident memory")
    parser.add_argument("--read", action="store_true", help="only read, slab by slab")
    options = parser.parse_args()
    slices = max(1, round(options.gib * 2**30 / (SIDE * SIDE * 8 * LAYER))) * LAYER
    failed = False
    print("kind             file MiB  before MiB  peak MiB  seconds", flush=True)
    for kind in options.kinds:
        name, write = KINDS[kind]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            write(path, slices)
            files = [path] if path.is_file() else [f for f in path.rglob("*") if f.is_file()]
            size = sum(f.stat().st_blocks * 512 for f in files) / 2**20
            what = "read" if options.read else "compress"
            command = [sys.executable, "-c", CHILD, str(path), what]
            found = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        failed |= found["peak"] > options.limit
        print(
            f"{kind:15} {size:9.0f} {found['before']:11.0f} {found['peak']:9.0f} "
            f"{found['seconds']:8.1f}",
            flush=True,
        )
    return int(failed)


if __name__ == "__main__":
    started = time.perf_counter()
    status = main()
    print(f"{time.perf_counter() - started:.0f} s")
    sys.exit(status)
