// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceMapper.h"

#include "GL/Stopwatch.h"
#include "Pipeline/ProgressivePipeline.h"
#include "Scene/CompressedInput.h"
#include "Scene/SceneTranslation.h"
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkHardwareSelector.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseVectorKey.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace
{

constexpr int AloneAgain = 3; // renders of one view after which no other one is expected

// Tells contexts apart, also those that a window has one after the other. An external window says
// at each render that its context is new.
std::uint64_t ContextOf(vtkOpenGLRenderWindow* window)
{
  return window->IsA("vtkExternalOpenGLRenderWindow")
    ? static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(window))
    : static_cast<std::uint64_t>(window->GetContextCreationTime());
}

// 256 colours over a table's range, which is in the units of the stream there, as in Shading.glsl.
std::vector<float> MakePalette(vtkScalarsToColors* table, vtkCompressedVolume* source)
{
  const int colors = 256;
  const double* range = table->GetRange();
  const double extent = range[1] - range[0];
  std::vector<float> palette = { static_cast<float>(source->ToStored(range[0])),
    extent > 0.0 ? static_cast<float>(source->GetScale() / extent) : 0.0f, 0.0f, 0.0f };
  for (int i = 0; i < colors; ++i)
  {
    double color[3];
    table->GetColor(range[0] + extent * i / (colors - 1), color);
    for (double channel : { color[0], color[1], color[2], 1.0 })
    {
      palette.push_back(static_cast<float>(channel));
    }
  }
  return palette;
}

// The samples of blocks, 64 each, in x-fastest order.
void CopyBlocks(
  const std::vector<float>& values, vtkCompressedVolume* source, vtkFloatArray* samples)
{
  int dims[3], blocks[3];
  source->GetDimensions(dims);
  source->GetBlocks(blocks);
  samples->SetNumberOfComponents(1);
  samples->SetNumberOfTuples(static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2]);
  vtkIdType sample = 0;
  for (int z = 0; z < dims[2]; ++z)
  {
    for (int y = 0; y < dims[1]; ++y)
    {
      for (int x = 0; x < dims[0]; ++x)
      {
        const std::int64_t block =
          x / 4 + blocks[0] * (y / 4 + static_cast<std::int64_t>(blocks[1]) * (z / 4));
        samples->SetValue(sample++, values[64 * block + x % 4 + 4 * (y % 4) + 16 * (z % 4)]);
      }
    }
  }
}

// What a picture of the viewport is drawn with, until it goes out of scope. Blended colours have
// been multiplied by their opacities and leave the depths as they are.
class DrawingState
{
public:
  DrawingState(vtkOpenGLState* state, bool blended)
    : Blend(state, GL_BLEND)
    , DepthTest(state, GL_DEPTH_TEST)
    , CullFace(state, GL_CULL_FACE)
    , DepthMask(state)
    , DepthFunction(state)
    , BlendFunction(state)
  {
    state->vtkglDisable(GL_CULL_FACE);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthFunc(GL_LEQUAL);
    state->vtkglDepthMask(blended ? GL_FALSE : GL_TRUE);
    state->SetEnumState(GL_BLEND, blended);
    if (blended)
    {
      state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }
  }
  DrawingState(const DrawingState&) = delete;
  void operator=(const DrawingState&) = delete;

private:
  vtkOpenGLState::ScopedglEnableDisable Blend, DepthTest, CullFace;
  vtkOpenGLState::ScopedglDepthMask DepthMask;
  vtkOpenGLState::ScopedglDepthFunc DepthFunction;
  vtkOpenGLState::ScopedglBlendFuncSeparate BlendFunction;
};
}

//------------------------------------------------------------------------------
// What the mapper holds behind its interface
//------------------------------------------------------------------------------
class vtkProgressiveIsosurfaceMapper::Internals
{
public:
  explicit Internals(vtkProgressiveIsosurfaceMapper* owner)
    : Owner(owner)
  {
  }
  ~Internals();

  bool UpdateVolume();
  bool CheckLimits(vtkRenderer* renderer, vtkVolume* volume);
  bool BindWindow(vtkOpenGLRenderWindow* window);
  void HandOverVolume();
  bool UpdateScene(vtkRenderer* renderer, vtkVolume* volume);
  bool Refine(vtkOpenGLRenderWindow* window);
  bool Complete();
  void Select(vtkHardwareSelector* selector, vtkOpenGLRenderWindow* window);
  void Composite(vtkOpenGLRenderWindow* window);
  void RequestRender(vtkOpenGLRenderWindow* window);
  void FillStatistics();
  void ReleaseGraphics(vtkWindow* window);
  bool Report(const std::string& problem);
  bool ReportPipeline();

