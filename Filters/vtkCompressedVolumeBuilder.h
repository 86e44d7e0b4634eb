// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCompressedVolumeBuilder
 * @brief   compress a volume slab by slab, so that it never needs to be in memory as a whole
 *
 * Takes slices in order of z, some at a time, and holds nothing but their compressed stream: a
 * simulation or a reader hands over a slab, and may then reuse its memory. The result is bit for
 * bit what vtkImageZFPCompress makes of the whole image with point data.
 *
 * @code
 * builder->Start(dims, rate);
 * while (...) { builder->AddSlab(samples); }
 * builder->Finish(image);
 * @endcode
 *
 * Every function returns false when something is wrong; GetErrorMessage() then holds one sentence
 * that says what, and nothing but Start() succeeds any more.
 *
 * @sa vtkImageZFPCompress vtkCompressedVolume vtkZFPWriter
 */
#ifndef vtkCompressedVolumeBuilder_h
#define vtkCompressedVolumeBuilder_h

#include "vtkObject.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <memory> // for the implementation
#include <string> // for the array name and the error message

class vtkDataArray;
class vtkImageData;

class VTKPROGISOFILTERS_EXPORT vtkCompressedVolumeBuilder : public vtkObject
{
public:
  static vtkCompressedVolumeBuilder* New();
  vtkTypeMacro(vtkCompressedVolumeBuilder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Name of the array that the result says to hold. By default that of the first slab's array, or
   * "scalars".
   */
  std::string GetArrayName() const { return this->ArrayName; }
  void SetArrayName(const std::string& name);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples (as float32) are hidden, as vtkImageZFPCompress has it.
   * Default off: they are refused. Not to be changed between slabs.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * The stream's units, see vtkCompressedVolume: samples are kept as float32 after Offset is taken
   * off and the rest divided by Scale, above 0. Default 0 and 1. vtkImageZFPCompress, which sees
   * all samples, chooses them itself. Not to be changed between slabs.
   */
  vtkSetMacro(Offset, double);
  vtkGetMacro(Offset, double);
  vtkSetMacro(Scale, double);
  vtkGetMacro(Scale, double);
  ///@}

  ///@{
  /**
   * Threads used to encode; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /**
   * Begin a volume of dims[0] x dims[1] x dims[2] samples, at least 2 along each axis, at a rate in
   * bits per sample, in (0, 32]. Drops what was begun before.
   */
  bool Start(const int dims[3], double rate);

  /**
   * Compress the next slices: one component of an array of a multiple of dims[0]*dims[1] tuples, x
   * fastest. Of all slabs but the last that multiple must be a multiple of 4, and all must be of
   * one type. See MaskNonFinite for NaN.
   */
  bool AddSlab(vtkDataArray* samples, int component = 0);

  /**
   * Slices taken so far.
   */
  int GetNumberOfSlices() const;

  /**
   * Store the compressed volume in an image, when all slices are there: its dimensions and field
   * data are set, its point and cell data emptied; spacing, origin and direction matrix stay.
   * Refused for values all of which are tiny to zfp (below 2^-74, about 5e-23) at the Scale. Frees
   * what the builder holds.
   */
  bool Finish(vtkImageData* image);

  /**
   * What the last call objected to; empty after a successful one.
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
  bool MaskNonFinite = false;
  int NumberOfThreads = 0;
  std::string ErrorMessage;
  std::unique_ptr<Work> Volume; // null before Start() and after an error
};

#endif
