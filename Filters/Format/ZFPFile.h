// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   ZFPFile
 * @brief   what a file of zfp's own holds, and where (internal)
 *
 * Messages of errors are ends of sentences that begin with the file's name.
 */
#ifndef ZFPFile_h
#define ZFPFile_h

#include "Format/ZFPHeader.h"
#include "Status.h"

#include "vtkType.h"

#include <string>

class vtkUnsignedCharArray;

class ZFPFile
{
public:
  /**
   * Opens a file with zfp's header, or, with dimensions other than (0, 0, 0), one without: then
   * dimensions and rate tell what it holds.
   */
  Status Open(const char* fileName, const int dims[3], double rate);

  const int* GetDimensions() const { return this->Layout.Dimensions; }
  int GetBlockBits() const { return this->Layout.BlockBits; }
  bool HasHeader() const { return this->Layout.Bits > 0; }

  /**
   * Reads the stream into whole 64-bit words, padded with zero bits.
   */
  Status ReadStream(vtkUnsignedCharArray* stream) const;

private:
  Status CheckLayout() const;
  vtkTypeInt64 GetStreamBits() const;
  bool ReadWords(vtkTypeUInt64* words, vtkTypeInt64 count) const;

  std::string FileName;
  vtkTypeInt64 FileBytes = 0;
  ZFPHeader Layout; // for a file without header, what its header would say
};

#endif
