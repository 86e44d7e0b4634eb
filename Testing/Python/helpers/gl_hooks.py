"""OpenGL as it fails: something is put between VTK or the mapper and the functions they call."""

import contextlib
import ctypes
import pathlib

import vtkmodules

OUT_OF_MEMORY = 0x0505
STORAGE_BUFFER = 0x90D2
UNIFORM_BUFFER = 0x8A11
COPY_READ_BUFFER = 0x8F36
COPY_WRITE_BUFFER = 0x8F37
HUGE = 1 << 50  # bytes that no driver has

_UINT, _SIZE, _ADDRESS = ctypes.c_uint, ctypes.c_ssize_t, ctypes.c_void_p
_PROTOTYPES = {
    "glBufferData": ctypes.CFUNCTYPE(None, _UINT, _SIZE, _ADDRESS, _UINT),
    "glCompileShader": ctypes.CFUNCTYPE(None, _UINT),
    "glDebugMessageCallback": ctypes.CFUNCTYPE(None, _ADDRESS, _ADDRESS),
    "glDebugMessageControl": ctypes.CFUNCTYPE(
        None, _UINT, _UINT, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_ubyte
    ),
    "glDispatchCompute": ctypes.CFUNCTYPE(None, _UINT, _UINT, _UINT),
    "glEnable": ctypes.CFUNCTYPE(None, _UINT),
    "glGetError": ctypes.CFUNCTYPE(_UINT),
    "glGetShaderSource": ctypes.CFUNCTYPE(None, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_char_p),
    "glShaderSource": ctypes.CFUNCTYPE(
        None, _UINT, ctypes.c_int, ctypes.POINTER(ctypes.c_char_p), _ADDRESS
    ),
}


def _pointer(name):
    """Return the pointer that a function is called through.

    VTK's OpenGL loader fills it in when a window is made.
    """
    (library,) = pathlib.Path(vtkmodules.__file__).parent.glob("libvtkglad*.so")
    return ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), f"vtk_glad_{name}")


def gl(name):
    """Return a function of OpenGL, of the current context."""
    return _PROTOTYPES[name](_pointer(name).value)


@contextlib.contextmanager
def intercepted(name, replacement):
    """Have `replacement` called in place of an OpenGL function.

    Its first argument is the function itself.
    """
    pointer, original = _pointer(name), gl(name)
    before = pointer.value
    hook = _PROTOTYPES[name](lambda *arguments: replacement(original, *arguments))
    pointer.value = ctypes.cast(hook, ctypes.c_void_p).value
    try:
        yield
    finally:
        pointer.value = before


class NoRoom:
    """Have one allocation fail, by its number among those of some kinds of buffers."""

    def __init__(self, number, targets):
        self.number, self.targets, self.count = number, targets, 0

    def __call__(self, original, target, size, data, usage):
        if target in self.targets:
            self.count += 1
            if self.count == self.number:
                return original(target, HUGE, None, usage)
        return original(target, size, data, usage)


def gl_errors():
    """Return OpenGL's errors that nobody has asked for."""
    return [error for error in iter(gl("glGetError"), 0)]
