// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceStatistics
 * @brief   what the last image of a vtkProgressiveIsosurfaceMapper cost
 *
 * The one structure for C++, Python and the command line. Per pass, in the columns of
 * GetPassTable():
 *
 * - pass: 0, 1, …
 * - active_rays: rays that were cast (those that miss the volume or wait for memory are not)
 * - speculation: blocks that a ray might ask for (N_spec, section 4 of the paper)
 * - pairs: ray-block pairs that were intersected
 * - visible_blocks: distinct blocks that rays were intersected with (*)
 * - active_blocks: those and the neighbours that they reached into (*)
 * - decoded_blocks: blocks that were decoded
 * - cached_blocks: cache slots in use after the pass
 * - completed: fraction of the pixels that are complete after the pass, 0 … 1
 * - elapsed_ms: milliseconds from the start of the image to the end of the pass
 *
 * (*) counted where the mapper's DetailedStatistics are on, else NaN.
 *
 * Times are the GPU's (timer queries), or wall clock where the renderer is Mesa's llvmpipe, whose
 * timer queries are not credible.
 *
 * @sa vtkProgressiveIsosurfaceMapper
 */
#ifndef vtkProgressiveIsosurfaceStatistics_h
#define vtkProgressiveIsosurfaceStatistics_h

#include "vtkNew.h" // for the table
#include "vtkObject.h"
#include "vtkProgIsoKernelsModule.h" // for export macro

#include <string> // for names
#include <utility>
#include <vector>

class vtkTable;

class VTKPROGISOKERNELS_EXPORT vtkProgressiveIsosurfaceStatistics : public vtkObject
{
public:
  static vtkProgressiveIsosurfaceStatistics* New();
  vtkTypeMacro(vtkProgressiveIsosurfaceStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The passes of the image so far, one row each. GetPassValue() returns NaN where there is no such
   * pass or column.
   */
  int GetNumberOfPasses();
  double GetPassValue(int pass, const char* column);
  vtkTable* GetPassTable();
  ///@}

  /**
   * Milliseconds spent in Render() on this image: passes and compositing, wall clock.
   */
  double GetTotalMilliseconds() { return this->TotalMilliseconds; }

  ///@{
  /**
   * Bytes of GPU memory the mapper holds: in total, of the compressed streams, and by named buffer.
   * The buffers of the block cache have names that begin with "cache_".
   */
  vtkTypeInt64 GetTotalBytes();
  vtkTypeInt64 GetCompressedBytes();
  int GetNumberOfBuffers() { return static_cast<int>(this->Buffers.size()); }
  const char* GetBufferName(int i);
  vtkTypeInt64 GetBufferBytes(int i);
  ///@}

  ///@{
  /**
   * The memory budget in force, in bytes: the mapper's, or what it chose itself; and the least that
   * the volume can work with at this image size.
   */
  vtkTypeInt64 GetMemoryBudget() { return this->MemoryBudget; }
  vtkTypeInt64 GetLeastMemoryBudget() { return this->LeastMemoryBudget; }
  ///@}

  ///@{
  /**
   * Stages that ran for this image (and for its volume), and those left out because the scene did
   * not need them, by the names of their GLSL files. With the mapper's DetailedStatistics, the
   * milliseconds that a stage took for this image, all passes together; else 0.
   */
  int GetNumberOfStages() { return static_cast<int>(this->Stages.size()); }
  const char* GetStage(int i);
  double GetStageMilliseconds(int i);
  int GetNumberOfStagesLeftOut() { return static_cast<int>(this->StagesLeftOut.size()); }
  const char* GetStageLeftOut(int i);
  ///@}

  /**
   * Whether the image is complete.
   */
  bool GetConverged() { return this->Converged; }

  /**
   * Renderer and version of the OpenGL context.
   */
  std::string GetGLDescription() { return this->GLDescription; }

protected:
  vtkProgressiveIsosurfaceStatistics();
  ~vtkProgressiveIsosurfaceStatistics() override;

private:
  friend class vtkProgressiveIsosurfaceMapper; // which fills it in
  vtkProgressiveIsosurfaceStatistics(const vtkProgressiveIsosurfaceStatistics&) = delete;
  void operator=(const vtkProgressiveIsosurfaceStatistics&) = delete;

  vtkNew<vtkTable> Passes;
  double TotalMilliseconds = 0.0;
  std::vector<std::pair<std::string, vtkTypeInt64>> Buffers;
  vtkTypeInt64 MemoryBudget = 0;
  vtkTypeInt64 LeastMemoryBudget = 0;
  std::vector<std::pair<std::string, double>> Stages;
  std::vector<std::string> StagesLeftOut;
  bool Converged = false;
  std::string GLDescription;
};

#endif
