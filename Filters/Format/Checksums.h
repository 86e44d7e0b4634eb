// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Checksums of a compressed volume: zlib's CRC-32 of every page of its stream, and of its metadata
// (internal).
#ifndef Checksums_h
#define Checksums_h

#include "Status.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class vtkCompressedVolume;
class vtkFieldData;
class vtkTypeUInt32Array;
class vtkUnsignedCharArray;

namespace Checksums
{
/// Returns the pages of a stream of so many bytes.
vtkTypeInt64 NumberOfPages(vtkTypeInt64 bytes);

/// Computes the checksums of a stream's first `bytes`, a value a page, by all threads.
vtkSmartPointer<vtkTypeUInt32Array> OfPages(vtkUnsignedCharArray* stream, vtkTypeInt64 bytes);

/// Compares a volume's stream with the checksums of its pages. The error, the end of a sentence
/// that begins with the stream's name, tells the first damaged place.
Status CheckPages(vtkCompressedVolume* volume, vtkTypeUInt32Array* expected);

///@{
/// Remembers that a stream is as its checksums say, and tells whether it was so remembered and
/// has not been modified since.
void SetIntact(vtkUnsignedCharArray* stream, vtkTypeUInt32Array* checksums);
bool IsKnownIntact(vtkUnsignedCharArray* stream, vtkTypeUInt32Array* checksums);
///@}

/// Computes the checksum of a stream's checksums, by which one stream is told from another.
vtkTypeUInt32 OfChecksums(vtkTypeUInt32Array* checksums);

/// Computes the checksum of those of these arrays that are there, in this order, as OfFields()
/// does.
vtkTypeUInt32 OfArrays(vtkFieldData* fields, const std::vector<std::string>& names);

/// Computes the checksum of all arrays whose names begin with `prefix`, in the order of their
/// names, but for two. It depends on names and values, and not on the width of integers.
vtkTypeUInt32 OfFields(
  vtkFieldData* fields, const char* prefix, const char* without, const char* andWithout);
}

#endif
