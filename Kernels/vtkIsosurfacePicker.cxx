// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfacePicker.h"

#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkCommand.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>

namespace
{
// Depth buffers have 24 bits; conversions cost two of them.
constexpr double DepthTolerance = 1.0 / (1 << 22);

double WindowDepth(vtkRenderer* renderer, const double position[3])
{
  double x = position[0], y = position[1], z = position[2];
  renderer->WorldToView(x, y, z);
  return z;
}
}

vtkStandardNewMacro(vtkIsosurfacePicker);

vtkIsosurfacePicker::vtkIsosurfacePicker()
  : Isovalue(vtkMath::Nan())
{
}

void vtkIsosurfacePicker::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Isovalue: " << this->Isovalue << "\n";
}

void vtkIsosurfacePicker::Initialize()
{
  this->Superclass::Initialize();
  this->Isovalue = vtkMath::Nan();
}

int vtkIsosurfacePicker::Pick(double x, double y, double vtkNotUsed(z), vtkRenderer* renderer)
{
  this->Initialize();
  this->Renderer = renderer;
  this->SelectionPoint[0] = x;
  this->SelectionPoint[1] = y;
  this->SelectionPoint[2] = 0.0;
  this->InvokeEvent(vtkCommand::StartPickEvent, nullptr);

  double nearest =
    renderer->GetZ(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y))) +
    DepthTolerance;
  vtkPropCollection* props = this->PickFromList ? this->PickList : renderer->GetViewProps();
  vtkCollectionSimpleIterator iterator;
  props->InitTraversal(iterator);
  for (vtkProp* prop = props->GetNextProp(iterator); prop; prop = props->GetNextProp(iterator))
  {
    if (!prop->GetVisibility() || !prop->GetPickable() || !renderer->HasViewProp(prop))
    {
      continue;
    }
    prop->InitPathTraversal();
    for (vtkAssemblyPath* path = prop->GetNextPath(); path; path = prop->GetNextPath())
    {
      this->PickIfNearer(path, nearest);
    }
  }
  if (this->Path)
  {
    this->Path->GetFirstNode()->GetViewProp()->Pick();
    this->InvokeEvent(vtkCommand::PickEvent, nullptr);
  }
  this->InvokeEvent(vtkCommand::EndPickEvent, nullptr);
  return this->Path ? 1 : 0;
}

void vtkIsosurfacePicker::PickIfNearer(vtkAssemblyPath* path, double& nearest)
{
  auto* volume = vtkVolume::SafeDownCast(path->GetLastNode()->GetViewProp());
  auto* mapper =
    volume ? vtkProgressiveIsosurfaceMapper::SafeDownCast(volume->GetMapper()) : nullptr;
  int size[2], origin[2];
  this->Renderer->GetTiledSizeAndOrigin(&size[0], &size[1], &origin[0], &origin[1]);
  const int x = static_cast<int>(std::floor(this->SelectionPoint[0])) - origin[0];
  const int y = static_cast<int>(std::floor(this->SelectionPoint[1])) - origin[1];
  double position[3], isovalue;
  if (!mapper || !mapper->WasRenderedIn(this->Renderer) ||
    !mapper->GetHit(x, y, position, isovalue))
  {
    return;
  }
  const double depth = WindowDepth(this->Renderer, position);
  if (depth < nearest)
  {
    nearest = depth;
    this->SetPath(path);
    std::copy(position, position + 3, this->PickPosition);
    this->Isovalue = isovalue;
  }
}
