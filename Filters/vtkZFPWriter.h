// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkZFPWriter
 * @brief   write a compressed volume as a zfp file
 *
 * Writes the stream of a compressed volume as the zfp command line tool (1.0) does, with or without
 * its header, so that `zfp -h -z FILE -o OUT` or zfpy decode it. Nothing is decoded or compressed
 * again. The file has neither geometry, array name nor original type: use a VTI writer to keep
 * them.
 *
 * A zfp file has no room for checksums: only a wrong length is noticed of a damaged one. Write .vti
 * where that matters.
 *
 * Errors, one message and Write() returns 0: an input that is not a valid compressed volume, or
 * that a zfp file cannot hold (a piece, custom units, hidden samples or cells); no file name; a
 * file that cannot be written (which is then removed); with header, an axis of more than 65536
 * samples (zfp's header has 16 bits for each).
 *
 * @sa vtkZFPReader vtkImageZFPCompress vtkCompressedVolume
 */
#ifndef vtkZFPWriter_h
#define vtkZFPWriter_h

#include "vtkProgIsoFiltersModule.h" // for export macro
#include "vtkWriter.h"

class vtkCompressedVolume;

class VTKPROGISOFILTERS_EXPORT vtkZFPWriter : public vtkWriter
{
public:
  static vtkZFPWriter* New();
  vtkTypeMacro(vtkZFPWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether to write zfp's header (dimensions, type and rate), as `zfp -h` does. Default on. A
   * reader of a file without header must know dimensions and rate.
   */
  vtkSetMacro(WriteHeader, bool);
  vtkGetMacro(WriteHeader, bool);
  vtkBooleanMacro(WriteHeader, bool);
  ///@}

protected:
  vtkZFPWriter() = default;
  ~vtkZFPWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

private:
  vtkZFPWriter(const vtkZFPWriter&) = delete;
  void operator=(const vtkZFPWriter&) = delete;

  void WriteFile(vtkCompressedVolume* volume);

  char* FileName = nullptr;
  bool WriteHeader = true;
};

#endif
