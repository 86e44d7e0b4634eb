// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Colours of the values of the volume that gives the surface its colours, as Shading.glsl reads
// them.
#ifndef Palette_h
#define Palette_h

#include "Shaders/Glsl.h"

#include <optional>

class vtkCompressedVolume;
class vtkScalarsToColors;

/// Samples a table at PALETTE_SIZE values of its range, which the palette has in the units of the
/// colours' stream. None without such a volume.
std::optional<glsl::Palette> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors);

bool IsSamePalette(const std::optional<glsl::Palette>& a, const std::optional<glsl::Palette>& b);

#endif
