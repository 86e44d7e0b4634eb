"""Images to test with, and what the references say of them."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkCommonDataModel import vtkImageData

import progiso
from progiso.geometry import samples_of
from progiso.oracle import zfp_reference
from progiso.oracle.caster import Volume
from progiso.verify.fields import blobs, make_image, marschner_lobb, noise
from progiso.vtkProgIsoFilters import vtkCompressedVolume

#: What images are made of, passed on to all tests.
__all__ = ["blobs", "make_image", "marschner_lobb", "noise", "samples_of"]

#: The names of a compressed volume's metadata arrays begin with it.
PREFIX = "ProgIso.ZFP."

#: The metadata arrays, but for the stream.
METADATA = ("Version", "BlockBits", "Dimensions", "Range", "ScalarType", "Component", "Association")


def metadata(compressed, name):
    """Return one of a compressed volume's metadata arrays as numbers."""
    return vtk_to_numpy(compressed.GetFieldData().GetAbstractArray(PREFIX + name))


def copy_of(image):
    """Return a copy of an image that shares nothing with it."""
    copy = vtkImageData()
    copy.DeepCopy(image)
    return copy


def message_of(image):
    """Return what is wrong with an image as a compressed volume; nothing if it is one."""
    reader = vtkCompressedVolume()
    reader.Read(image)
    return reader.GetErrorMessage()


def without_checksums(compressed):
    """Make of a compressed volume, in place, one of version 2 of the format; return it."""
    fields = compressed.GetFieldData()
    for name in ("PageChecksums", "MetadataChecksum"):
        fields.RemoveArray(PREFIX + name)
    version = vtkIntArray()
    version.SetName(PREFIX + "Version")
    version.InsertNextValue(2)
    fields.AddArray(version)
    return compressed


def without_ranges(compressed):
    """Take from a compressed volume, in place, the ranges of its blocks, as of older files."""
    volume = vtkCompressedVolume()
    assert volume.Read(compressed) and volume.HasRanges()
    volume.ClearRanges()
    volume.Write(compressed)
    return compressed


def stream_of(compressed):
    """Return a compressed volume's stream as bytes."""
    return metadata(compressed, "Stream").tobytes()


def reference_values(compressed):
    """Decode a compressed volume by libzfp."""
    bits = int(metadata(compressed, "BlockBits")[0])
    return zfp_reference.decode(stream_of(compressed), metadata(compressed, "Dimensions"), bits)


def reference_volume(compressed, user_matrix=None):
    """Give the caster what a compressed volume holds, decoded by libzfp, and where it is."""
    shift = 0.5 if metadata(compressed, "Association")[0] == 1 else 0.0
    user = np.eye(4) if user_matrix is None else user_matrix
    return Volume.from_image(reference_values(compressed), compressed, user, shift)


def same_bits(a, b):
    """Tell whether two float32 arrays agree in every bit, signs of zero included."""
    return a.shape == b.shape and np.array_equal(a.view(np.uint32), b.view(np.uint32))


def check_same(volume, expected):
    """Check that two compressed volumes agree in stream and metadata."""
    assert stream_of(volume) == stream_of(expected)
    for name in METADATA:
        assert metadata(volume, name).tolist() == metadata(expected, name).tolist(), name
    assert progiso.describe(volume)["array"] == progiso.describe(expected)["array"]
