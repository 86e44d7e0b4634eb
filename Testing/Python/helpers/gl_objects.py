"""OpenGL's objects, counted."""

import ctypes

KINDS = "Buffer Texture Program Shader Query Framebuffer Renderbuffer VertexArray".split()


def count_objects(window):
    """Count OpenGL's objects of each kind, by asking for every name."""
    window.MakeCurrent()
    names = {"vtkOSOpenGLRenderWindow": "libOSMesa.so.8", "vtkEGLRenderWindow": "libOpenGL.so.0"}
    library = ctypes.CDLL(names.get(window.GetClassName(), "libGL.so.1"))
    counts = {}
    for kind in KINDS:
        exists = getattr(library, "glIs" + kind)
        exists.argtypes, exists.restype = [ctypes.c_uint], ctypes.c_ubyte
        counts[kind] = sum(bool(exists(name)) for name in range(1, 3000))
    return counts
