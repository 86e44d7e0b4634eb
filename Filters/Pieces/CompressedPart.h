// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   CompressedPart
 * @brief   the part of an image, or of a process' piece of one, that is compressed (internal)
 *
 * All extents are the image's.
 */
#ifndef CompressedPart_h
#define CompressedPart_h

#include "vtkBlockMask.h"
#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkImageData;
class vtkInformation;
class vtkUnsignedCharArray;

struct CompressedPart
{
  CompressedPart(vtkImageData* input, vtkInformation* information, bool cellData);

  bool CellData;
  int Input[6];         ///< extent of the input, with ghost cells
  int WithoutGhosts[6]; ///< the same without
  int Covered[6];       ///< extent that the stream covers
  int Size[3];          ///< samples in the stream, per axis

  /// Returns the samples of an input's array that the stream covers.
  vtkSmartPointer<vtkDataArray> CutSamples(vtkDataArray* array) const;

  /// Returns the hiding flags of the stream's samples, or null if none is hidden.
  vtkSmartPointer<vtkUnsignedCharArray> FindHiddenSamples(vtkImageData* input) const;

  /// Returns the mask of the hidden cells between point data; empty for cell data.
  vtkBlockMask FindHiddenCells(vtkImageData* input) const;

private:
  vtkSmartPointer<vtkDataArray> Cut(vtkDataArray* array, bool cellData) const;
};

#endif
