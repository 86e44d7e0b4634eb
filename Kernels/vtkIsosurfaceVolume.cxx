// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceVolume.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkIsosurfaceVolume);

void vtkIsosurfaceVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// Repeats vtkVolume's method, which would read from its mapper even if an observer has removed it.
int vtkIsosurfaceVolume::Draw(vtkViewport* viewport)
{
  const vtkSmartPointer<vtkIsosurfaceVolume> alive = this;
  const vtkSmartPointer<vtkAbstractVolumeMapper> mapper = this->Mapper;
  if (!mapper || !mapper->GetDataObjectInput())
  {
    return this->Superclass::RenderVolumetricGeometry(viewport);
  }
  this->Update();
  this->GetProperty();
  mapper->Render(static_cast<vtkRenderer*>(viewport), this);
  this->EstimatedRenderTime += mapper->GetTimeToDraw();
  return 1;
}

int vtkIsosurfaceVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  this->InvokeEvent(vtkCommand::StartEvent);
  return vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty()) ? 0
                                                                            : this->Draw(viewport);
}

int vtkIsosurfaceVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  if (!vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty()))
  {
    return 0;
  }
  if (vtkProgressiveIsosurfaceMapper::IsPeeled(this))
  {
    this->DrawsWithOverlays = true;
    return 0;
  }
  return this->Draw(viewport);
}

int vtkIsosurfaceVolume::RenderOverlay(vtkViewport* viewport)
{
  const bool draws = this->DrawsWithOverlays;
  this->DrawsWithOverlays = false;
  return draws ? this->Draw(viewport) : 0;
}
