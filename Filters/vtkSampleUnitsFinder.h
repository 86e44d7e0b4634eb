// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSampleUnitsFinder
 * @brief   choose a stream's units from samples that come some at a time
 *
 * Makes the choice of vtkImageZFPCompress (see there) for a volume that is never in memory as a
 * whole: a first pass gives all samples to this class, a second one to vtkCompressedVolumeBuilder,
 * with the offset and the scale that were found. How the samples are cut into arrays, and their
 * order, do not matter. NaN and infinite samples are left out.
 *
 * @code
 * while (...) { if (finder->AddSamples(samples)) { break; } }
 * builder->SetOffset(finder->GetOffset());
 * builder->SetScale(finder->GetScale());
 * @endcode
 *
 * @sa vtkCompressedVolumeBuilder vtkImageZFPCompress
 */
#ifndef vtkSampleUnitsFinder_h
#define vtkSampleUnitsFinder_h

#include "vtkObject.h"
#include "vtkProgIsoFiltersModule.h" // for export macro

#include <memory> // for the implementation

class UnitsFinder;
class vtkDataArray;
class vtkUnsignedCharArray;

class VTKPROGISOFILTERS_EXPORT vtkSampleUnitsFinder : public vtkObject
{
public:
  static vtkSampleUnitsFinder* New();
  vtkTypeMacro(vtkSampleUnitsFinder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Forgets all samples.
   */
  void Initialize();

  /**
   * Takes one component of an array's samples into account, or their magnitude (-1, see
   * vtkImageZFPCompress); all arrays must have one type. `hidden`
   * has a value other than 0 for each sample that is hidden; null: none is. Returns whether the
   * units are settled, see IsSettled(). An error if there is no such component, or `hidden` has
   * another number of values.
   */
  bool AddSamples(vtkDataArray* samples, int component = 0, vtkUnsignedCharArray* hidden = nullptr);

  /**
   * Whether further samples cannot change the units: always after the first array of a type of at
   * most 16 bits, soon with float32 and with integers among which there are small ones, never with
   * doubles.
   */
  bool IsSettled() const;

  ///@{
  /**
   * The units of the samples so far: 0 and 1 if float32 and zfp hold them as they are.
   */
  double GetOffset() const;
  double GetScale() const;
  ///@}

protected:
  vtkSampleUnitsFinder();
  ~vtkSampleUnitsFinder() override;

private:
  vtkSampleUnitsFinder(const vtkSampleUnitsFinder&) = delete;
  void operator=(const vtkSampleUnitsFinder&) = delete;

  std::unique_ptr<UnitsFinder> Finder;
};

#endif
