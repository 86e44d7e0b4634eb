// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ghost flags that hide points and cells of an image (internal).
#ifndef HidingFlags_h
#define HidingFlags_h

#include "vtkBlockMask.h"
#include "vtkDataSetAttributes.h" // for the flags
#include "vtkSmartPointer.h"

class vtkImageData;
class vtkUnsignedCharArray;

namespace HidingFlags
{
// The same flags as for vtkImageData::IsPointVisible() and IsCellVisible().
constexpr unsigned char OfPoints = vtkDataSetAttributes::HIDDENPOINT;
constexpr unsigned char OfCells =
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

///@{
/// Returns an image's ghost array, or null if it hides nothing or does not fit the image.
vtkUnsignedCharArray* FindForPoints(vtkImageData* image);
vtkUnsignedCharArray* FindForCells(vtkImageData* image);
///@}

/// Returns flags that hide the cells of an image that have a hidden corner or are hidden
/// themselves. Either array may be null; null if both are.
vtkSmartPointer<vtkUnsignedCharArray> MergeIntoCells(
  vtkUnsignedCharArray* points, vtkUnsignedCharArray* cells, const int extent[6]);

/// Adds what an image's points, or cells, hide to a mask of a stream of so many blocks, which may
/// reach beyond the image. Both extents are of points.
vtkBlockMask AddToMask(const vtkBlockMask& mask, const int blocks[3], const int streamExtent[6],
  vtkUnsignedCharArray* flags, const int imageExtent[6], bool ofCells);

/// Returns the mask of the hidden cells between `size` samples per axis.
vtkBlockMask MakeCellMask(vtkUnsignedCharArray* cells, const int size[3]);
}

#endif