  vtkProgressiveIsosurfaceMapper* Owner;
  ProgressivePipeline Pipeline;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  const vtkWindow* WindowInUse = nullptr; ///< the same, also while it is being destroyed
  std::uint64_t Context = 0;              ///< its, where the graphics resources are

  CompressedInput Values;
  CompressedInput Colors;    // of no image: another volume gives no colours
  vtkTimeStamp HandOverTime; // of both, to the pipeline
  std::vector<float> Palette;

  PipelineScene Scene;
  bool HaveScene = false;
  vtkNew<vtkMatrix4x4> EyeToWorld;        // of Scene
  std::pair<int, vtkMTimeType> Obstacles; // of Scene: how many props, and when they last changed
  std::pair<vtkRenderer*, int> View;      // renderer and eye of the last render
  int ViewSize[2] = { 0, 0 };             // of its viewport
  int RendersOfView = AloneAgain;         // since another view was rendered
  double TotalMilliseconds = 0.0;

  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  unsigned long TimerObserver = 0;
  int TimerId = -1;

private:
  vtkDataArray* FindArray(vtkImageData* image, bool& cellData);
  vtkDataArray* FindColorArray(vtkImageData* image);
  bool Take(
    vtkImageData* image, vtkDataArray* array, bool cellData, int component, CompressedInput& into);
  bool UpdateValues(vtkImageData* image);
  bool UpdateColors(vtkImageData* image);
  std::pair<int, vtkMTimeType> FindObstacles(vtkRenderer* renderer, vtkVolume* volume) const;
  bool UpdatePalette(vtkVolumeProperty* property);
  bool MayRefineLater(vtkOpenGLRenderWindow* window) const;
  void OnTimer(vtkObject*, unsigned long, void* data);
};

vtkProgressiveIsosurfaceMapper::Internals::~Internals()
{
  this->ReleaseGraphics(this->Window);
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->TimerObserver);
  }
}

// What the stages have room for, and isovalues that are numbers.
bool vtkProgressiveIsosurfaceMapper::Internals::CheckLimits(
  vtkRenderer* renderer, vtkVolume* volume)
{
  vtkVolumeProperty* property = volume->GetProperty();
  vtkContourValues* values = property->GetIsoSurfaceValues();
  int shown = 0, lit = 0;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    if (std::isnan(values->GetValue(i)))
    {
      return this->Report("cannot show isovalue " + std::to_string(i) + ": it is not a number");
    }
    shown += property->GetScalarOpacity()->GetValue(values->GetValue(i)) > 0.0 ? 1 : 0;
  }
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(iterator);
  for (vtkLight* light = lights->GetNextLight(iterator); light;
       light = lights->GetNextLight(iterator))
  {
    lit += property->GetShade() && light->GetSwitch() ? 1 : 0;
  }
  const int planes =
    this->Owner->ClippingPlanes ? this->Owner->ClippingPlanes->GetNumberOfItems() : 0;
  const auto check = [this](int count, int most, const char* what)
  {
    return count <= most ||
      this->Report("takes at most " + std::to_string(most) + " " + what + ", but there are " +
        std::to_string(count) + ": take some away, or share them among several mappers");
  };
  return check(shown, glsl::MAX_ISOVALUES, "isovalues that show") &&
    check(planes, glsl::MAX_CLIPPING_PLANES, "clipping planes") &&
    check(lit, glsl::MAX_LIGHTS, "lights that are switched on");
}

bool vtkProgressiveIsosurfaceMapper::Internals::Report(const std::string& problem)
{
  vtkErrorWithObjectMacro(this->Owner, << problem);
  return false;
}

// What failed may have left anything behind: the next render begins with nothing.
bool vtkProgressiveIsosurfaceMapper::Internals::ReportPipeline()
{
  const std::string problem = this->Pipeline.GetStatus().GetMessage();
  this->ReleaseGraphics(this->Window);
  return this->Report(problem);
}

//------------------------------------------------------------------------------
// The input
//------------------------------------------------------------------------------
vtkDataArray* vtkProgressiveIsosurfaceMapper::Internals::FindArray(
  vtkImageData* image, bool& cellData)
{
  if (this->Owner->ScalarMode == VTK_SCALAR_MODE_DEFAULT)
  {
    int association = vtkCompressedVolume::PointData;
    vtkDataArray* array = vtkImageZFPCompress::FindDefaultArray(image, association);
    cellData = association == vtkCompressedVolume::CellData;
    return array;
  }
  int cellFlag = 0;
  vtkDataArray* array = vtkAbstractMapper::GetScalars(image, this->Owner->ScalarMode,
    this->Owner->ArrayAccessMode, this->Owner->ArrayId, this->Owner->ArrayName, cellFlag);
  cellData = cellFlag == 1;
  return array;
}

