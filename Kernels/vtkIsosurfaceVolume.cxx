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
  return vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty())
    ? this->Superclass::RenderVolumetricGeometry(viewport)
    : 0;
}
