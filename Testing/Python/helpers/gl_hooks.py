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
PROGRAM = 0x82E2
RENDERER = 0x1F01
COMPLETION_STATUS = 0x91B1
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
    "glGetObjectLabel": ctypes.CFUNCTYPE(
        None, _UINT, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_char_p
    ),
    "glGetProgramiv": ctypes.CFUNCTYPE(None, _UINT, _UINT, ctypes.POINTER(ctypes.c_int)),
    "glGetString": ctypes.CFUNCTYPE(_ADDRESS, _UINT),
    "glGetStringi": ctypes.CFUNCTYPE(_ADDRESS, _UINT, _UINT),
    "glLinkProgram": ctypes.CFUNCTYPE(None, _UINT),
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


class Compiler:
    """A GPU's driver that compiles in the background, for as long as a test likes.

    `held` are the stages that it has not finished, `linked` those that it was given.
    """

    def __init__(self):
        self.held, self.linked = set(), []
        self._hooks = contextlib.ExitStack()
        self._renderer = ctypes.create_string_buffer(b"a GPU")
        self._extension = ctypes.create_string_buffer(b"GL_KHR_parallel_shader_compile")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._hooks.close()

    def take_over(self):
        """Take the place of the driver's; a window that is made later would undo it."""
        for name, replacement in {
            "glGetString": self._string,
            "glGetStringi": self._extension_name,
            "glLinkProgram": self._link,
            "glGetProgramiv": self._ask,
        }.items():
            self._hooks.enter_context(intercepted(name, replacement))

    def _string(self, original, name):
        return ctypes.addressof(self._renderer) if name == RENDERER else original(name)

    def _extension_name(self, original, name, index):
        return ctypes.addressof(self._extension) if index == 0 else original(name, index)

    def _link(self, original, program):
        self.linked.append(program_label(program))
        original(program)

    def _ask(self, original, program, what, answer):
        if what == COMPLETION_STATUS:
            answer[0] = program_label(program) not in self.held
        else:
            original(program, what, answer)


def program_label(program):
    """Return the name that somebody has given to a program; of ours, the stage's."""
    label = ctypes.create_string_buffer(256)
    gl("glGetObjectLabel")(PROGRAM, program, len(label), None, label)
    return label.value.decode()


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