// Makes sure that `into` is of this image, or of its array where it is plain.
bool vtkProgressiveIsosurfaceMapper::Internals::Take(
  vtkImageData* image, vtkDataArray* array, bool cellData, int component, CompressedInput& into)
{
  const CompressedInput::Choice choice = { image, array, cellData, component, this->Owner->Rate,
    this->Owner->MaskNonFinite };
  return into.Take(choice) || (!into.GetError().empty() && this->Report(into.GetError()));
}

bool vtkProgressiveIsosurfaceMapper::Internals::UpdateValues(vtkImageData* image)
{
  const bool compressed = vtkCompressedVolume::IsCompressed(image);
  bool cellData = false;
  vtkDataArray* array = compressed ? nullptr : this->FindArray(image, cellData);
  if (!compressed && !array)
  {
    return this->Report("the input image has no scalars: select an array that it has");
  }
  return this->Take(image, array, cellData, this->Owner->Component, this->Values);
}

// The array of ColorArrayName, beside the one that is rendered.
vtkDataArray* vtkProgressiveIsosurfaceMapper::Internals::FindColorArray(vtkImageData* image)
{
  const char* name = this->Owner->ColorArrayName;
  vtkDataSetAttributes* attributes =
    this->Values.GetVolume()->GetAssociation() == vtkCompressedVolume::CellData
    ? static_cast<vtkDataSetAttributes*>(image->GetCellData())
    : image->GetPointData();
  vtkDataArray* array = attributes->GetArray(name);
  if (!array)
  {
    this->Report(std::string("the input has no array \"") + name +
      "\" beside the one that is rendered: name one that it has, or connect the colours' volume to "
      "port 1");
  }
  return array;
}

// The volume that gives the colours: of port 1, or of another array of the input.
bool vtkProgressiveIsosurfaceMapper::Internals::UpdateColors(vtkImageData* image)
{
  vtkProgressiveIsosurfaceMapper* self = this->Owner;
  const bool named = self->ColorArrayName && *self->ColorArrayName;
  const bool connected = self->GetNumberOfInputConnections(1) > 0;
  if (!connected && !named)
  {
    this->Colors.Release();
    return true;
  }
  if (connected)
  {
    self->GetInputAlgorithm(1, 0)->Update();
    image = vtkImageData::SafeDownCast(self->GetInputDataObject(1, 0));
  }
  const bool compressed = connected && image && vtkCompressedVolume::IsCompressed(image);
  bool cellData = this->Values.GetVolume()->GetAssociation() == vtkCompressedVolume::CellData;
  vtkDataArray* array = nullptr;
  if (image && !compressed)
  {
    array = connected ? this->FindArray(image, cellData) : this->FindColorArray(image);
  }
  if (!image || (!compressed && !array))
  {
    return connected ? this->Report("the colours' volume has no scalars") : false;
  }
  if (!this->Take(image, array, cellData, self->ColorComponent, this->Colors))
  {
    return false;
  }
  const int* values = this->Values.GetVolume()->GetDimensions();
  const int* colors = this->Colors.GetVolume()->GetDimensions();
  return std::equal(values, values + 3, colors) ||
    this->Report("the colours' volume has other dimensions than the one that is rendered: resample "
                 "it to the same");
}

// Makes sure that what is compressed is of the present input.
bool vtkProgressiveIsosurfaceMapper::Internals::UpdateVolume()
{
  vtkProgressiveIsosurfaceMapper* self = this->Owner;
  if (!self->GetInputAlgorithm())
  {
    return this->Report("has no input: connect a vtkImageData, plain or compressed");
  }
  self->GetInputAlgorithm()->Update();
  vtkImageData* image = vtkImageData::SafeDownCast(self->GetInput());
  if (!image)
  {
    return this->Report("needs a vtkImageData as input");
  }
  return this->UpdateValues(image) && this->UpdateColors(image);
}

//------------------------------------------------------------------------------
// The GPU's objects
//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceMapper::Internals::BindWindow(vtkOpenGLRenderWindow* window)
{
  const std::uint64_t context = ContextOf(window);
  if (this->WindowInUse && (this->Window != window || this->Context != context))
  {
    this->ReleaseGraphics(this->Window);
    window->MakeCurrent();
  }
  this->Window = window;
  this->WindowInUse = window;
  this->Context = context;
  window->GetShaderCache()->ReleaseCurrentShader();
  return this->Pipeline.Initialize(context) || this->ReportPipeline();
}

