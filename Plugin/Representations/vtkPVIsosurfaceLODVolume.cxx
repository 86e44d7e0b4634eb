// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVIsosurfaceLODVolume.h"

#include "vtkLODProp3D.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkVolumeProperty.h"

vtkStandardNewMacro(vtkPVIsosurfaceLODVolume);

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  if (this->ShowsOutline())
  {
    return this->Superclass::RenderOpaqueGeometry(viewport);
  }
  return this->IsTranslucent() ? 0 : this->RenderIsosurfaces(viewport);
}

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  return !this->ShowsOutline() && this->IsTranslucent() ? this->RenderIsosurfaces(viewport) : 0;
}

//------------------------------------------------------------------------------
bool vtkPVIsosurfaceLODVolume::IsTranslucent()
{
  return vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty());
}

//------------------------------------------------------------------------------
bool vtkPVIsosurfaceLODVolume::ShowsOutline()
{
  return this->SelectLOD() != this->HighLODId;
}

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderIsosurfaces(vtkViewport* viewport)
{
  const int drawn = this->LODProp->RenderVolumetricGeometry(viewport);
  this->EstimatedRenderTime = this->LODProp->GetEstimatedRenderTime();
  return drawn;
}
