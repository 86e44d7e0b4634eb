// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The field data of an image that hold a compressed volume (internal). The documentation of
// vtkCompressedVolume describes the arrays.
#ifndef CompressedVolumeFormat_h
#define CompressedVolumeFormat_h

#include "Status.h"

class vtkCompressedVolume;
class vtkDataObject;
class vtkImageData;

namespace CompressedVolumeFormat
{
/// Whether there is a stream; Read() says whether it is valid.
bool HasStream(vtkDataObject* object);

/// Reads a volume from an image, and checks all of it. After an error, whose message is one
/// sentence, the volume is incomplete.
Status Read(vtkImageData* image, vtkCompressedVolume* volume);

/// Stores a volume in an image, in place of what is there.
void Write(vtkCompressedVolume* volume, vtkImageData* image);

/// Takes the image's place for that of the samples, see vtkCompressedVolume::Place().
Status Place(vtkImageData* image);

/// Gives a stream that a reader has read an array whose range is known at once.
void SpeedUpRanges(vtkDataObject* object);

/// Removes the arrays that Write() stores.
void Remove(vtkDataObject* object);
}

#endif
