// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageZFPCompress
 * @brief   compress one array of an image with fixed-rate ZFP
 *
 * Converts one component of a point or cell array of a vtkImageData, of any scalar type, or the
 * magnitude of its vectors, to float32 and compresses it. The output is a compressed volume (see
 * vtkCompressedVolume): a vtkImageData with the same extent, spacing, origin and direction matrix,
 * no point or cell arrays unless PassOtherArrays is on, and the input's field data with the
 * compressed stream and its metadata.
 *
 * If several processes share an image, each compresses its piece. Ghost cells are not in the
 * output's extent, but the stream covers as many of their samples as the piece needs to look the
 * same as in the whole, in the blocks of the whole (see vtkCompressedVolume::GetCoveringExtent()).
 * The filter requests enough ghost levels; put a vtkGhostCellsGenerator before it if the source has
 * none.
 *
 * Samples of points that the input's ghost array hides (for cell data: of cells) are hidden, and so
 * are hidden cells of point data. Their values do not matter. See MaskNonFinite for NaN.
 *
 * SetInputArrayToProcess(0, ...) chooses the array. Default: the active point scalars, else the
 * active cell scalars, else the first point array, else the first cell array.
 *
 * If float32 cannot hold the samples, the stream has custom units (see vtkCompressedVolume): of
 * doubles and large integers that differ by less than a 16th of their magnitude, the middle is
 * subtracted. Values that are too large for float32, or all below 2^-74, among which zfp may find
 * blocks too small, are scaled by a power of two. So float32 rounds by at most 2^-20 of the range.
 * vtkSampleUnitsFinder makes the same choice. Each process' piece has its own units. 64-bit
 * integers beyond 2^53 are first rounded to doubles.
 *
 * Blocks are encoded in parallel with OpenMP. The stream is bit-identical to that of libzfp's
 * zfp_compress(), whatever the number of threads, except for blocks of 4x4x4 samples that are all
 * below 2^-98, about 3e-30: there zfp's encoder overflows, and this filter stores zero. Values are
 * converted block by block, without a second copy of the volume. The filter reports progress about
 * a hundred times; an abort is noticed then, and leaves the output without a stream.
 *
 * Errors, each one message and an output without stream: no such array or component; an image with
 * fewer than 2 samples along an axis; a rate outside (0, 32]; with MaskNonFinite off NaN or
 * infinite samples (as float32; the message counts them).
 *
 * The filter requests the whole extent of its input, or the piece that is requested from it.
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
   * Requested rate in bits per sample, in (0, 32]. Default 8. zfp rounds it to whole bits per block
   * of 64 samples, at least 9: see GetActualRate().
   */
  vtkSetMacro(Rate, double);
  vtkGetMacro(Rate, double);
  ///@}

  /**
   * Returns the array that is compressed if none is chosen, see above, and its association,
   * vtkCompressedVolume::PointData or CellData. Null if the image has no array.
   */
  static vtkDataArray* FindDefaultArray(vtkImageData* image, int& association);

  /**
   * The rate that zfp uses for GetRate(), in bits per sample: a multiple of 1/64, at least 9/64. 0
   * if the rate is out of range. The output tells what KeepLabels and Tolerance made of it.
   */
  double GetActualRate() const;

  ///@{
  /**
   * Component of the array to compress; -1: the magnitude, the length of its vectors (of an array
   * of one component its values). It is computed before, as floats or doubles. Default 0.
   */
  vtkSetMacro(Component, int);
  vtkGetMacro(Component, int);
  ///@}

  ///@{
  /**
   * Whether the number behind an array's last component also means the magnitude, as in ParaView's
   * panels. Default off.
   */
  vtkSetMacro(MagnitudeIsLast, bool);
  vtkGetMacro(MagnitudeIsLast, bool);
  vtkBooleanMacro(MagnitudeIsLast, bool);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples (as float32) are hidden, as those of hidden points are, so
   * that an isosurface has a hole there, as the surface of VTK's contour filters has. Default on;
   * off: they are an error that counts them.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * Whether labels and masks are kept apart: whole numbers, of any type, of which a block of 4x4x4
   * samples has few different ones (8 in the mean, where it has several), and either few in all
   * (16) or far apart. Those are compressed at the least rate from Rate on that leaves every sample
   * on its side of every half-integer. Default off.
   */
  vtkSetMacro(KeepLabels, bool);
  vtkGetMacro(KeepLabels, bool);
  vtkBooleanMacro(KeepLabels, bool);
  ///@}

  ///@{
  /**
   * Largest error of a sample, in the samples' own units. If it is above 0, the image is compressed
   * at the least rate that keeps every visible sample within it, whatever Rate and KeepLabels are.
   * An error if 32 bits per sample do not. Default 0.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Most levels of detail that are made beside the volume, 0 to 11: coarser copies for far views,
   * see vtkCompressedVolume. Each has half of the samples along the axes whose samples lie nearest
   * to each other (within a factor of the root of 2), by the image's spacing; the last one fits
   * 64 x 64 x 64 samples, and no others are made. Level k has k + 2 bits per sample more than the
   * volume, so that its samples are off by no more. Together they take 20 % of the volume's stream
   * at 8 bits per sample, 26 % at 4. Of images that several processes share each makes levels of
   * its piece. Default 0.
   */
  vtkSetClampMacro(Levels, int, 0, 11);
  vtkGetMacro(Levels, int);
  ///@}

  ///@{
  /**
   * Whether the output has the input's other point and cell arrays, uncompressed; vtkZFPContour
   * carries those of points on to its surface. Default off.
   */
  vtkSetMacro(PassOtherArrays, bool);
  vtkGetMacro(PassOtherArrays, bool);
  vtkBooleanMacro(PassOtherArrays, bool);
  ///@}

  ///@{
  /**
   * Rate of the last output, in bits per sample, and the largest error of its samples, in their own
   * units; 0 and -1 without one.
   */
  vtkGetMacro(OutputRate, double);
  vtkGetMacro(OutputError, double);
  ///@}

  ///@{
  /**
   * Threads that encode; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
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
  bool MagnitudeIsLast = false;
  bool MaskNonFinite = true;
  bool KeepLabels = false;
  double Tolerance = 0.0;
  int Levels = 0;
  bool PassOtherArrays = false;
  double OutputRate = 0.0;
  double OutputError = -1.0;
  int NumberOfThreads = 0;
};

#endif
