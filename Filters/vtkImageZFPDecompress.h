// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageZFPDecompress
 * @brief   decode a compressed volume back to float32 samples
 *
 * The inverse of vtkImageZFPCompress. The output is a vtkImageData with the input's geometry and
 * field data (without the stream and its metadata), and one array with one component, the active
 * scalars, with the original name and association (point or cell data). Its values are float32, and
 * bit for bit those of libzfp's zfp_decompress(); or doubles if the stream has custom units. Blocks
 * are decoded in parallel with OpenMP. Hidden samples are NaN, and hidden points or cells are
 * flagged in ghost arrays. Of a piece that several processes have of an image, the output also has
 * the samples around it that the stream covers, marked as ghosts.
 *
 * With Level above 0 the output is that level of detail, if the volume has it: all of what the
 * stream covers, with samples where those of the volume are of which it has every second, fourth,
 * ... one. Its extent begins at 0, and its origin lies where the volume's first sample is; of cell
 * data that sample is the centre of the first cell.
 *
 * Errors, one message and an output without array: an input that is not a compressed volume, or
 * whose metadata or stream is inconsistent (see vtkCompressedVolume::Read), or that has no such
 * level; too little memory.
 *
 * @sa vtkImageZFPCompress vtkCompressedVolume vtkZFPReader
 */
#ifndef vtkImageZFPDecompress_h
#define vtkImageZFPDecompress_h

#include "vtkImageAlgorithm.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

class Status;

class VTKPROGISOFILTERS_EXPORT vtkImageZFPDecompress : public vtkImageAlgorithm
{
public:
  static vtkImageZFPDecompress* New();
  vtkTypeMacro(vtkImageZFPDecompress, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Level of detail to decode; 0, the default, is the volume itself.
   */
  vtkSetClampMacro(Level, int, 0, 11);
  vtkGetMacro(Level, int);
  ///@}

  ///@{
  /**
   * Threads that decode; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

protected:
  vtkImageZFPDecompress() = default;
  ~vtkImageZFPDecompress() override = default;

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkImageZFPDecompress(const vtkImageZFPDecompress&) = delete;
  void operator=(const vtkImageZFPDecompress&) = delete;

  void Report(const Status& status);

  int Level = 0;
  int NumberOfThreads = 0;
};

#endif
