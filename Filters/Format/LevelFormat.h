// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the levels of detail of a compressed volume are kept in an image's field data (internal). The
// arrays are listed in vtkCompressedVolume.h.
#ifndef LevelFormat_h
#define LevelFormat_h

#include "Status.h"

class vtkCompressedVolume;
class vtkFieldData;
class vtkImageData;
class vtkTypeUInt32Array;

namespace LevelFormat
{
/// Adds the levels that an image has to the volume that was read from it. The error, the end of a
/// sentence that begins with the volume, names the level.
Status Read(vtkImageData* image, vtkCompressedVolume* volume);

/// Stores a volume's levels; `checksums` are those of its stream's pages.
void Write(vtkCompressedVolume* volume, vtkTypeUInt32Array* checksums, vtkFieldData* fields);

void Remove(vtkFieldData* fields);

/// Does what vtkCompressedVolume::SpeedUpRanges() does, to the streams of levels.
void SpeedUpRanges(vtkFieldData* fields);
}

#endif
