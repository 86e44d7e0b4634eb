// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Colours of the values of the volume that gives the surface its colours, as Shading.glsl reads
// them.
#ifndef Palette_h
#define Palette_h

#include <vector>

class vtkCompressedVolume;
class vtkScalarsToColors;

/// Samples a table at PALETTE_SIZE values of its range. The first four numbers are the range's
/// beginning in the units of the stream, the inverse of its length, and two zeros; RGBA follow.
std::vector<float> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors);

#endif
