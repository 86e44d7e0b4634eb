// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   SampleGrid
 * @brief   where the samples of an image lie in space (internal)
 *
 * A compressed volume's stream travels through filters as field data, also through those that
 * resample an image or move it. The grid that the stream was made for tells whether an image still
 * has the samples of the stream, perhaps by other indices.
 */
#ifndef SampleGrid_h
#define SampleGrid_h

#include "Status.h"

#include "vtkProgIsoFiltersModule.h" // for export macro

class vtkImageData;

struct VTKPROGISOFILTERS_EXPORT SampleGrid
{
  static constexpr int Size = 15;

  /// Spacing, origin and direction matrix (row by row).
  double Values[Size] = { 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };

  static SampleGrid Of(vtkImageData* image);

  /// Whether all is finite, no spacing is 0, and the direction matrix can be inverted.
  bool IsRegular() const;

  /// Finds what to add to an index of an image to get the index in this grid of the sample at the
  /// same place. An error, the end of a sentence, where the image's samples lie between this
  /// grid's. Files round a little. Grids that are not regular are not compared.
  Status FindShift(vtkImageData* image, int shift[3]) const;
};

#endif
