// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceMapper
 * @brief   progressive isosurfaces of ZFP-compressed volumes within a small memory footprint
 *
 * Renders isosurfaces of a compressed volume (see vtkCompressedVolume) by progressive speculative
 * iso-raycasting on the GPU (Usher, Dyken and Kumar, LDAV 2023). Rays advance in a wavefront. Only
 * the 4^3 blocks that they meet are decompressed, into a cache. The image shows after every pass,
 * and the slots of rays that have finished let the other rays test blocks ahead. A plain
 * vtkImageData is compressed on the fly, so that the mapper can replace vtkGPUVolumeRayCastMapper
 * in isosurface blend mode. It does no direct volume rendering. Cells that are hidden or have a
 * hidden point (vtkGhostType arrays, blanking of vtkUniformGrid) have no surface.
 *
 * The surface is that of the trilinear interpolant of the decompressed values: it separates values
 * below the isovalue from all others. The volume property gives the isovalues
 * (vtkVolumeProperty::GetIsoSurfaceValues(), at most 256 that show), their colours and opacities
 * (its transfer functions at the isovalues), shading, ambient, diffuse, specular and specular
 * power; the renderer gives the lights, at most 16 that are switched on. Rays pass through
 * translucent isosurfaces and end at opaque geometry. Clipping planes (at most 16) and cropping
 * regions are those of vtkVolumeMapper; cropping planes lie in the image's own axes.
 *
 * In an interactive window Render() performs passes for TimeAllowance seconds, shows the image as
 * far as it has come and requests another render from the interactor. It shows nothing there until
 * its shaders are compiled, which takes a driver up to some seconds the first time, and requests
 * renders likewise. Everywhere else (off-screen,
 * without an interactor, or in a window that does not swap buffers, as when ParaView takes a
 * screenshot) it completes the image. The mapper cannot recognise a vtkWindowToImageFilter on an
 * interactive window: wait for GetConverged(), or set a large time allowance, before it captures. A
 * change of camera, size, isovalue or input restarts the image. If an observer of the window's
 * AbortCheckEvent aborts a render, it stops after the current pass, and the next render continues
 * from there. The complete image does not depend on the speculation, the memory budget or the
 * number of passes per render.
 *
 * Several threads may render, each its own windows. What cannot be drawn is told once, as an error,
 * and not tried again before input or settings change. If the GPU fails, for example because it
 * runs out of memory, which may end any time, the mapper starts from scratch at the next render.
 *
 * Needs OpenGL 4.3. Add it to a scene with a vtkIsosurfaceVolume, which draws in the opaque pass; a
 * plain vtkVolume works too, but is drawn after translucent geometry.
 *
 * Events: vtkCommand::ProgressEvent after every Render() with a double*, the completed fraction;
 * CompressionEvent while plain input is compressed, likewise with the fraction that is; and
 * LoadingEvent with the fraction that is done of what only a first image takes (the upload and
 * preparation of the volume, and programs that have not run yet): before each part of it, and with
 * 1.0 after it. An observer's own renders draw nothing of the mapper meanwhile.
 *
 * @sa vtkIsosurfaceVolume vtkProgressiveIsosurfaceStatistics vtkImageZFPCompress
 */
#ifndef vtkProgressiveIsosurfaceMapper_h
#define vtkProgressiveIsosurfaceMapper_h

#include "vtkCommand.h"              // for UserEvent
#include "vtkNew.h"                  // for the statistics
#include "vtkProgIsoKernelsModule.h" // for export macro
#include "vtkVolumeMapper.h"

#include <memory> // for the implementation
#include <string> // for messages

class Status;
class vtkAlgorithmOutput;
class vtkFloatArray;
class vtkHardwareSelector;
class vtkImageData;
class vtkOpenGLRenderWindow;
class vtkProgressiveIsosurfaceStatistics;
class vtkRenderWindow;
class vtkScalarsToColors;
class vtkVolumeProperty;
struct ArrayChoice;
struct ImageStatistics;

