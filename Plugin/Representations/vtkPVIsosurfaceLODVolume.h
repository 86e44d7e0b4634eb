// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVIsosurfaceLODVolume
 * @brief   draws opaque isosurfaces in the opaque pass, translucent ones with the volumes
 *
 * Does for ParaView what vtkIsosurfaceVolume does. ParaView's own class always draws with the
 * volumes, and only if the input has scalars, which a compressed volume has not.
 */
#ifndef vtkPVIsosurfaceLODVolume_h
#define vtkPVIsosurfaceLODVolume_h

#include "IsosurfaceTurns.h" // for ivar
#include "vtkPVLODVolume.h"

class vtkPVIsosurfaceLODVolume : public vtkPVLODVolume
{
public:
  static vtkPVIsosurfaceLODVolume* New();
  vtkTypeMacro(vtkPVIsosurfaceLODVolume, vtkPVLODVolume);

  int RenderOpaqueGeometry(vtkViewport* viewport) override;
  int RenderVolumetricGeometry(vtkViewport* viewport) override;
  int RenderOverlay(vtkViewport* viewport) override;

  ///@{
  /// Only those ask for actors and volumes who export a scene: warns, once an image, that they get
  /// none.
  void GetActors(vtkPropCollection* actors) override;
  void GetVolumes(vtkPropCollection* volumes) override;
  ///@}

protected:
  vtkPVIsosurfaceLODVolume() = default;
  ~vtkPVIsosurfaceLODVolume() override = default;

private:
  /// True on processes without data: they show the outline.
  bool ShowsOutline();
  vtkProgressiveIsosurfaceMapper* FindSettings();
  int RenderIsosurfaces(vtkViewport* viewport);
  void WarnOfExport();

  IsosurfaceTurns Turns;
  bool WarnedOfExport = false; ///< since the last image

  vtkPVIsosurfaceLODVolume(const vtkPVIsosurfaceLODVolume&) = delete;
  void operator=(const vtkPVIsosurfaceLODVolume&) = delete;
};

#endif
