// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The header of zfp's own files (internal).
#ifndef ZFPHeader_h
#define ZFPHeader_h

#include "Status.h"

#include "vtkType.h"

#include <istream>

struct ZFPHeader
{
  static constexpr int MaximumWords = 3; ///< 64-bit words with room for any header

  int Dimensions[3] = { 0, 0, 0 };
  int BlockBits = 0;
  int Bits = 0; ///< length of the header; the stream begins right behind it

  /// Reads the header from the beginning of a file. An error, whose message is the end of a
  /// sentence that begins with the file's name, if a compressed volume cannot hold the array.
  static Status Read(std::istream& file, vtkTypeInt64 fileBytes, ZFPHeader& header);
};

/// Makes the header of a stream. Returns its length in bits, or 0 if it has no room for the
/// dimensions.
int MakeZFPHeader(const int dims[3], int blockBits, vtkTypeUInt64 words[ZFPHeader::MaximumWords]);

#endif
