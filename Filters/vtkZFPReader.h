// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPReader
 * @brief   read a file of the zfp command line tool or zfpy as a compressed volume
 *
 * Reads fixed-rate streams of 3-D float32 arrays, with zfp's header (`zfp -h`, zfpy) or without
 * (set DataDimensions and Rate). The stream is kept bit for bit, and nothing is compressed again.
 * zfp files have no range of values, so that the blocks are decoded once to find it. The metadata's
 * ScalarType is VTK_FLOAT.
 *
 * Errors, one message and an empty output: a file that cannot be read; another codec version,
 * scalar type, dimensionality or compression mode; fewer than 2 samples along an axis; a truncated
 * stream; without header, a file size that does not match dimensions and rate; samples that decode
 * to infinity (a damaged stream or the wrong dimensions).
 *
 * zfp files have no geometry: set DataSpacing and DataOrigin.
 *
 * @sa vtkZFPWriter vtkImageZFPDecompress vtkCompressedVolume
 */
#ifndef vtkZFPReader_h
#define vtkZFPReader_h

#include "vtkImageAlgorithm.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <string> // for the last error

class VTKPROGISOFILTERS_EXPORT vtkZFPReader : public vtkImageAlgorithm
{
public:
  static vtkZFPReader* New();
  vtkTypeMacro(vtkZFPReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Returns 1 for a file that has a header that this reader can read, and for any other whose name
   * ends with ".zfp": it may be without header, which cannot be told from its bytes. Else 0.
   */
  int CanReadFile(const char* fileName);

  /**
   * Whether a file has zfp's header, and this reader can read what that tells.
   */
  bool HasReadableHeader(const char* fileName);

  ///@{
  /**
   * Samples per axis of a file without header. Default (0, 0, 0): the file has a header.
   */
  vtkSetVector3Macro(DataDimensions, int);
  vtkGetVector3Macro(DataDimensions, int);
  ///@}

  ///@{
  /**
   * Rate of a file without header, in bits per sample in (0, 32], as for `zfp -r`. Default 8.
   * Ignored for a file with header.
   */
  vtkSetMacro(Rate, double);
  vtkGetMacro(Rate, double);
  ///@}

  ///@{
  /**
   * Spacing and origin of the image, in world units. Defaults (1, 1, 1) and (0, 0, 0).
   */
  vtkSetVector3Macro(DataSpacing, double);
  vtkGetVector3Macro(DataSpacing, double);
  vtkSetVector3Macro(DataOrigin, double);
  vtkGetVector3Macro(DataOrigin, double);
  ///@}

  ///@{
  /**
   * Name of the array, which zfp files do not have. Default "scalars".
   */
  vtkSetStringMacro(ArrayName);
  vtkGetStringMacro(ArrayName);
  ///@}

protected:
  vtkZFPReader();
  ~vtkZFPReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkZFPReader(const vtkZFPReader&) = delete;
  void operator=(const vtkZFPReader&) = delete;

  void ShowError(const std::string& error);

  char* FileName = nullptr;
  char* ArrayName = nullptr;
  int DataDimensions[3] = { 0, 0, 0 };
  double Rate = 8.0;
  double DataSpacing[3] = { 1.0, 1.0, 1.0 };
  double DataOrigin[3] = { 0.0, 0.0, 0.0 };
  std::string ShownError;
};

#endif
