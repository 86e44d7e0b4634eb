"""What is read from compilers' logs and binaries by Testing/Benchmarks/shader-statistics."""

import importlib.machinery
import importlib.util
import json
import subprocess
import sys

import pytest

from helpers import REPOSITORY

BENCHMARKS = REPOSITORY / "Testing" / "Benchmarks"

NVIDIA = """!!NVcp5.0
OPTION NV_shader_storage_buffer;
GROUP_SIZE 32;
STORAGE sbo_buf0[] = { program.storage[0] };
SHARED_MEMORY 1024;
SHARED shared_mem[] = { program.sharedmem };
TEMP R0, R1;
LONG TEMP D0;
TEMP RC;
# a comment;
MUL.S R0.x, invocation.groupid, {32, 0, 0, 0};
LDB.U32 R0.x, sbo_buf0[R0.x];
BB1:
REP.S;
ADD.F64 D0.x, D0.x, D0.x;
IF NE.x;
STS.U32 R0.x, shared_mem[R1.x];
BRK;
ENDIF;
ENDREP;
ATOMB.ADD.U32 R0.x, R1.x, sbo_buf0[0];
BAR;
END
"""

INTEL = """Native code for CastRays compute shader GL12 (sha1 abc)
SIMD8 shader: 10 instructions. 1 loops. 99 cycles. 0:0 spills:fills, 3 sends, scheduled with mode
Native code for CastRays compute shader GL12 (sha1 abc2)
SIMD16 shader: 1842 instructions. 5 loops. 4711 cycles. 14:33 spills:fills, 3 sends, scheduled
Native code for unnamed fragment shader GL3 (sha1 abc3)
SIMD8 shader: 7 instructions. 0 loops. 9 cycles. 0:0 spills:fills, 3 sends, scheduled with mode
"""

AMD = """label: CastRays
...
After RA:
BB0
/* logical preds: / linear preds: / kind: top-level, */
\ts1: %3:s[0],  s1: %4:s[1] = p_startpgm
\ts2: %8:s[2-3] = s_load_dwordx2 %2:s[0-1], 0
\tv1: %9:v[1] = v_add_u32 %5:v[0], %6:v[2]
\tds_write_b32 %9:v[1], %3:v[3]
\ts_endpgm
Shader Stats: SGPRS: 32 VGPRS: 40 Code Size: 64 LDS: 0 Scratch: 0 Max Waves: 12 \
Spilled SGPRs: 1 Spilled VGPRs: 2 PrivMem VGPRs: 0 DivergentLoop: 0 (CS, W64)
"""


@pytest.fixture(scope="module")
def tool():
    loader = importlib.machinery.SourceFileLoader(
        "shader_statistics", str(BENCHMARKS / "shader-statistics")
    )
    spec = importlib.util.spec_from_loader(loader.name, loader)
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_instructions_are_counted_by_kind(tool):
    counts = tool.count_assembly(NVIDIA)
    assert counts["instructions"] == 11
    assert (counts["registers"], counts["long registers"]) == (3, 1)
    assert {kind: counts[kind] for kind in tool.KINDS} == {
        **{"double": 1, "load": 1, "store": 0, "shared": 1},
        **{"atomic": 1, "branch": 3, "barrier": 1},
    }


def test_assembly_is_found_in_a_binary(tool):
    binary = b"\x01\x02" + NVIDIA.encode() + b"\xff more\x00" + NVIDIA.encode()
    assert [text.decode() + "\n" for text in tool.ASSEMBLY.findall(binary)] == [NVIDIA, NVIDIA]


def test_log_of_intels_compiler_names_the_stages(tool):
    rows = tool.MAKERS["intel"].rows(INTEL)
    assert [(row["stage"], row["SIMD"], row["instructions"]) for row in rows] == [
        ("CastRays", 8, 10),
        ("CastRays", 16, 1842),
        ("unnamed", 8, 7),
    ]
    assert rows[1]["spills:fills"] == "14:33"


def test_log_of_amds_compiler_names_the_stages(tool):
    assert tool.MAKERS["amd"].rows(AMD) == [
        {
            **{"stage": "CastRays", "wave": 64, "instructions": 4, "vector registers": 40},
            **{"spilled": "2, 1 scalar", "waves": 12},
        }
    ]


@pytest.mark.parametrize("variant", ["whole", "cached"])
def test_every_stage_of_the_variant_is_compiled(variant):
    """What is drawn to have the stages compiled needs them."""
    done = subprocess.run(
        [sys.executable, BENCHMARKS / "shaders" / "draw_images.py", variant],
        capture_output=True,
        text=True,
        check=True,
    )
    seconds = json.loads(done.stdout.splitlines()[-1])
    assert {"BlockRanges", "CastRays", "FinishHits", "DecodeBlocks", "Composite"} <= set(seconds)
    assert ("CacheEvict" in seconds) == ("RequestBlocks" in seconds) == (variant == "cached")
