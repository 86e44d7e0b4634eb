// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Rectilinear grids as images.
#ifndef RectilinearImage_h
#define RectilinearImage_h

#include "vtkSmartPointer.h"

class vtkImageData;
class vtkRectilinearGrid;

namespace RectilinearImage
{
/// Whether the coordinates are evenly spaced on every axis, as an image's.
bool IsEven(vtkRectilinearGrid* grid);

/// The image that an evenly spaced grid is, with the same arrays.
vtkSmartPointer<vtkImageData> Convert(vtkRectilinearGrid* grid);

/// Interpolates the grid's point arrays between its first and last coordinates, on each axis with
/// steps as long as its shortest one, but at most `Refinement` times as many as it has.
vtkSmartPointer<vtkImageData> Resample(vtkRectilinearGrid* grid);
constexpr int Refinement = 4;
}

#endif
