// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVIsosurfaceInformation
 * @brief   what the last image of a progressive isosurface cost, over all processes that draw it
 *
 * Gathered from a vtkProgressiveIsosurfaceRepresentation. Processes that drew nothing (a client
 * that shows what a server renders, a process without a piece) do not count. Of the others the sum
 * is taken of what each has of its own, bytes, and the slowest of what they share, the image.
 */

#ifndef vtkPVIsosurfaceInformation_h
#define vtkPVIsosurfaceInformation_h

#include "vtkPVInformation.h"
#include "vtkProgIsoRepresentationsModule.h" // for export macro

#include <vector> // for what is told of each pass

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

  /// Processes that draw a piece.
  vtkGetMacro(NumberOfProcesses, int);

  /// Passes of the process that took most; fraction of the pixels that are complete, 0 … 1, and
  /// milliseconds of the image, both of the process that is behind.
  int GetNumberOfPasses() const { return static_cast<int>(this->PassMilliseconds.size()); }
  vtkGetMacro(CompletedFraction, double);
  vtkGetMacro(TotalMilliseconds, double);

  /// Bytes of graphics memory: all of it, the compressed stream's part, and what the memory budget
  /// allows beside that part. Doubles: ParaView's panel shows no 64-bit integers.
  vtkGetMacro(GPUBytes, double);
  vtkGetMacro(CompressedBytes, double);
  vtkGetMacro(MemoryBudget, double);

  /// For each pass the milliseconds from the start of the image to its end, and the fraction of the
  /// pixels that were complete then.
  const std::vector<double>& GetPassMilliseconds() const { return this->PassMilliseconds; }
  const std::vector<double>& GetPassCompleted() const { return this->PassCompleted; }

protected:
  vtkPVIsosurfaceInformation() = default;
  ~vtkPVIsosurfaceInformation() override = default;

private:
  void Clear();

  int NumberOfProcesses = 0;
  double CompletedFraction = 0.0;
  double TotalMilliseconds = 0.0;
  double GPUBytes = 0.0;
  double CompressedBytes = 0.0;
  double MemoryBudget = 0.0;
  std::vector<double> PassMilliseconds;
  std::vector<double> PassCompleted;

  vtkPVIsosurfaceInformation(const vtkPVIsosurfaceInformation&) = delete;
  void operator=(const vtkPVIsosurfaceInformation&) = delete;
};

#endif
