// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Selection.h"

#include "Pipeline/ProgressivePipeline.h"
#include "Scene/DrawingState.h"

#include "vtkCompressedVolume.h"
#include "vtkHardwareSelector.h"

namespace
{
// Finds what the selector's pass asks for; black if it is none of ours.
SelectedId FindSelected(vtkHardwareSelector* selector)
{
  SelectedId selected;
  switch (selector->GetCurrentPass())
  {
    case vtkHardwareSelector::ACTOR_PASS:
      selector->GetPropColorValue(selected.PropColor.data());
      break;
    case vtkHardwareSelector::CELL_ID_LOW24:
      selected.CellIdPart = 1;
      break;
    case vtkHardwareSelector::CELL_ID_HIGH24:
      selected.CellIdPart = 2;
      break;
    default:
      break;
  }
  return selected;
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

void DrawSelection(vtkHardwareSelector* selector, vtkOpenGLState* state, const ViewGeometry& view,
  vtkCompressedVolume* volume, ProgressivePipeline& pipeline)
{
  selector->BeginRenderProp();
  const SelectedId selected = FindSelected(selector);
  selector->UpdateMaximumCellId(CountCells(volume));
  const DrawingState drawing(state, view, false);
  pipeline.Select(selected);
  selector->EndRenderProp();
}
