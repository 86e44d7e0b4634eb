// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Selection.h"

#include "Pipeline/ProgressivePipeline.h"
#include "Scene/DrawingState.h"

#include "vtkCompressedVolume.h"
#include "vtkHardwareSelector.h"

#include <array>

namespace
{
// Finds what Select.frag draws: the prop's colour, or in the last component which half of the
// cell's id.
std::array<float, 4> FindSelected(vtkHardwareSelector* selector)
{
  float prop[3];
  selector->GetPropColorValue(prop);
  switch (selector->GetCurrentPass())
  {
    case vtkHardwareSelector::ACTOR_PASS:
      return { { prop[0], prop[1], prop[2], 0.0f } };
    case vtkHardwareSelector::CELL_ID_LOW24:
      return { { 0.0f, 0.0f, 0.0f, 1.0f } };
    case vtkHardwareSelector::CELL_ID_HIGH24:
      return { { 0.0f, 0.0f, 0.0f, 2.0f } };
    default:
      return { { 0.0f, 0.0f, 0.0f, 0.0f } };
  }
}

vtkIdType CountCells(vtkCompressedVolume* volume)
{
  vtkIdType cells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells *= volume->GetDimensions()[axis] - 1;
  }
  return cells;
}
}

void DrawSelection(vtkHardwareSelector* selector, vtkOpenGLState* state,
  vtkCompressedVolume* volume, ProgressivePipeline& pipeline)
{
  selector->BeginRenderProp();
  const std::array<float, 4> selected = FindSelected(selector);
  selector->UpdateMaximumCellId(CountCells(volume));
  const DrawingState drawing(state, false);
  pipeline.Select(selected);
  selector->EndRenderProp();
}
