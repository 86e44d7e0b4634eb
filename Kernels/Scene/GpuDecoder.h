// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Decodes a whole volume with the decoder of the shaders, for tests.
#ifndef GpuDecoder_h
#define GpuDecoder_h

#include "Status.h"

class vtkCompressedVolume;
class vtkFloatArray;
class vtkOpenGLRenderWindow;

/// Fills `samples` in x-fastest order, in the units of the stream.
Status DecodeOnGPU(
  vtkOpenGLRenderWindow* window, vtkCompressedVolume* volume, vtkFloatArray* samples);

#endif
