// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ShownIsovalues.h"

#include "vtkContourValues.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

std::vector<ShownIsovalue> FindShownIsovalues(vtkVolumeProperty* property)
{
  vtkContourValues* values = property->GetIsoSurfaceValues();
  std::vector<ShownIsovalue> shown;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double value = values->GetValue(i);
    const double opacity = property->GetScalarOpacity()->GetValue(value);
    if (opacity > 0.0)
    {
      shown.push_back({ value, std::min(opacity, 1.0) });
    }
  }
  return shown;
}

bool HasTranslucent(const std::vector<ShownIsovalue>& isovalues)
{
  return std::any_of(isovalues.begin(), isovalues.end(),
    [](const ShownIsovalue& isovalue) { return isovalue.Opacity < 1.0; });
}