void vtkProgressiveIsosurfaceMapper::Internals::ReleaseGraphics(vtkWindow* window)
{
  auto* alive = vtkOpenGLRenderWindow::SafeDownCast(window);
  if (alive && ContextOf(alive) == this->Context)
  {
    window->MakeCurrent();
    this->Pipeline.Release();
  }
  else if (this->WindowInUse)
  {
    this->Pipeline = ProgressivePipeline(); // with their context the objects are gone
  }
  this->Window = nullptr;
  this->WindowInUse = nullptr;
  this->HandOverTime = vtkTimeStamp();
  this->HaveScene = false;
}

void vtkProgressiveIsosurfaceMapper::Internals::HandOverVolume()
{
  if (this->HandOverTime < std::max(this->Values.GetTime(), this->Colors.GetTime()))
  {
    this->HaveScene = false;
    PipelineVolume volume = DescribeVolume(this->Values.GetVolume());
    if (this->Colors.GetImage())
    {
      volume.Colors = DescribeStream(this->Colors.GetVolume());
    }
    this->Pipeline.SetVolume(volume);
    this->HandOverTime.Modified();
  }
}

//------------------------------------------------------------------------------
// The image
//------------------------------------------------------------------------------
// What may hide a translucent surface: all that shows and is not flat on the window.
std::pair<int, vtkMTimeType> vtkProgressiveIsosurfaceMapper::Internals::FindObstacles(
  vtkRenderer* renderer, vtkVolume* volume) const
{
  std::pair<int, vtkMTimeType> found = { 0, 0 };
  vtkCollectionSimpleIterator iterator;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(iterator);
  for (vtkProp* prop = props->GetNextProp(iterator); prop; prop = props->GetNextProp(iterator))
  {
    if (prop != volume && prop->GetVisibility() && !prop->IsA("vtkActor2D"))
    {
      ++found.first;
      found.second = std::max(found.second, prop->GetRedrawMTime());
    }
  }
  return found;
}

// False where the colours of the other volume have changed.
bool vtkProgressiveIsosurfaceMapper::Internals::UpdatePalette(vtkVolumeProperty* property)
{
  vtkScalarsToColors* table = this->Owner->ColorLookupTable ? this->Owner->ColorLookupTable
                                                            : property->GetRGBTransferFunction();
  const std::vector<float> palette =
    this->Colors.GetImage() ? MakePalette(table, this->Colors.GetVolume()) : std::vector<float>();
  const bool same = palette == this->Palette;
  if (!same || !this->HaveScene)
  {
    this->Palette = palette;
    this->Pipeline.SetPalette(palette);
  }
  return same;
}

// Restarts the image where its hits change. A new look is a matter of the composite alone, but not
// where layers were blended.
bool vtkProgressiveIsosurfaceMapper::Internals::UpdateScene(
  vtkRenderer* renderer, vtkVolume* volume)
{
  // not the renderer's size: a pass may draw into a framebuffer of its own, larger than the window
  int place[4];
  this->Window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, place);
  int origin[2];
  renderer->GetTiledSizeAndOrigin(&this->ViewSize[0], &this->ViewSize[1], &origin[0], &origin[1]);
  const int viewport[4] = { place[2], place[3], place[0], place[1] };
  PipelineScene scene = TranslateScene(
    renderer, volume, this->Owner, this->Values.GetImage(), this->Values.GetVolume(), viewport);
  if (!HasRays(scene.View))
  {
    return this->Report("cannot show its input: the image's spacing, origin and directions, the "
                        "volume's matrix and the camera must be finite, and none of them flat");
  }
  if (this->Owner->LitLikeMeshes && scene.Look.LitSides == glsl::TWO_SIDED)
  {
    scene.Look.LitSides = glsl::LIT_LIKE_MESHES;
  }
  vtkCamera* camera = renderer->GetActiveCamera();
  vtkMatrix4x4::Invert(camera->GetModelViewTransformMatrix(), this->EyeToWorld);
  const auto obstacles =
    scene.Translucent ? this->FindObstacles(renderer, volume) : std::pair<int, vtkMTimeType>();
  scene.Obstructed = obstacles.first > 0;
  const bool samePalette = this->UpdatePalette(volume->GetProperty());
  const std::pair<vtkRenderer*, int> view = { renderer, camera->GetLeftEye() };
  const bool otherView = this->View.first && view != this->View;
  this->RendersOfView = otherView ? 0 : this->RendersOfView + 1;
  const bool sameHits = this->HaveScene && view == this->View &&
    SameHits(this->Scene.View, scene.View) &&
    (!scene.Translucent ||
      (SameLook(this->Scene.Look, scene.Look) && samePalette && obstacles == this->Obstacles));
  this->View = view;
  this->Obstacles = obstacles;
  if (sameHits)
  {
    scene.View = this->Scene.View;
  }
  this->Scene = scene;
  this->HaveScene = true;
  PipelineSettings settings;
  settings.MemoryBudget = this->Owner->MemoryBudget;
  settings.LargestBuffer = this->Owner->LargestBuffer;
  settings.SpeculationLimit = this->Owner->SpeculationLimit;
  settings.DecodeWholeVolume = this->Owner->DecodeWholeVolume;
  settings.Detailed = this->Owner->DetailedStatistics;
  if (!this->Pipeline.SetScene(scene, settings, !sameHits))
  {
    return this->ReportPipeline();
  }
  if (!this->Pipeline.IsStarted())
  {
    const Stopwatch stopwatch;
    this->Pipeline.Start();
    this->TotalMilliseconds = stopwatch.GetMilliseconds();
  }
  return true;
}

