// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceVolume.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"

vtkStandardNewMacro(vtkIsosurfaceVolume);

void vtkIsosurfaceVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkIsosurfaceVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  this->InvokeEvent(vtkCommand::StartEvent);
  return vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty())
    ? 0
    : this->Superclass::RenderVolumetricGeometry(viewport);
}

int vtkIsosurfaceVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  if (!vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty()))
  {
    return 0;
  }
  if (vtkProgressiveIsosurfaceMapper::IsPeeled(this))
  {
    this->DrawnWithOverlays = true;
    return 0;
  }
  return this->Superclass::RenderVolumetricGeometry(viewport);
}

int vtkIsosurfaceVolume::RenderOverlay(vtkViewport* viewport)
{
  const bool draws = this->DrawnWithOverlays;
  this->DrawnWithOverlays = false;
  return draws ? this->Superclass::RenderVolumetricGeometry(viewport) : 0;
}
