// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The pieces of an image that several processes share: what each of them draws.
#ifndef DistributedPieces_h
#define DistributedPieces_h

#include "vtkSmartPointer.h"

class vtkImageData;

namespace DistributedPieces
{
int GetNumberOfProcesses();

/// Whether `here` is true on any process. All processes have to call it.
bool IsTrueAnywhere(bool here);

/// Finds the bounds around those of all processes. All processes have to call it.
void FindWholeBounds(const double mine[6], double whole[6]);

/// Copies an image without its ghost cells and arrays, which a compressed volume has none of.
vtkSmartPointer<vtkImageData> WithoutGhosts(vtkImageData* image);

/// Cuts the stream of a compressed volume down to what this process's piece needs. A process that
/// cannot draw gets the geometry of its piece alone.
vtkSmartPointer<vtkImageData> MakeCompressedPiece(vtkImageData* image, bool canDraw);

/// Makes this process's piece of a plain image, with the samples around it that normals need, in
/// whole blocks of the whole image. `cellData`: whether it holds cell arrays. All processes have to
/// call it: where ghost levels are missing, they exchange samples.
vtkSmartPointer<vtkImageData> MakePlainPiece(vtkImageData* image, bool cellData);
}

#endif
