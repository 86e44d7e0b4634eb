// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceVolume.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkIsosurfaceVolume);

void vtkIsosurfaceVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

int vtkIsosurfaceVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  return this->Superclass::RenderVolumetricGeometry(viewport);
}

int vtkIsosurfaceVolume::RenderVolumetricGeometry(vtkViewport* vtkNotUsed(viewport))
{
  return 0;
}
