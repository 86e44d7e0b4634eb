// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVIsosurfaceLODVolume.h"

#include "vtkIsosurfaceBlocksMapper.h"

#include "vtkLODProp3D.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVIsosurfaceLODVolume);

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  if (this->ShowsOutline())
  {
    return this->Superclass::RenderOpaqueGeometry(viewport);
  }
  return IsosurfaceTurns::IsOpaqueTurn(this, this->FindSettings())
    ? this->RenderIsosurfaces(viewport)
    : 0;
}

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderVolumetricGeometry(vtkViewport* viewport)
{
  return !this->ShowsOutline() && this->Turns.IsVolumetricTurn(this, this->FindSettings())
    ? this->RenderIsosurfaces(viewport)
    : 0;
}

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderOverlay(vtkViewport* viewport)
{
  return this->Turns.IsOverlayTurn() ? this->RenderIsosurfaces(viewport) : 0;
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceMapper* vtkPVIsosurfaceLODVolume::FindSettings()
{
  auto* blocks = vtkIsosurfaceBlocksMapper::SafeDownCast(this->GetMapper());
  return blocks ? blocks->GetSettings() : nullptr;
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceLODVolume::GetActors(vtkPropCollection* actors)
{
  this->WarnOfExport();
  this->Superclass::GetActors(actors);
}

//------------------------------------------------------------------------------
// Not this one: where an exporter takes volumes, the surface would become a box of its samples.
void vtkPVIsosurfaceLODVolume::GetVolumes(vtkPropCollection* vtkNotUsed(volumes))
{
  this->WarnOfExport();
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceLODVolume::WarnOfExport()
{
  if (this->GetVisibility() && !this->WarnedOfExport)
  {
    this->WarnedOfExport = true;
    vtkWarningMacro("Progressive Isosurface is no mesh: exports as X3D, glTF, VRML, POV or vtk.js "
                    "lack it; show a Contour, or a ZFP Contour of the compressed volume, in its "
                    "place.");
  }
}

//------------------------------------------------------------------------------
bool vtkPVIsosurfaceLODVolume::ShowsOutline()
{
  return this->SelectLOD() != this->HighLODId;
}

//------------------------------------------------------------------------------
int vtkPVIsosurfaceLODVolume::RenderIsosurfaces(vtkViewport* viewport)
{
  this->WarnedOfExport = false;
  const int drawn = this->LODProp->RenderVolumetricGeometry(viewport);
  this->EstimatedRenderTime = this->LODProp->GetEstimatedRenderTime();
  return drawn;
}
