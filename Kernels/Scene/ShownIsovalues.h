// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The isovalues of a volume property that are drawn.
#ifndef ShownIsovalues_h
#define ShownIsovalues_h

#include <vector>

class vtkVolumeProperty;

struct ShownIsovalue
{
  double Value;   ///< in the units of the image
  double Opacity; ///< above 0, at most 1
};

/// Finds the isovalues whose opacity is above 0, in the property's order.
std::vector<ShownIsovalue> FindShownIsovalues(vtkVolumeProperty* property);

/// Whether one of the isovalues has an opacity below 1.
bool HasTranslucent(const std::vector<ShownIsovalue>& isovalues);

#endif