class VTKPROGISOKERNELS_EXPORT vtkProgressiveIsosurfaceMapper : public vtkVolumeMapper
{
public:
  static vtkProgressiveIsosurfaceMapper* New();
  vtkTypeMacro(vtkProgressiveIsosurfaceMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Events beside VTK's.
  enum Events
  {
    CompressionEvent = vtkCommand::UserEvent + 4301,
    LoadingEvent
  };

  ///@{
  /**
   * Rate in bits per voxel at which plain input is compressed, above 0 and at most 32; others are
   * an error, as of vtkImageZFPCompress. Default 8. Compressed input keeps its rate. SetRate()
   * switches KeepLabels off: what is asked for is taken.
   */
  virtual void SetRate(double rate);
  vtkGetMacro(Rate, double);
  ///@}

  ///@{
  /**
   * Whether plain input that holds labels or masks is compressed at a higher rate than Rate where
   * that keeps them apart, see vtkImageZFPCompress. Default on.
   */
  vtkSetMacro(KeepLabels, bool);
  vtkGetMacro(KeepLabels, bool);
  vtkBooleanMacro(KeepLabels, bool);
  ///@}

  ///@{
  /**
   * Component of plain input that is rendered; -1: the magnitude, the length of its vectors (of an
   * array of one component its values). Default 0.
   */
  vtkSetClampMacro(Component, int, -1, VTK_INT_MAX);
  vtkGetMacro(Component, int);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples of plain input are hidden, so that the surface has holes there
   * (see vtkImageZFPCompress). Default on; off: they are an error.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * Another volume that gives the surface its colours: a vtkImageData on port 1, plain or
   * compressed, with as many samples as the first. A plain one is compressed at Rate. Null or no
   * connection (default): the surface has the colours of the isovalues.
   */
  void SetColorInputData(vtkImageData* image);
  void SetColorInputConnection(vtkAlgorithmOutput* output);
  ///@}

  ///@{
  /**
   * Array of the (plain) input that gives the surface its colours. It belongs to points or cells,
   * like the array that is rendered. Null (default) or empty: none. Ignored if port 1 is connected.
   */
  vtkSetStringMacro(ColorArrayName);
  vtkGetStringMacro(ColorArrayName);
  ///@}

  ///@{
  /**
   * Component of the volume that gives the colours; -1: its magnitude. Whoever takes it from a
   * vtkScalarsToColors sets -1 where its vector mode is MAGNITUDE. The table maps plain values: its
   * own vector mode and component do not count. Default 0.
   */
  vtkSetClampMacro(ColorComponent, int, -1, VTK_INT_MAX);
  vtkGetMacro(ColorComponent, int);
  ///@}

  ///@{
  /**
   * Maps values of the volume that gives the colours to colours: with its nodes or steps,
   * logarithmic or not, its colours below and above its range and for NaN, and its opacities. With
   * an indexed lookup the nearest sample's value is looked up, as there are no categories between
   * others. Values count as within a range, and as a category, as far as compression may have moved
   * them. Null (default): the property's transfer function does.
   */
  virtual void SetColorLookupTable(vtkScalarsToColors* table);
  vtkGetObjectMacro(ColorLookupTable, vtkScalarsToColors);
  ///@}

  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * Whether two-sided lighting (the renderer's default) lights only the side of a surface that is
   * seen, as VTK does with meshes. Default off: as with VTK's volume mapper, a light reaches both
   * sides, also from behind.
   */
  vtkSetMacro(LitLikeMeshes, bool);
  vtkGetMacro(LitLikeMeshes, bool);
  vtkBooleanMacro(LitLikeMeshes, bool);
  ///@}

  ///@{
  /**
   * The image whose cells and points a vtkHardwareSelector names where the input is only a part of
   * it, or has other ghost cells: its extent. Default empty: the input's. A point is named by the
   * corner nearest to the hit of the cell that holds it.
   */
  vtkSetVector6Macro(SelectionExtent, int);
  vtkGetVector6Macro(SelectionExtent, int);
  ///@}

  ///@{
  /**
   * Flat index of the block of a composite data set that the input is, for a vtkHardwareSelector. 0
   * (default): it is none.
   */
  vtkSetMacro(CompositeIndex, unsigned int);
  vtkGetMacro(CompositeIndex, unsigned int);
  ///@}

  ///@{
  /**
   * Whether far parts of the surface are drawn from coarser copies of the volume, its levels of
   * detail (vtkImageZFPCompress::SetLevels(); plain input gets them when it is compressed):
   *
   * - LevelOfDetailOff (default): the image is exact.
   * - LevelOfDetailOn: each part is drawn from the coarsest level whose samples are, as the camera
   *   sees them, no more than PixelTolerance pixels apart along any axis. A level goes over to the
   *   next in the last third of its depths, where their values are blended, so that nothing jumps
   *   when the camera moves. Memory and time follow the pixels, not the samples of the volume.
   * - LevelOfDetailInteractive: on while the window asks for a frame rate of 1 per second or more
   *   (vtkRenderWindow::SetDesiredUpdateRate(), which interactor styles set while the camera
   *   moves), exact when it is still.
   * - LevelOfDetailConservative: as on, but where a ray passes a block of a coarser level without a
   *   hit, and samples of the volume itself lie on both sides of the isovalue there, the ray looks
   *   at these: a ray that hits the surface of the volume itself never misses, however thin that
   * is, and its hit is behind it by less than a block of the level. Where much is thin it costs as
   *   much as the exact image, or more.
   *
   * A volume without levels is drawn exactly, with a warning; also, without one, where the colours
   * are categories, of which a coarser level has none.
   */
  enum LevelsOfDetail
  {
    LevelOfDetailOff,
    LevelOfDetailOn,
    LevelOfDetailInteractive,
    LevelOfDetailConservative
  };
  vtkSetClampMacro(LevelOfDetail, int, LevelOfDetailOff, LevelOfDetailConservative);
  vtkGetMacro(LevelOfDetail, int);
  void SetLevelOfDetailToOff() { this->SetLevelOfDetail(LevelOfDetailOff); }
  void SetLevelOfDetailToOn() { this->SetLevelOfDetail(LevelOfDetailOn); }
  void SetLevelOfDetailToInteractive() { this->SetLevelOfDetail(LevelOfDetailInteractive); }
  void SetLevelOfDetailToConservative() { this->SetLevelOfDetail(LevelOfDetailConservative); }
  ///@}

  ///@{
  /**
   * How many pixels the samples of a level of detail may be apart, 1/16 … 64. Pixels are those that
   * have a ray each: with an ImageReductionFactor coarser levels are fine enough. Default 1.
   */
  vtkSetClampMacro(PixelTolerance, double, 0.0625, 64.0);
  vtkGetMacro(PixelTolerance, double);
  ///@}

  ///@{
  /**
   * Maximum number of blocks that a ray may test in one pass, 1 (no speculation) … 64. Default 64.
   */
  vtkSetClampMacro(SpeculationLimit, int, 1, 64);
  vtkGetMacro(SpeculationLimit, int);
  ///@}

  ///@{
  /**
   * Maximum GPU memory in bytes that the mapper holds beside the compressed stream, for any view,
   * isovalue and image size; 0 (default): automatic, a quarter of the GPU's memory, but at most
   * 1 GiB for decoded blocks. If a pass needs more, fewer rays take part in it; the complete image
   * is the same. Of a budget too small to work at all a warning names the least that does, which is
   * taken instead. GetStatistics()->GetMemoryBudget() returns the budget in force.
   */
  vtkSetClampMacro(MemoryBudget, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(MemoryBudget, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Share of the memory budget, whether automatic or not, that this mapper takes, 0 … 1, where
   * several mappers show blocks of one data set. Less than what suffices is raised to that. Default
   * 1.
   */
  vtkSetClampMacro(MemoryShare, double, 0.0, 1.0);
  vtkGetMacro(MemoryShare, double);
  ///@}

  /**
   * Takes over what another mapper's properties are set to, but for the inputs and for what is not
   * the same for all blocks of a data set: MemoryShare, TimeAllowance and CompositeIndex.
   */
  void CopySettings(vtkProgressiveIsosurfaceMapper* other);

  ///@{
  /**
   * Whether a volume whose decoded samples fit the memory budget is decoded as a whole: there is no
   * cache, no ray waits, one pass completes the image, and the compressed stream leaves the GPU.
   * The image is the same. Default on.
   */
  vtkSetMacro(DecodeWholeVolume, bool);
  vtkGetMacro(DecodeWholeVolume, bool);
  vtkBooleanMacro(DecodeWholeVolume, bool);
  ///@}

  ///@{
  /**
   * Maximum size in bytes of one GPU buffer, for tests; 0 (default): what OpenGL allows. A longer
   * compressed stream is split into several buffers.
   */
  vtkSetClampMacro(LargestBuffer, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(LargestBuffer, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * For tests: a work group of its own casts each ray where fewer than one pixel of so many has a
   * ray that is not done; 0: never. -1 (default): what suits the GPU. The image is the same.
   */
  vtkSetClampMacro(PixelsPerStraggler, int, -1, VTK_INT_MAX);
  vtkGetMacro(PixelsPerStraggler, int);
  ///@}

  ///@{
  /**
   * Whether the statistics include the milliseconds of each stage and the distinct blocks of each
   * pass. Costs time and 8 bytes per cache slot. Default off.
   */
  vtkSetMacro(DetailedStatistics, bool);
  vtkGetMacro(DetailedStatistics, bool);
  vtkBooleanMacro(DetailedStatistics, bool);
  ///@}

  ///@{
  /**
   * Maximum number of passes in one Render(); 0 (default): unlimited. With a limit, an image may
   * need several renders off-screen, too.
   */
  vtkSetClampMacro(MaximumPassesPerRender, int, 0, VTK_INT_MAX);
  vtkGetMacro(MaximumPassesPerRender, int);
  ///@}

  ///@{
  /**
   * Seconds after which Render() in an interactive window starts no further pass. Default 0.05.
   */
  vtkSetClampMacro(TimeAllowance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeAllowance, double);
  ///@}

  ///@{
  /**
   * Casts one ray for a square of so many pixels of the window along each side, for renders while a
   * camera moves on slow machines: the image is the same with larger pixels. Selections are always
   * exact. Another factor restarts the image. Default 1.
   */
  vtkSetClampMacro(ImageReductionFactor, int, 1, 64);
  vtkGetMacro(ImageReductionFactor, int);
  ///@}

  ///@{
  /**
   * Whether the image of the last Render() is complete, and the fraction of its pixels that are
   * complete. An image is the rectangle that the volume covers in the viewport; where it covers
   * nothing it is complete at once.
   */
  bool GetConverged();
  double GetCompletedFraction();
  ///@}

  /**
   * Reads the inputs, and compresses plain ones, as the next Render() would do otherwise. Returns
   * false, with an error event as from Render(), if they cannot be drawn.
   */
  bool UpdateInputs();

  /**
   * What the present image has cost so far.
   */
  vtkProgressiveIsosurfaceStatistics* GetStatistics();

  /**
   * Fills `image` with the depths of the last Render(): float scalars "Depth", one for each pixel
   * of the viewport (fewer with an ImageReductionFactor) in VTK's row order. A depth is the
   * distance along the ray in world units from the camera's position (in parallel projection from
   * the camera plane), or infinity if the ray hits no surface. Returns false, with an error event,
   * if nothing has been rendered yet.
   */
  bool GetDepthImage(vtkImageData* image);

  /**
   * Whether the last Render() was for this renderer. GetHit() and GetDepthImage() read its image.
   */
  bool WasRenderedIn(vtkRenderer* renderer);

  /**
   * Finds the nearest surface at a pixel of the last Render()'s viewport, counted from the bottom
   * left: its position in world coordinates, and its isovalue. Returns false if nothing is hit
   * there or the pixel lies outside.
   */
  bool GetHit(int x, int y, double position[3], double& isovalue);

  /**
   * Whether a property makes one of its isosurfaces translucent, with an opacity between 0 and 1.
   */
  static bool IsTranslucent(vtkVolumeProperty* property);

  /**
   * Whether this mapper draws translucent isosurfaces with a property: because of its opacities, or
   * as another volume gives the colours and their table is not opaque (a lookup table with alpha,
   * or a vtkDiscretizableColorTransferFunction with EnableOpacityMapping). Both opacities multiply.
   */
  bool DrawsTranslucent(vtkVolumeProperty* property);

  /**
   * Whether a vtkDualDepthPeelingPass is rendering a volume layer by layer, which the mapper does
   * not support.
   */
  static bool IsPeeled(vtkVolume* volume);

  /**
   * For measurements: forgets all decoded blocks. The next render restarts the image and decodes
   * all blocks that it needs.
   */
  void EmptyCache();

  /**
   * For tests: decodes all samples of a compressed volume with the GPU's decoder, into `samples` in
   * x-fastest order. Returns false, with an error event, if that is not possible.
   */
  bool DecodeOnGPU(vtkRenderWindow* window, vtkImageData* compressed, vtkFloatArray* samples);

  /**
   * OpenGL errors since the graphics resources were made. They are counted only if the environment
   * variable PROGISO_GL_DEBUG is 1.
   */
  int GetNumberOfGLErrors();

  ///@{
  /**
   * For VTK's pickers: the input if they can read its point scalars, otherwise null, as for a
   * compressed volume (see vtkIsosurfacePicker). GetInput() always returns the input.
   */
  vtkDataSet* GetDataSetInput() override;
  double* GetBounds() VTK_SIZEHINT(6) override;
  using vtkVolumeMapper::GetBounds;
  ///@}

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkProgressiveIsosurfaceMapper();
  ~vtkProgressiveIsosurfaceMapper() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  double Rate = 8.0;
  int Component = 0;
  bool MaskNonFinite = true;
  bool KeepLabels = true;
  char* ColorArrayName = nullptr;
  int ColorComponent = 0;
  vtkScalarsToColors* ColorLookupTable = nullptr;
  bool LitLikeMeshes = false;
  int SelectionExtent[6] = { 0, -1, 0, -1, 0, -1 };
  unsigned int CompositeIndex = 0;
  int LevelOfDetail = LevelOfDetailOff;
  double PixelTolerance = 1.0;
  int SpeculationLimit = 64;
  vtkTypeInt64 MemoryBudget = 0;
  double MemoryShare = 1.0;
  bool DecodeWholeVolume = true;
  vtkTypeInt64 LargestBuffer = 0;
  int PixelsPerStraggler = -1;
  bool DetailedStatistics = false;
  int MaximumPassesPerRender = 0;
  double TimeAllowance = 0.05;
  int ImageReductionFactor = 1;

private:
  vtkProgressiveIsosurfaceMapper(const vtkProgressiveIsosurfaceMapper&) = delete;
  void operator=(const vtkProgressiveIsosurfaceMapper&) = delete;

  bool CanRender(vtkRenderer* renderer, vtkVolume* volume);
  ArrayChoice MakeArrayChoice();
  void WarnOfDoubts(vtkVolumeProperty* property);
  void WarnOfTightBudget();
  int CountLevels(vtkVolume* volume);
  vtkScalarsToColors* GetColorTable(vtkVolume* volume);
  bool HasCategories(vtkVolume* volume);
  void WarnOfLackOfLevels();
  bool DrawsLevels(vtkRenderWindow* window) const;
  bool UpdateColors(vtkImageData* image);
  bool BindWindow(vtkOpenGLRenderWindow* window, vtkVolume* volume);
  bool UpdateScene(vtkRenderer* renderer, vtkVolume* volume);
  bool UpdatePipeline(bool newImage, bool mayWait);
  bool StartImage(bool empty);
  bool TellLoading(double fraction);
  bool Refine(vtkOpenGLRenderWindow* window);
  void PrepareNextRender(vtkOpenGLRenderWindow* window);
  bool MayRefineLater(vtkOpenGLRenderWindow* window);
  void Select(vtkHardwareSelector* selector);
  bool Succeeds(const Status& status);
  bool Fails(const std::string& message);
  bool Continues(const Status& pipelineStatus);
  void ReleaseGraphics(vtkWindow* window);
  ImageStatistics CollectFigures(bool detailed);
  void CountPixelsOfLevels(ImageStatistics& statistics);
  bool HasImage();

  struct Internals;
  std::unique_ptr<Internals> Impl;
  vtkNew<vtkProgressiveIsosurfaceStatistics> Statistics;
};

#endif
