// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Extents of an image that several processes share (internal). Each process has one piece, with
// layers of ghost cells that belong to its neighbours.
#ifndef PieceExtents_h
#define PieceExtents_h

#include "vtkProgIsoFiltersModule.h" // for export macro

class vtkImageData;
class vtkInformation;

namespace PieceExtents
{
/// Whether an extent holds no point.
inline bool IsEmpty(const int extent[6])
{
  return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
}

/// Whether one extent lies within another.
inline bool Contains(const int outer[6], const int inner[6])
{
  return outer[0] <= inner[0] && inner[1] <= outer[1] && outer[2] <= inner[2] &&
    inner[3] <= outer[3] && outer[4] <= inner[4] && inner[5] <= outer[5];
}

/// Whether an algorithm's input is empty because other processes have all pieces of the image.
VTKPROGISOFILTERS_EXPORT bool IsEmptyPiece(vtkInformation* input);

/// Finds the extent of an image without its ghost cells, see vtkCompressedVolume::GetOwnExtent().
VTKPROGISOFILTERS_EXPORT void GetExtentWithoutGhosts(vtkImageData* image, int extent[6]);

/// Finds the extent that a stream should cover, see vtkCompressedVolume::GetCoveringExtent().
VTKPROGISOFILTERS_EXPORT void GetCoveringExtent(
  const int piece[6], const int whole[6], bool cellData, int covering[6]);
}

#endif
