// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the samples of a level of detail lie (internal).
#ifndef LevelGeometry_h
#define LevelGeometry_h

class vtkCompressedVolume;
class vtkImageData;

namespace LevelGeometry
{
/// Gives an image that has a volume's geometry that of one of its levels: so many samples per axis,
/// every `steps`th of the volume's, the first of which is that of index `first`.
void Set(
  const int first[3], const int dims[3], const int steps[3], bool cellData, vtkImageData* image);

/// The same for a level of a volume that has been read.
void Set(vtkCompressedVolume* volume, vtkCompressedVolume* level, vtkImageData* image);
}

#endif
