// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Palette.h"

#include "vtkCompressedVolume.h"
#include "vtkScalarsToColors.h"

#include <algorithm>
#include <cstring>

std::optional<glsl::Palette> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors)
{
  if (!colors)
  {
    return std::nullopt;
  }
  const double* range = table->GetRange();
  const double extent = range[1] - range[0];
  glsl::Palette palette = {};
  palette.Low = static_cast<float>(colors->ToStored(range[0]));
  palette.PerUnit = extent > 0.0 ? static_cast<float>(colors->GetScale() / extent) : 0.0f;
  for (int i = 0; i < glsl::PALETTE_SIZE; ++i)
  {
    double color[3];
    table->GetColor(range[0] + extent * i / (glsl::PALETTE_SIZE - 1), color);
    std::copy(color, color + 3, palette.Colors[i].Rgb);
  }
  return palette;
}

bool IsSamePalette(const std::optional<glsl::Palette>& a, const std::optional<glsl::Palette>& b)
{
  return a.has_value() == b.has_value() &&
    (!a || std::memcmp(&a.value(), &b.value(), sizeof(glsl::Palette)) == 0);
}
