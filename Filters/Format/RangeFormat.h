// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// How the ranges of a compressed volume's blocks, or of a level's, are kept in field data
// (internal): in arrays whose names begin with the prefix of the others of that stream.
#ifndef RangeFormat_h
#define RangeFormat_h

#include "Status.h"

#include <string>

class vtkCompressedVolume;
class vtkFieldData;

namespace RangeFormat
{
/// Gives a volume the ranges that are there, if they are of the stream that was read from beside
/// them. An error, the end of a sentence that begins with the volume, where they are damaged.
Status Read(vtkFieldData* fields, const std::string& prefix, vtkCompressedVolume* volume);

/// Says which of a volume's ranges do not match their checksums; success if none.
Status CheckRecords(const std::string& prefix, vtkCompressedVolume* volume);

/// Stores a volume's ranges, if it has any, when all that tells its stream is stored.
void Write(vtkCompressedVolume* volume, const std::string& prefix, vtkFieldData* fields);

/// Removes what Write() has stored.
void Remove(const std::string& prefix, vtkFieldData* fields);
}

#endif
