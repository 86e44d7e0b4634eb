// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceColors.h"

#include "ImageBlocks.h"

#include "vtkColorTransferFunction.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkInformation.h"
#include "vtkPiecewiseFunction.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

//------------------------------------------------------------------------------
SurfaceColors::SurfaceColors() = default;

//------------------------------------------------------------------------------
SurfaceColors::~SurfaceColors() = default;

//------------------------------------------------------------------------------
void SurfaceColors::SetSolid(double red, double green, double blue)
{
  // one node gives every isovalue the same colour
  this->Solid->RemoveAllPoints();
  this->Solid->AddRGBPoint(0.0, red, green, blue);
}

//------------------------------------------------------------------------------
void SurfaceColors::SetMap(vtkColorTransferFunction* map)
{
  this->Map = map;
}

//------------------------------------------------------------------------------
ArrayName SurfaceColors::GetArray(vtkInformation* chosen) const
{
  const bool has = this->Map && chosen && chosen->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    chosen->Has(vtkDataObject::FIELD_NAME()) && chosen->Get(vtkDataObject::FIELD_NAME());
  return has ? ArrayName{ chosen->Get(vtkDataObject::FIELD_ASSOCIATION()),
    chosen->Get(vtkDataObject::FIELD_NAME()) }
             : ArrayName();
}

//------------------------------------------------------------------------------
std::string SurfaceColors::FindArrayOfBlocks(const Scene& scene, const ImageBlocks::Found& blocks)
{
  const ArrayName& array = scene.Drawn.Get();
  const ImageBlocks::Arrays drawn = { array.Association, array.Name, "" };
  ImageBlocks::Arrays arrays = drawn;
  arrays.Color = scene.Color.Association == array.Association ? scene.Color.Name : "";
  const bool everywhere = std::all_of(blocks.Blocks.begin(), blocks.Blocks.end(),
    [&](const ImageBlocks::Block& block)
    {
      return ImageBlocks::HasArrays(block.Grid, arrays) ||
        !ImageBlocks::HasArrays(block.Grid, drawn);
    });
  return everywhere ? arrays.Color : "";
}

//------------------------------------------------------------------------------
int SurfaceColors::GetComponent(const Scene& scene) const
{
  vtkDataArray* array = scene.Drawn.FindBeside(scene.Data, scene.Color.Name);
  if (!array || array->GetNumberOfComponents() == 1)
  {
    return 0;
  }
  return this->Map->GetVectorMode() == vtkScalarsToColors::MAGNITUDE
    ? DrawnArray::Magnitude
    : std::max(this->Map->GetVectorComponent(), 0);
}

//------------------------------------------------------------------------------
// By the array and its component.
bool SurfaceColors::IsByDrawnArray(const Scene& scene) const
{
  const ArrayName& drawn = scene.Drawn.Get();
  if (scene.Color.Name.empty() || scene.Color.Association != drawn.Association ||
    scene.Color.Name != drawn.Name)
  {
    return false;
  }
  // a compressed volume has one component
  vtkDataArray* array = scene.Drawn.FindBeside(scene.Data, scene.Color.Name);
  return !array || array->GetNumberOfComponents() == 1 ||
    this->GetComponent(scene) == scene.Drawn.GetComponent(scene.Data);
}

//------------------------------------------------------------------------------
bool SurfaceColors::IsByOtherArray(const Scene& scene) const
{
  return scene.Color.Association == scene.Drawn.Get().Association && !this->IsByDrawnArray(scene) &&
    scene.Drawn.FindBeside(scene.Data, scene.Color.Name);
}

//------------------------------------------------------------------------------
void SurfaceColors::UpdateMapper(vtkProgressiveIsosurfaceMapper* mapper, const Scene& scene) const
{
  const bool byOther = this->IsByOtherArray(scene);
  mapper->SetColorArrayName(byOther ? scene.Color.Name.c_str() : nullptr);
  mapper->SetColorComponent(byOther ? this->GetComponent(scene) : 0);
  mapper->SetColorLookupTable(byOther ? this->Map.Get() : nullptr);
}

//------------------------------------------------------------------------------
void SurfaceColors::UpdateProperty(vtkVolumeProperty* property, const Scene& scene)
{
  const bool mapped = this->IsByDrawnArray(scene);
  property->SetColor(mapped ? this->Map.Get() : this->Solid.Get());
  auto* map = vtkDiscretizableColorTransferFunction::SafeDownCast(this->Map);
  vtkPiecewiseFunction* mapOpacities =
    mapped && map && map->GetEnableOpacityMapping() ? map->GetScalarOpacityFunction() : nullptr;
  vtkContourValues* values = property->GetIsoSurfaceValues();
  vtkNew<vtkPiecewiseFunction> wanted;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double value = values->GetValue(i);
    wanted->AddPoint(value, this->Opacity * (mapOpacities ? mapOpacities->GetValue(value) : 1.0));
  }
  const int nodes = wanted->GetSize();
  if (nodes != this->Opacities->GetSize() ||
    !std::equal(wanted->GetDataPointer(), wanted->GetDataPointer() + 2 * nodes,
      this->Opacities->GetDataPointer()))
  {
    this->Opacities->DeepCopy(wanted);
  }
}

//------------------------------------------------------------------------------
std::string SurfaceColors::DescribeLoss(const Scene& scene, bool draws)
{
  const bool lost = draws && !this->IsByOtherArray(scene) && !this->IsByDrawnArray(scene);
  const bool points = scene.Drawn.Get().Association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const bool ofOthers = points ? scene.Color.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS
                               : scene.Color.Association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const std::string name = lost && ofOthers ? scene.Color.Name : "";
  const bool again = name == this->Lost;
  this->Lost = name;
  if (again || name.empty())
  {
    return "";
  }
  const std::string filter = points ? "Cell Data to Point Data" : "Point Data to Cell Data";
  return std::string("the surface of ") + (points ? "point" : "cell") +
    " data has its solid colour: the array \"" + name + "\" belongs to " +
    (points ? "cells" : "points") + "; use the filter " + filter + " to colour by it";
}
