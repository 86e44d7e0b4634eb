// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/Selection.h"

#include "Pipeline/ProgressivePipeline.h"
#include "Scene/DrawingState.h"

#include "vtkCompressedVolume.h"
#include "vtkHardwareSelector.h"

#include <algorithm>

namespace
{
vtkIdType CountIds(const SelectedId& selected)
{
  return static_cast<vtkIdType>(selected.Ids[0]) * selected.Ids[1] * selected.Ids[2];
}

// Finds what the selector's pass asks for; black, which is 0, if it is none of ours.
SelectedId FindSelected(vtkHardwareSelector* selector, const SelectedId& cells,
  const SelectedId& points, unsigned int compositeIndex)
{
  const auto part = [](SelectedId selected, int number)
  {
    selected.IdPart = number;
    return selected;
  };
  SelectedId color;
  switch (selector->GetCurrentPass())
  {
    case vtkHardwareSelector::COMPOSITE_INDEX_PASS:
      if (compositeIndex == 0)
      {
        return color;
      }
      selector->RenderCompositeIndex(compositeIndex);
      break;
    case vtkHardwareSelector::ACTOR_PASS:
    case vtkHardwareSelector::PROCESS_PASS:
      break;
    case vtkHardwareSelector::POINT_ID_LOW24:
      return part(points, 1);
    case vtkHardwareSelector::POINT_ID_HIGH24:
      return part(points, 2);
    case vtkHardwareSelector::CELL_ID_LOW24:
      return part(cells, 1);
    case vtkHardwareSelector::CELL_ID_HIGH24:
      return part(cells, 2);
    default:
      return color;
  }
  selector->GetPropColorValue(color.Color.data());
  return color;
}
}

SelectedId FindIds(const int extent[6], vtkCompressedVolume* volume, bool ofPoints)
{
  SelectedId selected;
  selected.OfPoints = ofPoints;
  selected.IsCentred = volume->GetAssociation() == vtkCompressedVolume::CellData;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int* ends = extent + 2 * axis;
    selected.FirstSample[axis] = volume->GetExtent()[2 * axis] - ends[0];
    selected.Ids[axis] = ends[1] - ends[0] + (ofPoints ? 1 : 0);
  }
  return selected;
}

void DrawSelection(vtkHardwareSelector* selector, vtkOpenGLState* state, const ViewGeometry& view,
  vtkCompressedVolume* volume, const SelectedImage& image, ProgressivePipeline& pipeline)
{
  selector->BeginRenderProp();
  const SelectedId cells = FindIds(image.Extent, volume, false);
  const SelectedId points = FindIds(image.Extent, volume, true);
  selector->UpdateMaximumCellId(CountIds(cells));
  selector->UpdateMaximumPointId(CountIds(points));
  const SelectedId selected = FindSelected(selector, cells, points, image.CompositeIndex);
  const DrawingState drawing(state, view, false);
  pipeline.Select(selected);
  selector->EndRenderProp();
}
