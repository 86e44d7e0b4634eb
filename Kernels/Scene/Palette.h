// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Colours of the values of the volume that gives the surface its colours, as ValueColors.glsl reads
// them.
#ifndef Palette_h
#define Palette_h

#include "Shaders/Glsl.h"

#include "vtkType.h"

#include <optional>

class vtkCompressedVolume;
class vtkScalarsToColors;

/// Describes a table by nodes, in the units of the colours' stream: where it has its own, where it
/// jumps, and as many more as it takes for 8 bits, up to PALETTE_SIZE. With an indexed lookup each
/// annotated value is a node. None without such a volume.
std::optional<glsl::Palette> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors);

bool IsSamePalette(const std::optional<glsl::Palette>& a, const std::optional<glsl::Palette>& b);

/// Keeps a palette until the table or the volume changes.
class PaletteCache
{
public:
  const std::optional<glsl::Palette>& Update(
    vtkScalarsToColors* table, vtkCompressedVolume* colors, vtkMTimeType colorsTime);

private:
  std::optional<glsl::Palette> Palette;
  vtkScalarsToColors* Table = nullptr;
  vtkMTimeType TableTime = 0;
  vtkMTimeType ColorsTime = 0;
};

#endif
