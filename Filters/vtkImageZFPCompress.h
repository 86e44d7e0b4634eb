// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageZFPCompress
 * @brief   compress one array of an image with fixed-rate ZFP
 *
 * Takes one component of a point or cell array of a vtkImageData of any scalar type, as float32,
 * and produces a compressed volume (see vtkCompressedVolume): a vtkImageData with the same extent,
 * spacing, origin and direction matrix, no point or cell arrays, the input's field data, and the
 * compressed stream with its metadata in the field data.
 *
 * Where several processes share an image, each compresses its piece: ghost cells are left out of
 * the output's extent, but the stream covers as many of their samples as the piece needs to look as
 * the whole does, in the blocks of the whole (see vtkCompressedVolume::GetCoveringExtent()). The
 * filter asks for enough ghost levels; put a vtkGhostCellsGenerator before it where the source has
 * none.
 *
 * Samples of hidden points (of cell data: cells) in the input's ghost arrays are hidden, and so are
 * hidden cells of point data; the values there do not matter. See MaskNonFinite for NaN.
 *
 * The array is the one of SetInputArrayToProcess(0, ...), by default the active point scalars, else
 * the first point array, else the active cell scalars, else the first cell array.
 *
 * Where float32 cannot hold the samples, the stream has units of its own (see
 * vtkCompressedVolume): doubles and large integers that differ by less than a 16th of what they are
 * have their middle taken off, and values that are too large for float32, or all too small for zfp,
 * are scaled by a power of two. So what float32 rounds off is at most 2^-20 of their range. Pieces
 * that processes share have units each. Of 64-bit integers beyond 2^53 doubles round off the rest.
 *
 * Blocks are encoded in parallel with OpenMP; the stream is bit-identical to what libzfp's
 * zfp_compress() writes, whatever the number of threads. (Except for blocks of 4x4x4 samples that
 * are all below 2^-98, about 3e-30: zfp's encoder overflows there, this filter stores zero.) Values
 * are converted block by block, so that no second copy of the volume is made. Progress events are
 * sent about a hundred times, when an abort is also noticed (the output then has no stream).
 *
 * Errors, each one message and an output without stream: no such array or component; an image with
 * fewer than 2 samples along an axis; a rate outside (0, 32]; NaN or infinite samples (as float32;
 * the message counts them).
 *
 * The filter asks for the whole extent of its input, or the piece of it that is asked for.
 *
 * @sa vtkImageZFPDecompress vtkCompressedVolume vtkZFPWriter
 */
#ifndef vtkImageZFPCompress_h
#define vtkImageZFPCompress_h

#include "vtkImageAlgorithm.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

class vtkDataArray;

class VTKPROGISOFILTERS_EXPORT vtkImageZFPCompress : public vtkImageAlgorithm
{
public:
  static vtkImageZFPCompress* New();
  vtkTypeMacro(vtkImageZFPCompress, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Rate asked for, in bits per sample, in (0, 32]. Default 8. zfp rounds it to whole bits per
   * block of 64 samples, at least 9: see GetActualRate().
   */
  vtkSetMacro(Rate, double);
  vtkGetMacro(Rate, double);
  ///@}

  /**
   * The array that is compressed where none is chosen, as the class's description tells, and its
   * association, vtkCompressedVolume::PointData or CellData. Null where an image has none.
   */
  static vtkDataArray* FindDefaultArray(vtkImageData* image, int& association);

  /**
   * Rate that zfp uses for GetRate(), in bits per sample: a multiple of 1/64, at least 9/64. 0 when
   * the rate is out of range.
   */
  double GetActualRate() const;

  ///@{
  /**
   * Component of the array to compress. Default 0.
   */
  vtkSetMacro(Component, int);
  vtkGetMacro(Component, int);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples (as float32) are hidden, as those of hidden points are, so
   * that an isosurface has a hole there. Default off: they are an error that counts them.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * Threads used to encode; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

protected:
  vtkImageZFPCompress() = default;
  ~vtkImageZFPCompress() override = default;

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkImageZFPCompress(const vtkImageZFPCompress&) = delete;
  void operator=(const vtkImageZFPCompress&) = delete;

  class Work;

  double Rate = 8.0;
  int Component = 0;
  bool MaskNonFinite = false;
  int NumberOfThreads = 0;
};

#endif
