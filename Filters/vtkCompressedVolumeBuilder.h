// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCompressedVolumeBuilder
 * @brief   compress a volume slab by slab, without the whole in memory
 *
 * Takes slices in order of z, some at a time, and keeps only their compressed stream: a simulation
 * or a reader may reuse a slab's memory once it is added. The result is bit for bit that of
 * vtkImageZFPCompress for the whole image with point data.
 *
 * @code
 * builder->Start(dims, rate);
 * while (...) { builder->AddSlab(samples); }
 * builder->Finish(image);
 * @endcode
 *
 * Every function returns false after an error. GetErrorMessage() then describes it in one sentence,
 * and only Start() can succeed.
 *
 * @sa vtkImageZFPCompress vtkSampleUnitsFinder vtkCompressedVolume vtkZFPWriter
 */
#ifndef vtkCompressedVolumeBuilder_h
#define vtkCompressedVolumeBuilder_h

#include "vtkObject.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <memory> // for the implementation
#include <string> // for the array name and the error message

class vtkDataArray;
class vtkImageData;
class vtkUnsignedCharArray;

class VTKPROGISOFILTERS_EXPORT vtkCompressedVolumeBuilder : public vtkObject
{
public:
  static vtkCompressedVolumeBuilder* New();
  vtkTypeMacro(vtkCompressedVolumeBuilder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Name of the compressed array. Default: that of the first slab's array, or "scalars".
   */
  std::string GetArrayName() const { return this->ArrayName; }
  void SetArrayName(const std::string& name);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples (as float32) are hidden, as in vtkImageZFPCompress. Default
   * on; off: they are an error. Must not change between slabs.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * The stream's units, see vtkCompressedVolume: the stream has (sample - Offset) / Scale as
   * float32; Scale is above 0. Default 0 and 1. vtkSampleUnitsFinder finds those that
   * vtkImageZFPCompress, which sees all samples, chooses itself. Must not change between slabs.
   */
  vtkSetMacro(Offset, double);
  vtkGetMacro(Offset, double);
  vtkSetMacro(Scale, double);
  vtkGetMacro(Scale, double);
  ///@}

  ///@{
  /**
   * Most levels of detail, and the distances of samples, by which they halve axes: those that the
   * image of Finish() has. See vtkImageZFPCompress::SetLevels(). Default 0, and 1, 1, 1. Used by
   * Start().
   */
  vtkSetClampMacro(Levels, int, 0, 11);
  vtkGetMacro(Levels, int);
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  ///@}

  ///@{
  /**
   * Threads that encode; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /**
   * Begins a volume of dims[0] x dims[1] x dims[2] samples, at least 2 along each axis, at a rate
   * in bits per sample, in (0, 32]. Discards an unfinished volume.
   */
  bool Start(const int dims[3], double rate);

  /**
   * Compresses the next slices: one component (-1: the magnitude, see vtkImageZFPCompress) of an
   * array whose number of tuples is a multiple of dims[0]*dims[1], x fastest. Every slab except the
   * last must have a multiple of 4 slices, and all must have one type. See MaskNonFinite for NaN.
   * `hidden` has a value other than 0 for each sample that is hidden, whatever its value; null:
   * none is.
   */
  bool AddSlab(vtkDataArray* samples, int component = 0, vtkUnsignedCharArray* hidden = nullptr);

  /**
   * Slices added so far.
   */
  int GetNumberOfSlices() const;

  /**
   * Stores the compressed volume in an image when all slices have been added: sets its dimensions
   * and field data, and empties its point and cell data; spacing, origin and direction matrix stay,
   * and its extent if it has the dimensions. To move it later, use vtkCompressedVolume::Place().
   * An error if all values are too small for zfp (below 2^-74, about 5e-23, in units of Scale).
   * Frees the builder's memory.
   */
  bool Finish(vtkImageData* image);

  /**
   * What went wrong in the last call; empty after a successful one.
   */
  std::string GetErrorMessage() const { return this->ErrorMessage; }

protected:
  vtkCompressedVolumeBuilder();
  ~vtkCompressedVolumeBuilder() override;

private:
  vtkCompressedVolumeBuilder(const vtkCompressedVolumeBuilder&) = delete;
  void operator=(const vtkCompressedVolumeBuilder&) = delete;

  struct Work;
  bool SetError(const std::string& message);
  bool SetErrorWithoutVolume();

  std::string ArrayName;
  double Offset = 0.0;
  double Scale = 1.0;
  bool MaskNonFinite = true;
  int Levels = 0;
  double Spacing[3] = { 1.0, 1.0, 1.0 };
  int NumberOfThreads = 0;
  std::string ErrorMessage;
  std::unique_ptr<Work> Volume; // null before Start() and after an error
};

#endif
