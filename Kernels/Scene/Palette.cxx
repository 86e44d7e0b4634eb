// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Palette.h"

#include "Shaders/Glsl.h"

#include "vtkCompressedVolume.h"
#include "vtkScalarsToColors.h"

std::vector<float> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* colors)
{
  const double* range = table->GetRange();
  const double extent = range[1] - range[0];
  std::vector<float> palette = { static_cast<float>(colors->ToStored(range[0])),
    extent > 0.0 ? static_cast<float>(colors->GetScale() / extent) : 0.0f, 0.0f, 0.0f };
  for (int i = 0; i < glsl::PALETTE_SIZE; ++i)
  {
    double color[3];
    table->GetColor(range[0] + extent * i / (glsl::PALETTE_SIZE - 1), color);
    for (double channel : { color[0], color[1], color[2], 1.0 })
    {
      palette.push_back(static_cast<float>(channel));
    }
  }
  return palette;
}
