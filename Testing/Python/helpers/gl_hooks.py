"""OpenGL as it fails, or as other GPUs have it.

Something is put between VTK or the mapper and the functions they call.
"""

import contextlib
import ctypes
import pathlib
import time

import numpy as np
import vtkmodules

OUT_OF_MEMORY = 0x0505
VENDOR = 0x1F00
EXTENSIONS = 0x1F03
SPARSE_BUFFER_PAGE_SIZE = 0x82F8
SPARSE_STORAGE = 0x0400
STORAGE_BUFFER_BINDING = 0x90D3
R32UI, RED_INTEGER, UNSIGNED_INT = 0x8236, 0x8D94, 0x1405
DYNAMIC_DRAW = 0x88E8
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
    "glBindBuffer": ctypes.CFUNCTYPE(None, _UINT, _UINT),
    "glBufferData": ctypes.CFUNCTYPE(None, _UINT, _SIZE, _ADDRESS, _UINT),
    "glBufferPageCommitmentARB": ctypes.CFUNCTYPE(None, _UINT, _SIZE, _SIZE, ctypes.c_ubyte),
    "glBufferStorage": ctypes.CFUNCTYPE(None, _UINT, _SIZE, _ADDRESS, _UINT),
    "glClearBufferSubData": ctypes.CFUNCTYPE(
        None, _UINT, _UINT, _SIZE, _SIZE, _UINT, _UINT, _ADDRESS
    ),
    "glClientWaitSync": ctypes.CFUNCTYPE(_UINT, _ADDRESS, _UINT, ctypes.c_uint64),
    "glCompileShader": ctypes.CFUNCTYPE(None, _UINT),
    "glDebugMessageCallback": ctypes.CFUNCTYPE(None, _ADDRESS, _ADDRESS),
    "glDebugMessageControl": ctypes.CFUNCTYPE(
        None, _UINT, _UINT, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_ubyte
    ),
    "glDispatchCompute": ctypes.CFUNCTYPE(None, _UINT, _UINT, _UINT),
    "glDispatchComputeIndirect": ctypes.CFUNCTYPE(None, _SIZE),
    "glEnable": ctypes.CFUNCTYPE(None, _UINT),
    "glGetBufferSubData": ctypes.CFUNCTYPE(None, _UINT, _SIZE, _SIZE, _ADDRESS),
    "glGetError": ctypes.CFUNCTYPE(_UINT),
    "glGetIntegerv": ctypes.CFUNCTYPE(None, _UINT, ctypes.POINTER(ctypes.c_int)),
    "glGetObjectLabel": ctypes.CFUNCTYPE(
        None, _UINT, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_char_p
    ),
    "glGetProgramiv": ctypes.CFUNCTYPE(None, _UINT, _UINT, ctypes.POINTER(ctypes.c_int)),
    "glLinkProgram": ctypes.CFUNCTYPE(None, _UINT),
    "glGetShaderSource": ctypes.CFUNCTYPE(None, _UINT, ctypes.c_int, _ADDRESS, ctypes.c_char_p),
    "glGetString": ctypes.CFUNCTYPE(_ADDRESS, _UINT),
    "glGetStringi": ctypes.CFUNCTYPE(_ADDRESS, _UINT, _UINT),
    "glMapBufferRange": ctypes.CFUNCTYPE(_ADDRESS, _UINT, _SIZE, _SIZE, _UINT),
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
    return _PROTOTYPES[name](_pointer(name).value or 0)


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

    `held` are the stages that it has not finished, `linked` those that it was given. If it is
    `slow` it only says that it compiles in the background, and takes so many seconds each time.
    """

    def __init__(self):
        self.slow = 0.0
        self.held, self.linked, self._asked = set(), [], set()
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
        self._asked.discard(program)
        self.linked.append(program_label(program))
        original(program)
        time.sleep(self.slow)

    def _ask(self, original, program, what, answer):
        if what == COMPLETION_STATUS:
            known = program in self._asked or self.slow > 0
            answer[0] = known and program_label(program) not in self.held
            self._asked.add(program)
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


def without_extension(hidden):
    """Have the context offer all extensions but one."""
    other = ctypes.create_string_buffer(b"GL_none")

    def name_of(original, what, i):
        address = original(what, i)
        return ctypes.addressof(other) if ctypes.string_at(address) == hidden else address

    return intercepted("glGetStringi", name_of)


class SparseBuffers:
    """Have the context offer sparse buffers, as NVIDIA's do, on top of plain ones.

    Pages without memory hold a pattern: :meth:`check` finds what was written there. A page that
    is committed holds rubbish.
    """

    PAGE = 65536
    WITHOUT, RUBBISH = 0x5A5A5A5A, 0xDEADBEEF

    def __init__(self):
        self.committed = {}  # name of a buffer → its pages
        self.largest_commit = 0
        self._texts = [ctypes.create_string_buffer(b"NVIDIA Corporation")]
        self._texts.append(ctypes.create_string_buffer(b"GL_ARB_sparse_buffer"))

    @contextlib.contextmanager
    def offered(self):
        with contextlib.ExitStack() as stack:
            for name, replacement in {
                "glGetString": self._get_string,
                "glGetStringi": self._get_string_i,
                "glGetIntegerv": self._get_integer,
                "glBufferStorage": self._make,
                "glBufferPageCommitmentARB": self._commit,
            }.items():
                stack.enter_context(intercepted(name, replacement))
            yield self

    def _get_string(self, original, what):
        return ctypes.addressof(self._texts[0]) if what == VENDOR else original(what)

    def _get_string_i(self, original, what, i):
        hidden = what == EXTENSIONS and i == 0
        return ctypes.addressof(self._texts[1]) if hidden else original(what, i)

    def _get_integer(self, original, what, values):
        if what == SPARSE_BUFFER_PAGE_SIZE:
            values[0] = self.PAGE
        else:
            original(what, values)

    def _make(self, original, target, size, data, flags):
        if not flags & SPARSE_STORAGE:
            return original(target, size, data, flags)
        assert data is None
        gl("glBufferData")(target, size, None, DYNAMIC_DRAW)
        self.committed[self._bound()] = np.zeros(-(-size // self.PAGE), bool)
        return self._fill(target, 0, size, self.WITHOUT)

    def _commit(self, _original, target, begin, size, commit):
        assert commit and begin % self.PAGE == 0 and size > 0
        pages = self.committed[self._bound()]
        last = begin + size == len(pages) * self.PAGE
        assert size % self.PAGE == 0 or last
        these = slice(begin // self.PAGE, -(-(begin + size) // self.PAGE))
        assert these.stop <= len(pages) and not pages[these].any()
        pages[these] = True
        self.largest_commit = max(self.largest_commit, size)
        self._fill(target, begin, size, self.RUBBISH)

    def check(self):
        """Hold what the buffers have where they have no memory against the pattern."""
        for name, pages in self.committed.items():
            for page in np.flatnonzero(~pages):
                words = np.zeros(self.PAGE // 4, np.uint32)
                gl("glBindBuffer")(COPY_READ_BUFFER, name)
                gl("glGetBufferSubData")(
                    COPY_READ_BUFFER, int(page) * self.PAGE, words.nbytes, words.ctypes.data
                )
                assert (words == self.WITHOUT).all(), f"buffer {name}, page {page}"
        gl("glBindBuffer")(COPY_READ_BUFFER, 0)

    def bytes(self):
        """Return the bytes of all pages that have memory."""
        return sum(int(pages.sum()) for pages in self.committed.values()) * self.PAGE

    @staticmethod
    def _bound():
        name = ctypes.c_int()
        gl("glGetIntegerv")(STORAGE_BUFFER_BINDING, ctypes.byref(name))
        return name.value

    @staticmethod
    def _fill(target, begin, size, word):
        gl("glClearBufferSubData")(
            *(target, R32UI, begin, size, RED_INTEGER, UNSIGNED_INT),
            ctypes.addressof(ctypes.c_uint(word)),
        )


def gl_errors():
    """Return OpenGL's errors that nobody has asked for."""
    return [error for error in iter(gl("glGetError"), 0)]
