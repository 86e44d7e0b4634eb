// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSampleRateFinder
 * @brief   find the rate that samples need, which come slab by slab
 *
 * Makes the choices of vtkImageZFPCompress's KeepLabels and Tolerance for a volume that is never in
 * memory as a whole. A pass is Start() and, as for vtkCompressedVolumeBuilder, slabs in order of z,
 * all but the last of a multiple of 4 slices.
 *
 * - One pass with AddForLabels() tells whether the samples are labels.
 * - Passes with AddSlab(), until the rate does not rise any more, find the least rate from Rate on
 *   that keeps every visible sample within Tolerance.
 *
 * @sa vtkCompressedVolumeBuilder vtkImageZFPCompress vtkSampleUnitsFinder
 */
#ifndef vtkSampleRateFinder_h
#define vtkSampleRateFinder_h

#include "vtkObject.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <memory> // for the implementation

class vtkDataArray;
class vtkUnsignedCharArray;
struct ChosenSamples;

class VTKPROGISOFILTERS_EXPORT vtkSampleRateFinder : public vtkObject
{
public:
  static vtkSampleRateFinder* New();
  vtkTypeMacro(vtkSampleRateFinder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Largest error of a sample, in its own units. Default: what leaves a label on its side of every
   * half-integer.
   */
  vtkSetMacro(Tolerance, double);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * The stream's units and what is hidden, as in vtkCompressedVolumeBuilder.
   */
  vtkSetMacro(Offset, double);
  vtkGetMacro(Offset, double);
  vtkSetMacro(Scale, double);
  vtkGetMacro(Scale, double);
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * Threads; 0, the default, takes all that OpenMP offers (OMP_NUM_THREADS).
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, 1024);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The rate in bits per sample, to begin with and as found. Default 9/64.
   */
  void SetRate(double rate);
  double GetRate() const;
  ///@}

  /**
   * Error of the worst block at 32 bits per sample if that is above the tolerance, which no rate
   * keeps then; else 0.
   */
  double GetLeastError() const;

  /**
   * Begins a pass over dims[0] x dims[1] x dims[2] samples.
   */
  void Start(const int dims[3]);

  ///@{
  /**
   * Takes the next slab into account; arguments are those of vtkCompressedVolumeBuilder's
   * AddSlab(). AddForLabels() returns whether the samples can still be labels. False after an
   * error, too.
   */
  bool AddForLabels(
    vtkDataArray* samples, int component = 0, vtkUnsignedCharArray* hidden = nullptr);
  bool AddSlab(vtkDataArray* samples, int component = 0, vtkUnsignedCharArray* hidden = nullptr);
  ///@}

  /**
   * Whether all that AddForLabels() got in this pass is labels.
   */
  bool FindsLabels() const;

protected:
  vtkSampleRateFinder();
  ~vtkSampleRateFinder() override;

private:
  vtkSampleRateFinder(const vtkSampleRateFinder&) = delete;
  void operator=(const vtkSampleRateFinder&) = delete;

  struct Work;
  bool TakeSlab(
    vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden, ChosenSamples& chosen);

  double Tolerance;
  double Offset = 0.0;
  double Scale = 1.0;
  bool MaskNonFinite = true;
  int NumberOfThreads = 0;
  std::unique_ptr<Work> Pass;
};

#endif
