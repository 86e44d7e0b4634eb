// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceStatistics
 * @brief   what the last image of a vtkProgressiveIsosurfaceMapper cost
 *
 * C++, Python and the command line share this one structure. GetPassTable() has a row for each pass
 * and these columns:
 *
 * - pass: 0, 1, …
 * - active_rays: rays that were cast, without those that miss the volume or wait for memory
 * - speculation: most blocks that a ray could request (N_spec in the paper)
 * - pairs: ray-block pairs that were intersected
 * - visible_blocks: distinct blocks that rays were intersected with (*)
 * - active_blocks: the visible blocks and the neighbours that they reach into (*)
 * - decoded_blocks: blocks that were decoded
 * - cached_blocks: cache slots in use after the pass
 * - completed: fraction of the image's pixels that are complete after the pass, 0 … 1
 * - elapsed_ms: milliseconds from the start of the image to the end of the pass
 *
 * (*) NaN unless the mapper's DetailedStatistics are on.
 *
 * An image has the pixels of the rectangle that the volume covers in the viewport. Without any
 * there is no pass.
 *
 * Times are the GPU's (timer queries), except with Mesa's llvmpipe: its timer queries are wrong, so
 * times are wall clock there.
 *
 * The GPU's figures are collected when one is asked for: that waits for the GPU.
 *
 * @sa vtkProgressiveIsosurfaceMapper
 */
#ifndef vtkProgressiveIsosurfaceStatistics_h
#define vtkProgressiveIsosurfaceStatistics_h

#include "vtkNew.h" // for the table
#include "vtkObject.h"
#include "vtkProgIsoKernelsModule.h" // for export macro

#include <functional> // for the source of the figures
#include <memory>     // for the figures
#include <string>     // for the OpenGL implementation

class vtkTable;
struct ImageStatistics;

class VTKPROGISOKERNELS_EXPORT vtkProgressiveIsosurfaceStatistics : public vtkObject
{
public:
  static vtkProgressiveIsosurfaceStatistics* New();
  vtkTypeMacro(vtkProgressiveIsosurfaceStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The passes of the image so far, one row each. GetPassValue() returns NaN if there is no such
   * pass or column.
   */
  int GetNumberOfPasses();
  double GetPassValue(int pass, const char* column);
  vtkTable* GetPassTable();
  ///@}

  /**
   * Milliseconds that this image took: wall clock in Render(), passes and compositing, but at least
   * what the GPU needed for the passes.
   */
  double GetTotalMilliseconds();

  ///@{
  /**
   * How the time before the first image of a volume splits, in milliseconds: reading (or computing)
   * and compressing the inputs, as far as Render() does it; their upload; and on the GPU, decoding,
   * if the whole volume is decoded, and finding the range of values of each block, unless it comes
   * with the volume. And the number of blocks that this had the GPU decode: those at the borders of
   * what it takes at a time count twice.
   */
  double GetInputMilliseconds();
  double GetUploadMilliseconds();
  double GetPreparationMilliseconds();
  double GetBlocksDecodedAtFirst();
  ///@}

  ///@{
  /**
   * The compiled programs of this image's stages, by the names of their GLSL files: milliseconds
   * from when a program was asked for until it was found complete, and for how many of these
   * Render() could do nothing but wait. Where the driver compiles in threads the first overlap.
   * Mappers in a window share programs: the time is that of the one who asked first.
   */
  int GetNumberOfPrograms();
  const char* GetProgram(int i);
  double GetProgramMilliseconds(int i);
  double GetProgramWaitMilliseconds(int i);
  ///@}

  ///@{
  /**
   * Bytes of GPU memory that the mapper holds: in total, for the compressed streams, and by named
   * buffer. The names of the block cache's buffers begin with "cache_".
   */
  vtkTypeInt64 GetTotalBytes();
  vtkTypeInt64 GetCompressedBytes();
  int GetNumberOfBuffers();
  const char* GetBufferName(int i);
  vtkTypeInt64 GetBufferBytes(int i);
  ///@}

  /**
   * Bytes of the computer's own memory that the mapper holds beside its inputs: the compressed form
   * of plain ones. 0 of compressed inputs, whose streams it shares.
   */
  vtkTypeInt64 GetHostBytes();

  ///@{
  /**
   * The memory budget in force, in bytes: the one set on the mapper, or else the one that it chose;
   * and the least budget that suffices for this volume and image size.
   */
  vtkTypeInt64 GetMemoryBudget();
  vtkTypeInt64 GetLeastMemoryBudget();
  ///@}

  ///@{
  /**
   * Stages that ran for this image (and for its volume), and stages left out because the scene did
   * not need them, by the names of their GLSL files. GetStageMilliseconds() sums a stage's time
   * over all passes of this image; it is 0 unless the mapper's DetailedStatistics are on.
   */
  int GetNumberOfStages();
  const char* GetStage(int i);
  double GetStageMilliseconds(int i);
  int GetNumberOfStagesLeftOut();
  const char* GetStageLeftOut(int i);
  ///@}

  ///@{
  /**
   * The levels of detail of the view, of which level 0 is the volume itself, and for how many
   * pixels the (nearest) surface that they show lies in each; where two levels blend, in the finer.
   */
  int GetNumberOfLevels();
  vtkTypeInt64 GetLevelPixels(int level);
  ///@}

  /**
   * The fraction of the image's pixels that are uncertain, 0 … 1: whose rays have passed, before
   * the surface that they show, a block of a coarser level without a hit where samples of the
   * volume itself lie on both sides of the isovalue. 0 where the volume itself is drawn, and of a
   * conservative image, whose rays look there.
   */
  double GetUncertainFraction();

  /**
   * Whether the image is complete.
   */
  bool GetConverged();

  /**
   * Renderer and version of the OpenGL context.
   */
  std::string GetGLDescription();

  /**
   * For the mapper: the figures of the last image are those that `collect` returns. It is called
   * when somebody asks for one of them, because it waits for the GPU. Null: they stay as they are.
   */
  void SetSource(std::function<ImageStatistics()> collect);
  /**
   * For the mapper: collect the figures now, if that is still to be done.
   */
  void Collect();

protected:
  vtkProgressiveIsosurfaceStatistics();
  ~vtkProgressiveIsosurfaceStatistics() override;

private:
  vtkProgressiveIsosurfaceStatistics(const vtkProgressiveIsosurfaceStatistics&) = delete;
  void operator=(const vtkProgressiveIsosurfaceStatistics&) = delete;

  const ImageStatistics& GetImage();
  void FillPassTable();

  std::function<ImageStatistics()> Source; ///< null: the image's figures are there
  std::unique_ptr<ImageStatistics> Image;
  vtkNew<vtkTable> PassTable;
};

#endif
