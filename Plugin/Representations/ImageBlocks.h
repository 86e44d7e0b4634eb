// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The images of a composite data set, and of grids that are as good as images.
#ifndef ImageBlocks_h
#define ImageBlocks_h

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkDataArray;
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

/// A part of a data set.
struct Block
{
  vtkSmartPointer<vtkDataSet> Grid; ///< an image or a rectilinear grid, with points
  unsigned int CompositeIndex;      ///< flat index in the composite data set; 0: it is the whole
};

/// What a data set consists of.
struct Found
{
  std::vector<Block> Blocks;
  int NumberOfOthers = 0; ///< that cannot be drawn
};

/// The image, or where its active scalars have no name, by which ParaView knows arrays, a copy in
/// which they have one.
vtkSmartPointer<vtkImageData> WithNamedScalars(vtkImageData* image);

/// Finds the blocks of a composite data set, or the one block that a rectilinear grid is. Cells of
/// overlapping AMR that a finer block refines are hidden.
Found Find(vtkDataObject* input);

/// Finds the array of a block that is drawn if none is chosen, and its association; null: it has
/// none.
vtkDataArray* FindDefaultArray(vtkDataSet* block, int& association);

/// Whether a block has the arrays. A compressed volume has what it draws.
bool HasArrays(vtkDataSet* block, const Arrays& arrays);

/// Makes the image of a block, with those arrays alone, its index and what hides cells. Cell data
/// become point data, as for ParaView's Contour: so the surfaces of neighbouring blocks meet. Null
/// if it is a rectilinear grid of uneven steps and these are not to be resampled.
vtkSmartPointer<vtkImageData> MakeImage(
  const Block& block, const Arrays& arrays, bool resamplesUnevenGrids);

/// The index that an image was made with; 0: it has none.
unsigned int GetCompositeIndex(vtkImageData* image);
}

#endif
