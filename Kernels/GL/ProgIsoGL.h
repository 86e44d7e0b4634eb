// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// VTK 9.4 and later load OpenGL through glad, earlier ones through GLEW; the gl* names are the
// same.
#ifndef ProgIsoGL_h
#define ProgIsoGL_h

#if __has_include("vtk_glad.h")
#include "vtk_glad.h"
#elif __has_include("vtk_glew.h")
#include "vtk_glew.h"
#else
#error "this VTK offers no OpenGL loader header (vtk_glad.h or vtk_glew.h)"
#endif

#endif
