// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// One image of the pieces that all processes have.
#ifndef GatheredImage_h
#define GatheredImage_h

#include "Status.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkImageData;

namespace GatheredImage
{
using Images = std::vector<vtkSmartPointer<vtkImageData>>;

/// Brings the images of all processes to process 0; the others get none. Each process may have
/// several, or none. All processes have to call it.
Images Gather(const Images& here);

/// Puts one array of pieces into an image, which gets their place. Ghost cells of a piece do not
/// count, points and cells that a piece hides stay hidden. An error, one sentence, if pieces do not
/// fill a box of one grid, or an array is missing or not of one kind. No pieces are no error.
Status Assemble(
  const Images& pieces, const std::string& array, int association, vtkImageData* whole);
}

#endif
