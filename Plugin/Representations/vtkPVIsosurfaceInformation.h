// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVIsosurfaceInformation
 * @brief   cost of a progressive isosurface's last image, over all processes that draw it
 *
 * Gathers statistics from a vtkProgressiveIsosurfaceRepresentation. Processes that draw nothing (a
 * client that shows what a server renders, a process without a piece) do not count. Of all others,
 * bytes and pixels are summed, and of passes, completeness and times the slowest process counts. A
 * process that draws several blocks does so one after the other: their times are summed as well.
 */

#ifndef vtkPVIsosurfaceInformation_h
#define vtkPVIsosurfaceInformation_h

#include "vtkPVInformation.h"
#include "vtkProgIsoRepresentationsModule.h" // for export macro

#include <string> // for ivar
#include <vector> // for the figures of each pass

class vtkProgressiveIsosurfaceMapper;

class VTKPROGISOREPRESENTATIONS_EXPORT vtkPVIsosurfaceInformation : public vtkPVInformation
{
public:
  static vtkPVIsosurfaceInformation* New();
  vtkTypeMacro(vtkPVIsosurfaceInformation, vtkPVInformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// See vtkPVInformation.
  void CopyFromObject(vtkObject* representation) override;
  void AddInformation(vtkPVInformation* other) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;
  ///@}

  ///@{
  /// Why a process has not drawn all of its piece, one of several reasons (empty: all have), what
  /// one has warned of last, and how often processes have told such things so far.
  const std::string& GetError() const { return this->Error; }
  const std::string& GetWarning() const { return this->Warning; }
  vtkGetMacro(NumberOfErrors, int);
  vtkGetMacro(NumberOfWarnings, int);
  ///@}

  /// Number of processes that draw a piece.
  vtkGetMacro(NumberOfProcesses, int);

  /// Passes of the process that needed most; fraction of the pixels that are complete, 0 … 1, of
  /// the process with the least; milliseconds of the image on the slowest process.
  int GetNumberOfPasses() const { return static_cast<int>(this->PassMilliseconds.size()); }
  vtkGetMacro(CompletedFraction, double);
  vtkGetMacro(TotalMilliseconds, double);

  /// Graphics memory in bytes: in total, of the compressed stream, and the budget for the rest.
  /// ParaView's panel shows no 64-bit integers, so these are doubles.
  vtkGetMacro(GPUBytes, double);
  vtkGetMacro(CompressedBytes, double);
  vtkGetMacro(MemoryBudget, double);

  /// For each pass, the milliseconds from the start of the image to the end of the pass, and the
  /// fraction of the pixels that were complete then.
  const std::vector<double>& GetPassMilliseconds() const { return this->PassMilliseconds; }
  const std::vector<double>& GetPassCompleted() const { return this->PassCompleted; }

  /// For each level of detail, 0 being the volume itself, the pixels whose nearest surface it
  /// draws; of several pieces or blocks, one before another, each counts. Empty where LevelOfDetail
  /// is off.
  const std::vector<double>& GetLevelPixels() const { return this->LevelPixels; }

  /// Fraction of the pixels that a piece or block covers, 0 … 1, where levels of detail may hide
  /// something: see vtkProgressiveIsosurfaceStatistics::GetUncertainFraction(). Of several, that
  /// with the most counts.
  vtkGetMacro(UncertainFraction, double);

protected:
  vtkPVIsosurfaceInformation() = default;
  ~vtkPVIsosurfaceInformation() override = default;

private:
  void Clear();
  void AddBlock(vtkProgressiveIsosurfaceMapper* mapper);
  /// Joins the passes of two, each pass by a function of their milliseconds.
  void JoinPasses(const std::vector<double>& milliseconds, const std::vector<double>& completed,
    double (*join)(double, double));
  void AddLevels(const std::vector<double>& pixels, double uncertain);

  std::string Error;
  std::string Warning;
  int NumberOfErrors = 0;
  int NumberOfWarnings = 0;
  int NumberOfProcesses = 0;
  double CompletedFraction = 0.0;
  double TotalMilliseconds = 0.0;
  double GPUBytes = 0.0;
  double CompressedBytes = 0.0;
  double MemoryBudget = 0.0;
  std::vector<double> PassMilliseconds;
  std::vector<double> PassCompleted;
  std::vector<double> LevelPixels;
  double UncertainFraction = 0.0;

  vtkPVIsosurfaceInformation(const vtkPVIsosurfaceInformation&) = delete;
  void operator=(const vtkPVIsosurfaceInformation&) = delete;
};

#endif
