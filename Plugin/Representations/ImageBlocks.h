// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The images of a composite data set, and of grids that are as good as images.
#ifndef ImageBlocks_h
#define ImageBlocks_h

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;
class vtkImageData;

namespace ImageBlocks
{
/// The arrays of a block that matter: the one that is drawn, and the one that gives the colours
/// (empty: none). Both belong to points, or both to cells.
struct Arrays
{
  int Association = 0;
  std::string Drawn;
  std::string Color;
};

/// What a data set consists of.
struct Found
{
  std::vector<vtkSmartPointer<vtkDataSet>> Grids; ///< images and rectilinear grids, with points
  int NumberOfOthers = 0;                         ///< that cannot be drawn
};

/// Finds the blocks of a composite data set, or the one block that a rectilinear grid is. Cells of
/// overlapping AMR that a finer block refines are hidden.
Found Find(vtkDataObject* input);

/// Whether a block has the arrays. A compressed volume has what it draws.
bool HasArrays(vtkDataSet* block, const Arrays& arrays);

/// Makes the image of a block, with those arrays alone and what hides cells. Cell data become point
/// data, as for ParaView's Contour: so the surfaces of neighbouring blocks meet. Null if it is a
/// rectilinear grid of uneven steps and these are not to be resampled.
vtkSmartPointer<vtkImageData> MakeImage(
  vtkDataSet* block, const Arrays& arrays, bool resamplesUnevenGrids);
}

#endif