// Whether somebody will render again if the image stays incomplete now. Where several views, or
// eyes, take turns each of them begins anew: none would ever be complete.
bool vtkProgressiveIsosurfaceMapper::Internals::MayRefineLater(vtkOpenGLRenderWindow* window) const
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  return this->RendersOfView >= AloneAgain && interactor && interactor->GetInitialized() &&
    !window->GetOffScreenRendering() && window->GetSwapBuffers();
}

// Passes, as many as there is time for, and the image as far as it has come.
bool vtkProgressiveIsosurfaceMapper::Internals::Refine(vtkOpenGLRenderWindow* window)
{
  const Stopwatch stopwatch;
  const bool interactive = this->MayRefineLater(window);
  const double allowance = this->Owner->TimeAllowance;
  auto stop = [&]()
  {
    const bool late = interactive && stopwatch.GetMilliseconds() >= 1e3 * allowance;
    const bool aborted = window->CheckAbortStatus() != 0; // asks observers, who may do anything
    if (!window->IsCurrent())
    {
      window->MakeCurrent();
    }
    return late || aborted || this->Window != window;
  };
  const bool unfinished = !this->Pipeline.GetConverged();
  if (unfinished)
  {
    this->Pipeline.RunPasses(this->Owner->MaximumPassesPerRender, interactive, stop);
  }
  if (this->Window != window)
  {
    return false; // an observer has released what was to be drawn
  }
  if (this->Pipeline.CheckMemory())
  {
    this->Composite(window);
  }
  if (!this->Pipeline.GetStatus())
  {
    return this->ReportPipeline();
  }
  this->Pipeline.CompleteStatistics();
  if (unfinished)
  {
    this->TotalMilliseconds += stopwatch.GetMilliseconds();
  }
  return true;
}

void vtkProgressiveIsosurfaceMapper::Internals::Composite(vtkOpenGLRenderWindow* window)
{
  const DrawingState drawing(window->GetState(), this->Scene.Translucent);
  this->Pipeline.Composite();
}

// All passes that are still needed.
bool vtkProgressiveIsosurfaceMapper::Internals::Complete()
{
  if (!this->Pipeline.GetConverged())
  {
    this->Pipeline.RunPasses(0, false, []() { return false; });
  }
  return this->Pipeline.GetStatus() || this->ReportPipeline();
}

// A selector has props and cells drawn as colours, pass by pass.
void vtkProgressiveIsosurfaceMapper::Internals::Select(
  vtkHardwareSelector* selector, vtkOpenGLRenderWindow* window)
{
  selector->BeginRenderProp();
  float id[3];
  selector->GetPropColorValue(id);
  const int pass = selector->GetCurrentPass();
  std::array<float, 4> selected = { { 0.0f, 0.0f, 0.0f, 0.0f } };
  if (pass == vtkHardwareSelector::ACTOR_PASS)
  {
    std::copy(id, id + 3, selected.begin());
  }
  else if (pass == vtkHardwareSelector::CELL_ID_LOW24 ||
    pass == vtkHardwareSelector::CELL_ID_HIGH24)
  {
    selected[3] = pass == vtkHardwareSelector::CELL_ID_LOW24 ? 1.0f : 2.0f;
  }
  vtkIdType cells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells *= this->Values.GetVolume()->GetDimensions()[axis] - 1;
  }
  selector->UpdateMaximumCellId(cells);
  const DrawingState drawing(window->GetState(), false);
  this->Pipeline.Select(selected);
  selector->EndRenderProp();
}

