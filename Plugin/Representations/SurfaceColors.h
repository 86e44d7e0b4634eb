// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The colours and opacities of the isosurfaces. Coloured by the array that is drawn, a surface has
// the colour map's colour at its isovalue; by another array of the same association, that array's
// colours; otherwise the solid colour.
#ifndef SurfaceColors_h
#define SurfaceColors_h

#include "DrawnArray.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

class vtkColorTransferFunction;
class vtkInformation;
class vtkPiecewiseFunction;
class vtkProgressiveIsosurfaceMapper;
class vtkVolumeProperty;

class SurfaceColors
{
public:
  SurfaceColors();
  ~SurfaceColors();
  SurfaceColors(const SurfaceColors&) = delete;
  void operator=(const SurfaceColors&) = delete;

  /// What is drawn, and the array that was chosen to colour by.
  struct Scene
  {
    const DrawnArray& Drawn;
    vtkDataObject* Data;
    ArrayName Color;
  };

  void SetSolid(double red, double green, double blue);
  void SetOpacity(double opacity) { this->Opacity = opacity; }
  void SetMap(vtkColorTransferFunction* map);

  /// The array that was chosen to colour by, of ParaView's information of it; without a name: none,
  /// or there is no map.
  ArrayName GetArray(vtkInformation* chosen) const;
  /// The array to colour blocks by; empty if not all of them have it.
  static std::string FindArrayOfBlocks(const Scene& scene, const ImageBlocks::Found& blocks);

  /// Sets the array that gives the colours, and their map.
  void UpdateMapper(vtkProgressiveIsosurfaceMapper* mapper, const Scene& scene) const;
  /// The opacities of the property: a function with one node for each isovalue.
  vtkPiecewiseFunction* GetOpacities() const { return this->Opacities; }
  /// Sets the property's colours, and its opacities.
  void UpdateProperty(vtkVolumeProperty* property, const Scene& scene);

  /// Says once that the surface cannot be coloured by an array, and why; otherwise empty. `draws`:
  /// whether there is a surface.
  std::string DescribeLoss(const Scene& scene, bool draws);

private:
  bool IsByDrawnArray(const Scene& scene) const;
  bool IsByOtherArray(const Scene& scene) const;
  int GetComponent(const Scene& scene) const;

  vtkSmartPointer<vtkColorTransferFunction> Map;
  vtkNew<vtkColorTransferFunction> Solid;
  double Opacity = 1.0;
  vtkNew<vtkPiecewiseFunction> Opacities;
  std::string Lost; ///< the array that DescribeLoss() has told of
};

#endif
