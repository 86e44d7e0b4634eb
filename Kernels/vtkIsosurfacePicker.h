// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsosurfacePicker
 * @brief   picks the isosurface that shows at a pixel
 *
 * Pick() looks the pixel up in the last image of every vtkProgressiveIsosurfaceMapper in the
 * renderer, and picks the nearest surface that no opaque geometry hides. The position is exactly
 * where the ray hit the surface, and nothing is rendered again. Of several translucent isosurfaces
 * the first along the ray is picked.
 *
 * All visible and pickable volumes take part, also those in assemblies; with PickFromList only
 * those of the pick list. Other props are never picked, but opaque ones hide what is behind them. A
 * mapper that several renderers share knows only the image of the renderer that was rendered last.
 *
 * @sa vtkProgressiveIsosurfaceMapper vtkPropPicker vtkCellPicker
 */
#ifndef vtkIsosurfacePicker_h
#define vtkIsosurfacePicker_h

#include "vtkAbstractPropPicker.h"
#include "vtkProgIsoKernelsModule.h" // for export macro

class vtkAssemblyPath;

class VTKPROGISOKERNELS_EXPORT vtkIsosurfacePicker : public vtkAbstractPropPicker
{
public:
  static vtkIsosurfacePicker* New();
  vtkTypeMacro(vtkIsosurfacePicker, vtkAbstractPropPicker);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Picks at a place of the window, in pixels from the bottom left; z is ignored. Returns 1 if an
   * isosurface was picked, otherwise 0. GetPickPosition() returns where, GetVolume() which
   * volume's.
   */
  using vtkAbstractPropPicker::Pick;
  int Pick(double x, double y, double z, vtkRenderer* renderer) override;

  /**
   * Isovalue of the surface that was picked last; NaN if none was.
   */
  vtkGetMacro(Isovalue, double);

protected:
  vtkIsosurfacePicker();
  ~vtkIsosurfacePicker() override = default;
  void Initialize() override;

private:
  vtkIsosurfacePicker(const vtkIsosurfacePicker&) = delete;
  void operator=(const vtkIsosurfacePicker&) = delete;

  /// Picks the path if its isosurface is nearer than `nearest`, a depth in the window.
  void PickIfNearer(vtkAssemblyPath* path, double& nearest);

  double Isovalue;
};

#endif
