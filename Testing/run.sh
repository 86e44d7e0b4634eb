#!/usr/bin/env bash
# Sets up both stacks and runs all tests: those in C++ by CTest on each stack, then the others by
# pytest, whose closing line comes last. Arguments go to pytest.
set -uo pipefail
cd "$(dirname "$0")/.."

.ci/setup-wheel test && .ci/setup-paraview test || exit 1

export PROGISO_GL_DEBUG=1
# what pytest needs of the ParaView stack: the build, and a Python with pyvista on ParaView's VTK
export PROGISO_PARAVIEW_BUILD="$PWD/build/paraview"
export PROGISO_PARAVIEW_PYTHON="$PWD/.venv-paraview/bin/python"
status=0
echo "== C++ tests, wheel stack"
VTK_DEFAULT_OPENGL_WINDOW=vtkOSOpenGLRenderWindow \
  ctest --test-dir build/wheel --output-on-failure || status=1
echo "== C++ tests, ParaView stack"
xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
  ctest --test-dir build/paraview --output-on-failure || status=1
echo "== Python tests"
.venv/bin/python -m pytest Testing/Python "$@" || status=1
exit $status