// Asks the interactor for another render as soon as it is idle.
void vtkProgressiveIsosurfaceMapper::Internals::RequestRender(vtkOpenGLRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  if (this->Pipeline.GetConverged() || !this->MayRefineLater(window))
  {
    return;
  }
  if (this->Interactor != interactor)
  {
    if (this->Interactor)
    {
      this->Interactor->RemoveObserver(this->TimerObserver);
    }
    this->Interactor = interactor;
    this->TimerObserver =
      interactor->AddObserver(vtkCommand::TimerEvent, this, &Internals::OnTimer);
    this->TimerId = -1;
  }
  if (this->TimerId < 0)
  {
    this->TimerId = interactor->CreateOneShotTimer(1);
  }
}

void vtkProgressiveIsosurfaceMapper::Internals::OnTimer(vtkObject*, unsigned long, void* data)
{
  if (!data || *static_cast<int*>(data) != this->TimerId)
  {
    return;
  }
  this->TimerId = -1;
  if (this->Interactor)
  {
    this->Interactor->Render();
  }
}

void vtkProgressiveIsosurfaceMapper::Internals::FillStatistics()
{
  vtkProgressiveIsosurfaceStatistics* statistics = this->Owner->Statistics;
  vtkTable* table = statistics->Passes;
  const std::vector<TimedPass>& passes = this->Pipeline.GetPasses();
  const double pixels =
    static_cast<double>(this->Scene.View.ImageSize[0]) * this->Scene.View.ImageSize[1];
  const double uncounted = this->Owner->DetailedStatistics ? 0.0 : vtkMath::Nan();
  table->SetNumberOfRows(static_cast<vtkIdType>(passes.size()));
  for (std::size_t i = 0; i < passes.size(); ++i)
  {
    const TimedPass& p = passes[i];
    const double row[] = { static_cast<double>(i), static_cast<double>(p.ActiveRays),
      static_cast<double>(p.Speculation), static_cast<double>(p.Pairs), p.VisibleBlocks + uncounted,
      p.ActiveBlocks + uncounted, static_cast<double>(p.DecodedBlocks),
      static_cast<double>(p.CachedBlocks), 1.0 - p.RemainingRays / pixels, p.ElapsedMilliseconds };
    for (int column = 0; column < table->GetNumberOfColumns(); ++column)
    {
      vtkDoubleArray::SafeDownCast(table->GetColumn(column))
        ->SetValue(static_cast<vtkIdType>(i), row[column]);
    }
  }
  const auto memory = this->Pipeline.GetMemoryUse();
  statistics->Buffers.assign(memory.begin(), memory.end());
  statistics->Stages.clear();
  statistics->StagesLeftOut.clear();
  const std::map<Stage, double>& milliseconds = this->Pipeline.GetStages();
  for (const StageInfo& info : PipelineStages())
  {
    const auto found = milliseconds.find(info.Id);
    if (found != milliseconds.end())
    {
      statistics->Stages.emplace_back(info.Name, found->second);
    }
    else
    {
      statistics->StagesLeftOut.emplace_back(info.Name);
    }
  }
  statistics->MemoryBudget = this->Pipeline.GetMemoryPlan().Budget;
  statistics->LeastMemoryBudget = this->Pipeline.GetMemoryPlan().LeastBudget;
  statistics->TotalMilliseconds = this->TotalMilliseconds;
  statistics->Converged = this->Pipeline.GetConverged();
  statistics->GLDescription = ::Context::GetDescription();
  statistics->Modified();
}

//------------------------------------------------------------------------------
// The mapper
//------------------------------------------------------------------------------
vtkStandardNewMacro(vtkProgressiveIsosurfaceMapper);

vtkProgressiveIsosurfaceMapper::vtkProgressiveIsosurfaceMapper()
  : Impl(new Internals(this))
{
  this->SetNumberOfInputPorts(2);
}

vtkProgressiveIsosurfaceMapper::~vtkProgressiveIsosurfaceMapper()
{
  this->SetColorArrayName(nullptr);
  this->SetColorLookupTable(nullptr);
}

vtkCxxSetObjectMacro(vtkProgressiveIsosurfaceMapper, ColorLookupTable, vtkScalarsToColors);

void vtkProgressiveIsosurfaceMapper::SetColorInputData(vtkImageData* image)
{
  this->SetInputDataInternal(1, image);
}

void vtkProgressiveIsosurfaceMapper::SetColorInputConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

vtkMTimeType vtkProgressiveIsosurfaceMapper::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->ColorLookupTable ? std::max(own, this->ColorLookupTable->GetMTime()) : own;
}

void vtkProgressiveIsosurfaceMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << "\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "ColorArrayName: " << (this->ColorArrayName ? this->ColorArrayName : "(none)")
     << "\n";
  os << indent << "ColorComponent: " << this->ColorComponent << "\n";
  os << indent << "ColorLookupTable: " << this->ColorLookupTable << "\n";
  os << indent << "LitLikeMeshes: " << this->LitLikeMeshes << "\n";
  os << indent << "SpeculationLimit: " << this->SpeculationLimit << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "DecodeWholeVolume: " << this->DecodeWholeVolume << "\n";
  os << indent << "LargestBuffer: " << this->LargestBuffer << "\n";
  os << indent << "DetailedStatistics: " << this->DetailedStatistics << "\n";
  os << indent << "MaximumPassesPerRender: " << this->MaximumPassesPerRender << "\n";
  os << indent << "TimeAllowance: " << this->TimeAllowance << "\n";
  os << indent << "Statistics:\n";
  this->Statistics->PrintSelf(os, indent.GetNextIndent());
}

int vtkProgressiveIsosurfaceMapper::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

bool vtkProgressiveIsosurfaceMapper::GetConverged()
{
  return this->Impl->Pipeline.GetConverged();
}

double vtkProgressiveIsosurfaceMapper::GetCompletedFraction()
{
  return this->Impl->Pipeline.GetCompletedFraction();
}

vtkProgressiveIsosurfaceStatistics* vtkProgressiveIsosurfaceMapper::GetStatistics()
{
  return this->Statistics;
}

int vtkProgressiveIsosurfaceMapper::GetNumberOfGLErrors()
{
  return this->Impl->Pipeline.GetNumberOfGLErrors();
}

void vtkProgressiveIsosurfaceMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window)
  {
    vtkErrorMacro("needs an OpenGL render window");
    return;
  }
  if (IsPeeled(volume))
  {
    vtkErrorMacro("cannot be peeled with other volumes: switch vtkRenderer's "
                  "UseDepthPeelingForVolumes off, or use a vtkIsosurfaceVolume");
    return;
  }
  const vtkSmartPointer<vtkProgressiveIsosurfaceMapper> alive = this; // whatever observers do
  vtkHardwareSelector* selector = renderer->GetSelector();
  if (!this->Impl->CheckLimits(renderer, volume) || !this->Impl->UpdateVolume())
  {
    return;
  }
  window->MakeCurrent();
  if (!this->Impl->BindWindow(window))
  {
    return;
  }
  this->Impl->HandOverVolume();
  if (!this->Impl->UpdateScene(renderer, volume))
  {
    return;
  }
  if (selector)
  {
    if (this->Impl->Complete())
    {
      this->Impl->Select(selector, window);
    }
    return;
  }
  if (!this->Impl->Refine(window))
  {
    return;
  }
  this->Impl->FillStatistics();
  double fraction = this->GetCompletedFraction();
  this->InvokeEvent(vtkCommand::ProgressEvent, &fraction);
  if (this->Impl->Window == window)
  {
    this->Impl->RequestRender(window);
  }
  if (!window->IsCurrent())
  {
    window->MakeCurrent();
  }
}

void vtkProgressiveIsosurfaceMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  // A window that is being destroyed says so here too, when weak pointers to it are null already.
  if (!window || window == this->Impl->WindowInUse)
  {
    this->Impl->ReleaseGraphics(window ? window : this->Impl->Window.Get());
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkProgressiveIsosurfaceMapper::EmptyCache()
{
  this->Impl->Pipeline.EmptyCache();
}

// vtkCellPicker and its like would read from a null pointer otherwise.
vtkDataSet* vtkProgressiveIsosurfaceMapper::GetDataSetInput()
{
  vtkDataSet* input = this->GetInput();
  return input && input->GetPointData()->GetScalars() ? input : nullptr;
}

double* vtkProgressiveIsosurfaceMapper::GetBounds()
{
  if (!this->GetInput())
  {
    vtkMath::UninitializeBounds(this->Bounds);
    return this->Bounds;
  }
  this->Update();
  this->GetInput()->GetBounds(this->Bounds);
  return this->Bounds;
}

bool vtkProgressiveIsosurfaceMapper::IsTranslucent(vtkVolumeProperty* property)
{
  vtkContourValues* values = property->GetIsoSurfaceValues();
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double opacity = property->GetScalarOpacity()->GetValue(values->GetValue(i));
    if (opacity > 0.0 && opacity < 1.0)
    {
      return true;
    }
  }
  return false;
}

