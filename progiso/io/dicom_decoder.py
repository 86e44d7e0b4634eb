"""Decodes frames of DICOM files in a process of its own, which GDCM may end where it likes.

Standard input has lines of JSON, ``["file", [0, 1]]``; standard output gets for each frame the
length of a ``.npy``, in eight bytes, and this; one of text has the reason why there are no more
frames. It imports nothing of this package.
"""

import io
import json
import sys
import warnings

import numpy as np
from pydicom.pixels import iter_pixels


def put(values: np.ndarray) -> None:
    """Write an array to standard output."""
    memory = io.BytesIO()
    np.save(memory, values, allow_pickle=False)
    sys.stdout.buffer.write(memory.tell().to_bytes(8, "little") + memory.getvalue())


def main() -> None:
    """Decode what standard input names."""
    warnings.simplefilter("ignore")
    for line in sys.stdin.read().splitlines():
        file, indices = json.loads(line)
        try:
            for pixels in iter_pixels(file, indices=indices):
                put(np.ascontiguousarray(pixels))
        except Exception as error:
            put(np.array(f"{type(error).__name__} {error}"))
            break
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
