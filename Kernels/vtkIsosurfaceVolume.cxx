// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceVolume.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
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

vtkProgressiveIsosurfaceMapper* vtkIsosurfaceVolume::FindMapper()
{
  return vtkProgressiveIsosurfaceMapper::SafeDownCast(this->Mapper);
}

int vtkIsosurfaceVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  this->InvokeEvent(vtkCommand::StartEvent);
  return IsosurfaceTurns::IsOpaqueTurn(this, this->FindMapper()) ? this->Draw(viewport) : 0;
}

int vtkIsosurfaceVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  return this->Turns.IsVolumetricTurn(this, this->FindMapper()) ? this->Draw(viewport) : 0;
}

int vtkIsosurfaceVolume::RenderOverlay(vtkViewport* viewport)
{
  return this->Turns.IsOverlayTurn() ? this->Draw(viewport) : 0;
}
