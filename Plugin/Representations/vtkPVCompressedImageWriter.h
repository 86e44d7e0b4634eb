// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVCompressedImageWriter
 * @brief   compresses an image and writes the compressed volume, for extracts of a simulation
 *
 * Writes one array of an image as a compressed volume: a .vti file, or a .zfp file without
 * geometry, by the name's ending. Where several processes share the image, or it comes in blocks (a
 * composite data set, such as Catalyst has of a simulation), process 0 puts the pieces together,
 * compresses the whole and writes one file: the same, bit for bit, for any number of processes. It
 * needs memory for the array that is compressed. A compressed volume of one process is written as
 * it is.
 *
 * @sa vtkImageZFPCompress
 */
#ifndef vtkPVCompressedImageWriter_h
#define vtkPVCompressedImageWriter_h

#include "vtkNew.h"
#include "vtkProgIsoRepresentationsModule.h" // for export macro
#include "vtkSmartPointer.h"
#include "vtkWriter.h"

#include <vector>

class Status;
class vtkImageData;
class vtkImageZFPCompress;

class VTKPROGISOREPRESENTATIONS_EXPORT vtkPVCompressedImageWriter : public vtkWriter
{
public:
  static vtkPVCompressedImageWriter* New();
  vtkTypeMacro(vtkPVCompressedImageWriter, vtkWriter);
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
   * See vtkImageZFPCompress. SetInputArrayToProcess(0, ...) chooses the array.
   */
  void SetRate(double rate);
  void SetKeepLabels(bool on);
  void SetTolerance(double tolerance);
  void SetComponent(int component);
  void SetMaskNonFinite(bool on);
  void SetLevels(int levels);
  ///@}

protected:
  vtkPVCompressedImageWriter();
  ~vtkPVCompressedImageWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  void WriteData() override;

private:
  vtkPVCompressedImageWriter(const vtkPVCompressedImageWriter&) = delete;
  void operator=(const vtkPVCompressedImageWriter&) = delete;

  using Images = std::vector<vtkSmartPointer<vtkImageData>>;
  Images FindImages();
  Status SelectArrays(Images& images);
  Status WriteImages(Images& images);
  Status CompressPieces(const Images& pieces);
  Status WriteFile(vtkImageData* volume);

  char* FileName = nullptr;
  vtkNew<vtkImageZFPCompress> Compressor;
};

#endif
