# Defines the target progiso_zfp: zfp's C library as a private static library, with OpenMP.
#
# The system's libzfp would not do: inside ParaView, libcfitsio (loaded through GDAL) exports
# stream_open and other functions that would shadow libzfp's. Hidden visibility and --exclude-libs
# keep our copy's symbols private. The sources come from the sdist of PyPI's zfpy, unless
# -DPROGISO_ZFP_SOURCE_DIR=DIR names others.

set(PROGISO_ZFP_SOURCE_DIR "" CACHE PATH "zfp 1.0 sources (with include/zfp.h); empty: fetch them")
set(_version 1.0.1)
set(_sha256 75c7014bdb2ad497a08846aaadca6d13de7c154a541c42557e52ec42030ca926)

# Runs COMMAND without the Python settings of the surrounding build. Stops with its output on failure.
function (_progiso_run what)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -E env --unset=PYTHONPATH --unset=PYTHONHOME
            --unset=PIP_BUILD_TRACKER ${ARGN}
    RESULT_VARIABLE result
    OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if (NOT result EQUAL 0)
    message(FATAL_ERROR "Could not ${what} (${result}). Without network, unpack zfpy-${_version}.tar.gz "
      "and pass -DPROGISO_ZFP_SOURCE_DIR=<its folder>.\n${output}")
  endif ()
endfunction ()

# Downloads and unpacks the sdist into DIR, in a temporary environment: pip runs an sdist's setup.py
# for its metadata even when it only downloads, and zfpy's setup.py needs Cython and NumPy.
function (_progiso_fetch_zfp dir)
  set(env "${dir}/venv")
  set(sdist "${dir}/zfpy-${_version}.tar.gz")
  if (NOT EXISTS "${sdist}")
    message(STATUS "Fetching the zfp ${_version} sources")
    _progiso_run("create a Python environment" "${Python3_EXECUTABLE}" -m venv "${env}")
    _progiso_run("install zfpy's build requirements"
      "${env}/bin/python" -m pip install -q setuptools wheel cython numpy)
    _progiso_run("download the zfp sources"
      "${env}/bin/python" -m pip download -q --no-deps --no-build-isolation --no-binary zfpy
      --dest "${dir}" "zfpy==${_version}")
    file(REMOVE_RECURSE "${env}")
  endif ()
  file(SHA256 "${sdist}" actual)
  if (NOT actual STREQUAL _sha256)
    message(FATAL_ERROR "${sdist} has SHA-256 ${actual}, expected ${_sha256}: remove it and try again")
  endif ()
  file(ARCHIVE_EXTRACT INPUT "${sdist}" DESTINATION "${dir}")
endfunction ()

set(_zfp "${PROGISO_ZFP_SOURCE_DIR}")
if (NOT _zfp)
  set(_zfp "${CMAKE_BINARY_DIR}/zfp/zfpy-${_version}")
  if (NOT EXISTS "${_zfp}/include/zfp.h")
    _progiso_fetch_zfp("${CMAKE_BINARY_DIR}/zfp")
  endif ()
endif ()
if (NOT EXISTS "${_zfp}/src/zfp.c")
  message(FATAL_ERROR "no zfp sources in ${_zfp}: PROGISO_ZFP_SOURCE_DIR must hold include/zfp.h and src/zfp.c")
endif ()

find_package(OpenMP REQUIRED COMPONENTS C)
file(GLOB _sources "${_zfp}/src/*.c")
add_library(progiso_zfp STATIC ${_sources})
# The sdist lacks zfp/bitstream.inl. Ours comes last, so that a full source tree uses its own.
target_include_directories(progiso_zfp
  PUBLIC "$<BUILD_INTERFACE:${_zfp}/include>"
  PRIVATE "${_zfp}/src" "${CMAKE_CURRENT_LIST_DIR}")
target_link_libraries(progiso_zfp PUBLIC OpenMP::OpenMP_C PRIVATE m)
# Excludes this library by name, because a sanitizer's library must export its symbols.
target_link_options(progiso_zfp INTERFACE "LINKER:--exclude-libs,libprogiso_zfp.a")
# -fwrapv: streams of arbitrary bits overflow zfp's inverse transform, which must wrap as on the GPU.
# -funroll-loops: saves a fifth of the encoder's time, most of which is a loop over 64 coefficients.
target_compile_options(progiso_zfp PRIVATE "$<$<C_COMPILER_ID:GNU,Clang,AppleClang>:-fwrapv;-funroll-loops>")
set_target_properties(progiso_zfp PROPERTIES
  C_VISIBILITY_PRESET hidden
  POSITION_INDEPENDENT_CODE ON)
unset(_zfp)
unset(_sources)
unset(_version)
unset(_sha256)
