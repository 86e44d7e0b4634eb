// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsosurfaceVolume
 * @brief   a vtkVolume that draws opaque isosurfaces in the opaque pass
 *
 * An opaque isosurface belongs in the renderer's opaque pass: if it were drawn with the volumes,
 * after the translucent geometry, it would overwrite translucent geometry in front of it. This prop
 * draws its mapper in the opaque pass, or with the volumes if its property makes one of the
 * isosurfaces translucent. Otherwise it is a vtkVolume.
 *
 * Translucent isosurfaces are drawn over translucent geometry, also if the renderer peels the
 * depths of volumes (vtkRenderer::UseDepthPeelingForVolumes): such geometry is not sorted between
 * their layers.
 *
 * Events: vtkCommand::StartEvent in every render, before the property is read, so that observers
 * can adapt the transfer functions to the isovalues.
 *
 * @sa vtkProgressiveIsosurfaceMapper
 */
#ifndef vtkIsosurfaceVolume_h
#define vtkIsosurfaceVolume_h

#include "IsosurfaceTurns.h"         // for ivar
#include "vtkProgIsoKernelsModule.h" // for export macro
#include "vtkVolume.h"

class VTKPROGISOKERNELS_EXPORT vtkIsosurfaceVolume : public vtkVolume
{
public:
  static vtkIsosurfaceVolume* New();
  vtkTypeMacro(vtkIsosurfaceVolume, vtkVolume);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Exactly one of them draws the mapper: the last one after the depths of volumes were peeled.
   * Return whether anything was drawn.
   */
  int RenderOpaqueGeometry(vtkViewport* viewport) override;
  int RenderVolumetricGeometry(vtkViewport* viewport) override;
  int RenderOverlay(vtkViewport* viewport) override;
  ///@}

protected:
  vtkIsosurfaceVolume() = default;
  ~vtkIsosurfaceVolume() override = default;

private:
  int Draw(vtkViewport* viewport);
  vtkProgressiveIsosurfaceMapper* FindMapper();

  IsosurfaceTurns Turns;

  vtkIsosurfaceVolume(const vtkIsosurfaceVolume&) = delete;
  void operator=(const vtkIsosurfaceVolume&) = delete;
};

#endif
