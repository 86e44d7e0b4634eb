// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkIsosurfacePicker
 * @brief   picks the isosurface that shows at a pixel
 *
 * Pick() looks the pixel up in the last picture of every vtkProgressiveIsosurfaceMapper in the
 * renderer and picks the nearest surface that no opaque geometry hides: exactly where the ray met
 * it, without another render. Of translucent isosurfaces that is the first that the ray met.
 *
 * Volumes count that are visible and pickable, in assemblies too, or those of the pick list where
 * PickFromList is on. What is no isosurface is never picked; opaque, it hides what is behind it. A
 * mapper that several renderers share knows the picture of the one that was rendered last.
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
   * Pick at a place of the window, in pixels from the bottom left; z does not matter. Returns 1
   * where an isosurface was picked, or else 0. GetPickPosition() tells where, GetVolume() which
   * volume's.
   */
  using vtkAbstractPropPicker::Pick;
  int Pick(double x, double y, double z, vtkRenderer* renderer) override;

  /**
   * Isovalue of the surface that was picked last; not a number where none was.
   */
  vtkGetMacro(Isovalue, double);

protected:
  vtkIsosurfacePicker();
  ~vtkIsosurfacePicker() override = default;
  void Initialize() override;

private:
  vtkIsosurfacePicker(const vtkIsosurfacePicker&) = delete;
  void operator=(const vtkIsosurfacePicker&) = delete;

  void Consider(vtkAssemblyPath* path, double& nearest);

  double Isovalue;
};

#endif
