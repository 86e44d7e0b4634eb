// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkProgressiveIsosurfaceMapper
 * @brief   progressive isosurfaces of ZFP-compressed volumes within a small memory footprint
 *
 * Renders the isosurface of a compressed volume (see vtkCompressedVolume) by progressive
 * speculative iso-raycasting on the GPU: rays travel in a wavefront, only the 4^3 blocks that they
 * meet are decompressed into a cache, the image shows after every pass, and slots of rays that are
 * done let the others test blocks ahead (Usher, Dyken and Kumar, LDAV 2023). A plain vtkImageData
 * as input is compressed on the fly, so that the mapper drops in for vtkGPUVolumeRayCastMapper in
 * isosurface blend mode. Not for direct volume rendering. There is no surface in cells that are
 * hidden, nor in those with a hidden point (vtkGhostType arrays, vtkUniformGrid's blanking).
 *
 * The surface is that of the trilinear interpolant of the decompressed values, where values below
 * the isovalue meet values that are not. The isovalues are those of vtkVolumeProperty::
 * GetIsoSurfaceValues(), at most 16 that show; their colours and opacities those of the property's
 * transfer functions there; shading, ambient, diffuse, specular and specular power are the
 * property's too, the lights the renderer's, at most 16 that are switched on. Behind a translucent
 * isosurface rays go on; they end at opaque geometry. Clipping planes (at most 16) and cropping
 * regions are those of vtkVolumeMapper; cropping planes lie in the image's own axes.
 *
 * Render() in an interactive window performs passes for TimeAllowance seconds, shows what is there
 * and asks the interactor for another render; everywhere else (off-screen, no interactor, or a
 * window that does not swap buffers, as when ParaView takes a screenshot) it completes the image. A
 * vtkWindowToImageFilter on an interactive window gives no such sign: let GetConverged() be true,
 * or the time allowance be large, before it captures. A change of camera, size, isovalue or input
 * restarts the image. Where an observer of the window's AbortCheckEvent aborts a render it stops
 * after the pass under way; the next goes on from there. The complete image does not depend on the
 * speculation, the memory budget or the number of passes per render.
 *
 * Windows may be rendered by threads of their own. Where the GPU fails, for want of memory, say,
 * that is an error, nothing is drawn, and the next render begins with nothing.
 *
 * Needs OpenGL 4.3. Add it to a scene with a vtkIsosurfaceVolume, which draws in the opaque pass; a
 * plain vtkVolume works as well but is drawn after translucent geometry.
 *
 * Events: vtkCommand::ProgressEvent after every Render() with a double*, the completed fraction.
 *
 * @sa vtkIsosurfaceVolume vtkProgressiveIsosurfaceStatistics vtkImageZFPCompress
 */
#ifndef vtkProgressiveIsosurfaceMapper_h
#define vtkProgressiveIsosurfaceMapper_h

#include "vtkNew.h"                  // for the statistics
#include "vtkProgIsoKernelsModule.h" // for export macro
#include "vtkVolumeMapper.h"

#include <memory> // for the implementation

class vtkAlgorithmOutput;
class vtkFloatArray;
class vtkImageData;
class vtkProgressiveIsosurfaceStatistics;
class vtkRenderWindow;
class vtkScalarsToColors;
class vtkVolumeProperty;

class VTKPROGISOKERNELS_EXPORT vtkProgressiveIsosurfaceMapper : public vtkVolumeMapper
{
public:
  static vtkProgressiveIsosurfaceMapper* New();
  vtkTypeMacro(vtkProgressiveIsosurfaceMapper, vtkVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Rate in bits per voxel at which plain input is compressed, 9/64 … 32. Default 8. Compressed
   * input keeps its own.
   */
  vtkSetClampMacro(Rate, double, 9.0 / 64.0, 32.0);
  vtkGetMacro(Rate, double);
  ///@}

  ///@{
  /**
   * Component of plain input that is rendered. Default 0.
   */
  vtkSetClampMacro(Component, int, 0, VTK_INT_MAX);
  vtkGetMacro(Component, int);
  ///@}

  ///@{
  /**
   * Whether NaN and infinite samples of plain input are hidden, so that the surface has a hole
   * there, as vtkImageZFPCompress has it. Default off: they are an error.
   */
  vtkSetMacro(MaskNonFinite, bool);
  vtkGetMacro(MaskNonFinite, bool);
  vtkBooleanMacro(MaskNonFinite, bool);
  ///@}

  ///@{
  /**
   * Another volume that gives the surface its colours: a vtkImageData on port 1, plain or
   * compressed, with as many samples as the first. It is compressed at Rate where it is plain. Null
   * or no connection (default): the colours are those of the isovalues.
   */
  void SetColorInputData(vtkImageData* image);
  void SetColorInputConnection(vtkAlgorithmOutput* output);
  ///@}

  ///@{
  /**
   * Array of the (plain) input that gives the surface its colours: of the points or cells, as the
   * one that is rendered. Null (default) or empty: none. Port 1 goes before it.
   */
  vtkSetStringMacro(ColorArrayName);
  vtkGetStringMacro(ColorArrayName);
  ///@}

  ///@{
  /**
   * Component of the colours' volume. Default 0.
   */
  vtkSetClampMacro(ColorComponent, int, 0, VTK_INT_MAX);
  vtkGetMacro(ColorComponent, int);
  ///@}

  ///@{
  /**
   * Colours of the values of the colours' volume. Null (default): the property's transfer function.
   */
  virtual void SetColorLookupTable(vtkScalarsToColors* table);
  vtkGetObjectMacro(ColorLookupTable, vtkScalarsToColors);
  ///@}

  vtkMTimeType GetMTime() override;

  ///@{
  /**
   * Where the renderer's lighting is two-sided (its default), whether only the side of a surface
   * that is seen is lit, as VTK's meshes are. Default off: as with VTK's volume mapper a light
   * reaches both sides, also from behind.
   */
  vtkSetMacro(LitLikeMeshes, bool);
  vtkGetMacro(LitLikeMeshes, bool);
  vtkBooleanMacro(LitLikeMeshes, bool);
  ///@}

  ///@{
  /**
   * The most blocks that a ray may test in one pass, 1 (no speculation) … 64. Default 64.
   */
  vtkSetClampMacro(SpeculationLimit, int, 1, 64);
  vtkGetMacro(SpeculationLimit, int);
  ///@}

  ///@{
  /**
   * Bound in bytes on all GPU memory that the mapper holds beside the compressed stream, for any
   * view, isovalue and image size; 0 (default): automatic, a quarter of what the GPU has, but not
   * more than 1 GiB for decoded blocks. Where what a pass needs does not fit, fewer rays take part
   * in it; the complete image is the same. A budget too small to work at all is an error that names
   * the least that is enough. GetStatistics()->GetMemoryBudget() tells the bound in force.
   */
  vtkSetClampMacro(MemoryBudget, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(MemoryBudget, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Whether a volume that fits the memory budget when it is decoded is decoded at once: no cache,
   * no waiting rays, one pass, and the compressed stream leaves the GPU. Default on. Same image.
   */
  vtkSetMacro(DecodeWholeVolume, bool);
  vtkGetMacro(DecodeWholeVolume, bool);
  vtkBooleanMacro(DecodeWholeVolume, bool);
  ///@}

  ///@{
  /**
   * Bound in bytes on one GPU buffer, for tests; 0 (default): what OpenGL allows. A compressed
   * stream that is longer lies in several.
   */
  vtkSetClampMacro(LargestBuffer, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(LargestBuffer, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Whether the statistics tell the milliseconds of each stage and the distinct blocks of each
   * pass. Costs time and 8 bytes a cache slot. Default off.
   */
  vtkSetMacro(DetailedStatistics, bool);
  vtkGetMacro(DetailedStatistics, bool);
  vtkBooleanMacro(DetailedStatistics, bool);
  ///@}

  ///@{
  /**
   * The most passes in one Render(); 0 (default): no bound. With a bound, an image may need several
   * renders also off-screen.
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
   * Whether the image of the last Render() is complete, and the fraction of its pixels that are.
   */
  bool GetConverged();
  double GetCompletedFraction();
  ///@}

  /**
   * What the image cost so far.
   */
  vtkProgressiveIsosurfaceStatistics* GetStatistics();

  /**
   * Fill `image` with the depths of the last Render(): float scalars "Depth", one a pixel of the
   * viewport in VTK's row order, distance along the ray in world units from the camera's position
   * (in parallel projection from the camera plane), infinity where no surface was hit. Returns
   * false, with an error event, where nothing was rendered yet.
   */
  bool GetDepthImage(vtkImageData* image);

  /**
   * Was the last Render() for this renderer? GetHit() and GetDepthImage() tell of its picture.
   */
  bool WasRenderedIn(vtkRenderer* renderer);

  /**
   * What the last Render() has met at a pixel of its viewport, from the bottom left: the nearest
   * surface's place in world coordinates, and its isovalue. False where nothing was hit, or the
   * pixel lies outside.
   */
  bool GetHit(int x, int y, double position[3], double& isovalue);

  /**
   * Does a property make one of its isosurfaces translucent, with an opacity between 0 and 1?
   */
  static bool IsTranslucent(vtkVolumeProperty* property);

  /**
   * Is a volume being rendered by a vtkDualDepthPeelingPass, layer by layer? The mapper cannot be.
   */
  static bool IsPeeled(vtkVolume* volume);

  /**
   * For measurements: forget all decoded blocks, so that the next image begins anew and decodes
   * whatever it needs.
   */
  void EmptyCache();

  /**
   * For tests: decode all samples of a compressed volume with the GPU's decoder, into `samples` in
   * x-fastest order. Returns false, with an error event, where that is not possible.
   */
  bool DecodeOnGPU(vtkRenderWindow* window, vtkImageData* compressed, vtkFloatArray* samples);

  /**
   * OpenGL errors seen since the graphics resources were made. Counted where the environment
   * variable PROGISO_GL_DEBUG is set to 1.
   */
  int GetNumberOfGLErrors();

  ///@{
  /**
   * For VTK's pickers: the input where it has samples of points that they can read, or else null,
   * as for a compressed volume (see vtkIsosurfacePicker). GetInput() always tells the input.
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
  bool MaskNonFinite = false;
  char* ColorArrayName = nullptr;
  int ColorComponent = 0;
  vtkScalarsToColors* ColorLookupTable = nullptr;
  bool LitLikeMeshes = false;
  int SpeculationLimit = 64;
  vtkTypeInt64 MemoryBudget = 0;
  bool DecodeWholeVolume = true;
  vtkTypeInt64 LargestBuffer = 0;
  bool DetailedStatistics = false;
  int MaximumPassesPerRender = 0;
  double TimeAllowance = 0.05;

private:
  vtkProgressiveIsosurfaceMapper(const vtkProgressiveIsosurfaceMapper&) = delete;
  void operator=(const vtkProgressiveIsosurfaceMapper&) = delete;

  class Internals;
  std::unique_ptr<Internals> Impl;
  vtkNew<vtkProgressiveIsosurfaceStatistics> Statistics;
};

#endif