bool vtkProgressiveIsosurfaceMapper::IsPeeled(vtkVolume* volume)
{
  vtkInformation* keys = volume->GetPropertyKeys();
  vtkInformationObjectBaseVectorKey* key = vtkOpenGLRenderPass::RenderPasses();
  for (int i = 0; keys && i < keys->Length(key); ++i)
  {
    if (key->Get(keys, i)->IsA("vtkDualDepthPeelingPass"))
    {
      return true;
    }
  }
  return false;
}

bool vtkProgressiveIsosurfaceMapper::WasRenderedIn(vtkRenderer* renderer)
{
  return this->Impl->HaveScene && this->Impl->Window && this->Impl->View.first == renderer;
}

bool vtkProgressiveIsosurfaceMapper::GetHit(int x, int y, double position[3], double& isovalue)
{
  Internals* impl = this->Impl.get();
  const glsl::View& view = impl->Scene.View;
  const int* size = impl->ViewSize;
  if (!impl->HaveScene || !impl->Window || x < 0 || y < 0 || x >= size[0] || y >= size[1])
  {
    return false;
  }
  // a pass may have drawn a larger image than the viewport
  x = static_cast<int>((x + 0.5) * view.ImageSize[0] / size[0]);
  y = static_cast<int>((y + 0.5) * view.ImageSize[1] / size[1]);
  impl->Window->MakeCurrent();
  const PixelHit hit =
    impl->Pipeline.GetHits().Read(static_cast<std::int64_t>(y) * view.ImageSize[0] + x);
  if (hit.Key == PixelHit().Key)
  {
    return false;
  }
  const double t = impl->Scene.Translucent ? hit.Depth : HitParameter(view, x, y, hit.Key);
  double point[4] = { 0.0, 0.0, 0.0, 1.0 };
  EyePosition(view, x, y, t, point);
  impl->EyeToWorld->MultiplyPoint(point, point);
  std::copy(point, point + 3, position);
  isovalue = impl->Values.GetVolume()->ToSample(
    double(view.Isovalues[hit.Isovalue].High) + view.Isovalues[hit.Isovalue].Low);
  return true;
}

bool vtkProgressiveIsosurfaceMapper::GetDepthImage(vtkImageData* image)
{
  if (!image || !this->Impl->HaveScene || !this->Impl->Window)
  {
    vtkErrorMacro("has no depths yet: render first");
    return false;
  }
  this->Impl->Window->MakeCurrent();
  const glsl::View& view = this->Impl->Scene.View;
  const std::vector<std::uint32_t> keys = this->Impl->Pipeline.GetHits().ReadKeys();
  const bool translucent = this->Impl->Scene.Translucent; // the keys are those of the last hits
  const std::vector<float> first =
    translucent ? this->Impl->Pipeline.GetHits().ReadDepths() : std::vector<float>();
  vtkNew<vtkFloatArray> depths;
  depths->SetName("Depth");
  depths->SetNumberOfValues(static_cast<vtkIdType>(keys.size()));
  for (int y = 0; y < view.ImageSize[1]; ++y)
  {
    for (int x = 0; x < view.ImageSize[0]; ++x)
    {
      const vtkIdType pixel = static_cast<vtkIdType>(y) * view.ImageSize[0] + x;
      const double last = HitParameter(view, x, y, keys[pixel]);
      const double t = translucent && std::isfinite(last) ? first[pixel] : last;
      depths->SetValue(pixel, static_cast<float>(RayLength(view, x, y, t)));
    }
  }
  image->SetDimensions(view.ImageSize[0], view.ImageSize[1], 1);
  image->GetPointData()->SetScalars(depths);
  return true;
}

bool vtkProgressiveIsosurfaceMapper::DecodeOnGPU(
  vtkRenderWindow* window, vtkImageData* compressed, vtkFloatArray* samples)
{
  auto* glWindow = vtkOpenGLRenderWindow::SafeDownCast(window);
  vtkNew<vtkCompressedVolume> source;
  if (!glWindow || !compressed || !samples)
  {
    vtkErrorMacro("DecodeOnGPU needs an OpenGL window, a compressed volume and an array");
    return false;
  }
  if (!source->Read(compressed))
  {
    return this->Impl->Report(source->GetErrorMessage());
  }
  glWindow->Initialize();
  glWindow->MakeCurrent();
  glWindow->GetShaderCache()->ReleaseCurrentShader();
  ProgressivePipeline pipeline;
  std::vector<float> values;
  Status status = pipeline.Initialize(ContextOf(glWindow));
  if (status)
  {
    pipeline.SetVolume(DescribeVolume(source));
    status = pipeline.DecodeVolume(values);
  }
  pipeline.Release();
  glUseProgram(0);
  if (status)
  {
    CopyBlocks(values, source, samples);
  }
  return status || this->Impl->Report(status.GetMessage());
}
