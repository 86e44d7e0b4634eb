// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// When a prop draws its isosurfaces. A renderer asks every prop in each pass of a render: opaque
// surfaces have their turn in the opaque pass, translucent ones with the volumes, or with the
// overlays where the depths of volumes are peeled, which the mapper cannot do.
#ifndef IsosurfaceTurns_h
#define IsosurfaceTurns_h

#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkVolume.h"

class IsosurfaceTurns
{
public:
  ///@{ Whether the prop draws now, when the renderer asks it for this geometry. `mapper`, which may
  /// be null, has the settings.
  static bool IsOpaqueTurn(vtkVolume* prop, vtkProgressiveIsosurfaceMapper* mapper)
  {
    return !IsTranslucent(prop, mapper);
  }

  bool IsVolumetricTurn(vtkVolume* prop, vtkProgressiveIsosurfaceMapper* mapper)
  {
    if (!IsTranslucent(prop, mapper))
    {
      return false;
    }
    this->DrawsWithOverlays = vtkProgressiveIsosurfaceMapper::IsPeeled(prop);
    return !this->DrawsWithOverlays;
  }

  bool IsOverlayTurn()
  {
    const bool draws = this->DrawsWithOverlays;
    this->DrawsWithOverlays = false;
    return draws;
  }
  ///@}

private:
  static bool IsTranslucent(vtkVolume* prop, vtkProgressiveIsosurfaceMapper* mapper)
  {
    return mapper ? mapper->DrawsTranslucent(prop->GetProperty())
                  : vtkProgressiveIsosurfaceMapper::IsTranslucent(prop->GetProperty());
  }

  bool DrawsWithOverlays = false; ///< in the present render
};

#endif
