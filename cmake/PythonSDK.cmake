# Lets find_package(VTK) find the SDK of the vtk wheel that Python3_EXECUTABLE has, in its package vtk-sdk.
# -DVTK_DIR=<…/cmake/vtk-9.6> takes another VTK.
if (VTK_DIR OR SKBUILD OR NOT Python3_EXECUTABLE)
  return ()
endif ()
execute_process(
  COMMAND "${Python3_EXECUTABLE}" -c "import vtk_sdk; print(*vtk_sdk.__path__)"
  OUTPUT_VARIABLE _sdk
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
if (_sdk)
  list(PREPEND CMAKE_PREFIX_PATH "${_sdk}/content")
else ()
  message(WARNING "${Python3_EXECUTABLE} has no vtk-sdk: run .ci/setup-wheel first, or pass -DVTK_DIR")
endif ()
unset(_sdk)
