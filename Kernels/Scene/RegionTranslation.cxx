// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/RegionTranslation.h"

#include "vtkCompressedVolume.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"

#include <algorithm>

namespace
{
// Samples of cells lie in the middle of them.
double SampleShift(vtkCompressedVolume* volume)
{
  return volume->GetAssociation() == vtkCompressedVolume::CellData ? 0.5 : 0.0;
}
}

void FindIndexToWorld(
  vtkVolume* prop, vtkImageData* image, vtkCompressedVolume* volume, vtkMatrix4x4* matrix)
{
  const double shift = SampleShift(volume);
  const int* extent = volume->GetExtent();
  vtkNew<vtkMatrix4x4> offset;
  for (int axis = 0; axis < 3; ++axis)
  {
    offset->SetElement(axis, 3, extent[2 * axis] + shift);
  }
  vtkMatrix4x4::Multiply4x4(image->GetIndexToPhysicalMatrix(), offset, matrix);
  vtkMatrix4x4::Multiply4x4(prop->GetMatrix(), matrix, matrix);
}

void TranslateExtent(vtkImageData* image, vtkCompressedVolume* volume, ViewGeometry& view)
{
  const int* drawn = image->GetExtent();
  const int* samples = volume->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    view.FirstDrawn[axis] = drawn[2 * axis] - samples[2 * axis];
    // a piece with cell data is drawn up to the first samples of the next piece
    view.LastDrawn[axis] =
      std::min(drawn[2 * axis + 1] - samples[2 * axis], volume->GetDimensions()[axis] - 1);
  }
}

void TranslateClipping(vtkPlaneCollection* planes, vtkMatrix4x4* worldToIndex, ViewGeometry& view)
{
  vtkNew<vtkMatrix4x4> indexToWorld;
  vtkMatrix4x4::Invert(worldToIndex, indexToWorld);
  const int count = planes ? planes->GetNumberOfItems() : 0;
  for (int i = 0; i < count && i < glsl::MAX_CLIPPING_PLANES; ++i)
  {
    vtkPlane* plane = planes->GetItem(i);
    double normal[3], origin[3];
    plane->GetNormal(normal);
    plane->GetOrigin(origin);
    double terms[4] = { normal[0], normal[1], normal[2], -vtkMath::Dot(normal, origin) };
    double translated[4] = {};
    for (int axis = 0; axis < 4; ++axis)
    {
      for (int row = 0; row < 4; ++row)
      {
        translated[axis] += terms[row] * indexToWorld->GetElement(row, axis);
      }
    }
    ClippingPlane& translatedPlane = view.ClippingPlanes[view.NumberOfClippingPlanes++];
    std::copy(translated, translated + 3, translatedPlane.Normal);
    translatedPlane.Offset = translated[3];
  }
}

void TranslateCropping(
  vtkVolumeMapper* mapper, vtkImageData* image, vtkCompressedVolume* volume, ViewGeometry& view)
{
  view.DrawnRegions = glsl::ALL_REGIONS;
  if (!mapper->GetCropping())
  {
    return;
  }
  const double shift = SampleShift(volume);
  const double* planes = mapper->GetCroppingRegionPlanes();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = volume->GetExtent()[2 * axis] + shift;
    const double origin = image->GetOrigin()[axis], spacing = image->GetSpacing()[axis];
    const double low = (planes[2 * axis] - origin) / spacing - first;
    const double high = (planes[2 * axis + 1] - origin) / spacing - first;
    view.CroppingLow[axis] = std::min(low, high);
    view.CroppingHigh[axis] = std::max(low, high);
  }
  view.DrawnRegions = mapper->GetCroppingRegionFlags() & glsl::ALL_REGIONS;
}
