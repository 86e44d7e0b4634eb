// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsosurfaceVolume
 * @brief   a vtkVolume that is drawn with the opaque geometry where its isosurfaces are opaque
 *
 * An opaque isosurface belongs in the renderer's opaque pass: drawn with the volumes, after the
 * translucent geometry, it would overwrite what is translucent in front of it. This prop draws its
 * mapper in the opaque pass, or with the volumes where its property makes one of the isosurfaces
 * translucent, and is otherwise a vtkVolume.
 *
 * A translucent isosurface is drawn over translucent geometry, also where the renderer peels depths
 * of volumes (vtkRenderer::UseDepthPeelingForVolumes): its layers are not parted by such geometry.
 *
 * Events: vtkCommand::StartEvent in every render, before the property is looked at: the time to
 * make the transfer functions follow isovalues.
 *
 * @sa vtkProgressiveIsosurfaceMapper
 */
#ifndef vtkIsosurfaceVolume_h
#define vtkIsosurfaceVolume_h

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
   * One of them draws the mapper; the last where depths of volumes are peeled, after that. Return
   * whether anything was drawn.
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

  bool DrawnWithOverlays = false; // the next time

  vtkIsosurfaceVolume(const vtkIsosurfaceVolume&) = delete;
  void operator=(const vtkIsosurfaceVolume&) = delete;
};

#endif
