// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceMapper.h"

#include "GL/Stopwatch.h"
#include "Pipeline/FixedView.h"
#include "Pipeline/ImageRectangle.h"
#include "Pipeline/ProgressivePipeline.h"
#include "Scene/BoundWindow.h"
#include "Scene/CameraTranslation.h"
#include "Scene/DrawingState.h"
#include "Scene/GpuDecoder.h"
#include "Scene/HitGeometry.h"
#include "Scene/ImageStatistics.h"
#include "Scene/InputArrays.h"
#include "Scene/LevelTranslation.h"
#include "Scene/Palette.h"
#include "Scene/RefinementTimer.h"
#include "Scene/SceneLimits.h"
#include "Scene/SceneTranslation.h"
#include "Scene/Selection.h"
#include "Scene/ShownIsovalues.h"
#include "Scene/ViewState.h"
#include "Shaders/Glsl.h"
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkCompressedVolume.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationObjectBaseVectorKey.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderPass.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkPointData.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkTimerLog.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

// Users see the number in the header: it is SpeculationLimit's largest value and its default.
static_assert(glsl::MAX_SPECULATION == 64, "SpeculationLimit follows the shaders' constant");

namespace
{
constexpr double Unlimited = std::numeric_limits<double>::infinity(); // milliseconds

constexpr double LeastRateOfMovement = 1.0; // frames a second that a window asks for

std::vector<LevelSteps> StepsOfLevels(vtkCompressedVolume* volume, int coarser)
{
  std::vector<LevelSteps> levels = { { 1, 1, 1 } };
  for (int level = 1; level <= coarser; ++level)
  {
    const int* steps = volume->GetLevel(level)->GetSteps();
    levels.push_back({ steps[0], steps[1], steps[2] });
  }
  return levels;
}

// How much of what a first image takes is done before each part of it, as LoadingEvent tells.
namespace LoadedBefore
{
constexpr double Upload = 0.05, Preparation = 0.1, Start = 0.5, Passes = 0.7, Next = 1.0;
}

// The failure that was told last: the same one is not told at every render.
struct ToldFailure
{
  std::string Message;
  vtkMTimeType Cause = 0; // when settings and input last changed
  vtkRenderer* Renderer = nullptr;
};
}

// What a mapper keeps from one render to the next; the mapper's methods join the parts.
struct vtkProgressiveIsosurfaceMapper::Internals
{
  InputArrays Inputs;
  BoundWindow Window; ///< the pipeline's
  ProgressivePipeline Pipeline;
  vtkTimeStamp HandOverTime;   ///< of the inputs to the pipeline
  int HandedLevels = 0;        ///< of detail, beside the volume itself
  vtkMTimeType LevelsTime = 0; ///< the inputs' whose lack of levels has been told
  PaletteCache Palettes;
  ViewState View;
  vtkRenderer* Renderer = nullptr; ///< of the present render
  RefinementTimer Timer;
  std::vector<double> JudgedIsovalues; ///< that WarnOfDoubts() has seen
  vtkMTimeType JudgedTime = 0;         ///< the input's then
  ToldFailure Told;
  bool Loads = false;             ///< LoadingEvent has been told, and not yet its end
  bool AsksObservers = false;     ///< of LoadingEvent
  vtkTypeInt64 TightBudget = 0;   ///< the last one that was too small, and of which
  vtkMTimeType TightTime = 0;     ///< input that has been told
  double InputMilliseconds = 0.0; ///< that the inputs took when they last changed
  double TotalMilliseconds = 0.0; ///< of the present image
};

vtkStandardNewMacro(vtkProgressiveIsosurfaceMapper);

vtkCxxSetObjectMacro(vtkProgressiveIsosurfaceMapper, ColorLookupTable, vtkScalarsToColors);

//------------------------------------------------------------------------------
// Properties
//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceMapper::vtkProgressiveIsosurfaceMapper()
  : Impl(new Internals)
{
  this->SetNumberOfInputPorts(2);
  this->Impl->Inputs.SetProgress(
    [this](double fraction) { this->InvokeEvent(CompressionEvent, &fraction); });
}

vtkProgressiveIsosurfaceMapper::~vtkProgressiveIsosurfaceMapper()
{
  this->ReleaseGraphics(this->Impl->Window.Get());
  this->SetColorArrayName(nullptr);
  this->SetColorLookupTable(nullptr);
}

void vtkProgressiveIsosurfaceMapper::SetColorInputData(vtkImageData* image)
{
  this->SetInputDataInternal(1, image);
}

void vtkProgressiveIsosurfaceMapper::SetRate(double rate)
{
  if (this->Rate != rate || this->KeepLabels)
  {
    this->Rate = rate;
    this->KeepLabels = false;
    this->Modified();
  }
}

void vtkProgressiveIsosurfaceMapper::SetColorInputConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

vtkMTimeType vtkProgressiveIsosurfaceMapper::GetMTime()
{
  const vtkMTimeType time = this->Superclass::GetMTime();
  return this->ColorLookupTable ? std::max(time, this->ColorLookupTable->GetMTime()) : time;
}

void vtkProgressiveIsosurfaceMapper::CopySettings(vtkProgressiveIsosurfaceMapper* other)
{
  this->SetScalarMode(other->ScalarMode);
  if (other->ArrayAccessMode == VTK_GET_ARRAY_BY_NAME)
  {
    this->SelectScalarArray(other->ArrayName);
  }
  else
  {
    this->SelectScalarArray(other->ArrayId);
  }
  this->SetComponent(other->Component);
  if (this->Rate != other->Rate || this->KeepLabels != other->KeepLabels)
  {
    this->Rate = other->Rate; // SetRate() would switch KeepLabels off
    this->KeepLabels = other->KeepLabels;
    this->Modified();
  }
  this->SetMaskNonFinite(other->MaskNonFinite);
  this->SetColorArrayName(other->ColorArrayName);
  this->SetColorComponent(other->ColorComponent);
  this->SetColorLookupTable(other->ColorLookupTable);
  this->SetLitLikeMeshes(other->LitLikeMeshes);
  this->SetSelectionExtent(other->SelectionExtent);
  this->SetLevelOfDetail(other->LevelOfDetail);
  this->SetPixelTolerance(other->PixelTolerance);
  this->SetSpeculationLimit(other->SpeculationLimit);
  this->SetMemoryBudget(other->MemoryBudget);
  this->SetDecodeWholeVolume(other->DecodeWholeVolume);
  this->SetLargestBuffer(other->LargestBuffer);
  this->SetPixelsPerStraggler(other->PixelsPerStraggler);
  this->SetDetailedStatistics(other->DetailedStatistics);
  this->SetMaximumPassesPerRender(other->MaximumPassesPerRender);
  this->SetImageReductionFactor(other->ImageReductionFactor);
  this->SetClippingPlanes(other->ClippingPlanes);
  this->SetCropping(other->Cropping);
  this->SetCroppingRegionPlanes(other->CroppingRegionPlanes);
  this->SetCroppingRegionFlags(other->CroppingRegionFlags);
}

void vtkProgressiveIsosurfaceMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << "\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "KeepLabels: " << (this->KeepLabels ? "on\n" : "off\n");
  os << indent << "ColorArrayName: " << (this->ColorArrayName ? this->ColorArrayName : "(none)")
     << "\n";
  os << indent << "ColorComponent: " << this->ColorComponent << "\n";
  os << indent << "ColorLookupTable: " << this->ColorLookupTable << "\n";
  os << indent << "LitLikeMeshes: " << this->LitLikeMeshes << "\n";
  os << indent << "SelectionExtent:";
  for (const int bound : this->SelectionExtent)
  {
    os << " " << bound;
  }
  os << "\n" << indent << "CompositeIndex: " << this->CompositeIndex << "\n";
  const char* const levels[] = { "off\n", "on\n", "interactive\n", "conservative\n" };
  os << indent << "LevelOfDetail: " << levels[this->LevelOfDetail];
  os << indent << "PixelTolerance: " << this->PixelTolerance << "\n";
  os << indent << "SpeculationLimit: " << this->SpeculationLimit << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "MemoryShare: " << this->MemoryShare << "\n";
  os << indent << "DecodeWholeVolume: " << this->DecodeWholeVolume << "\n";
  os << indent << "LargestBuffer: " << this->LargestBuffer << "\n";
  os << indent << "PixelsPerStraggler: " << this->PixelsPerStraggler << "\n";
  os << indent << "DetailedStatistics: " << this->DetailedStatistics << "\n";
  os << indent << "MaximumPassesPerRender: " << this->MaximumPassesPerRender << "\n";
  os << indent << "TimeAllowance: " << this->TimeAllowance << "\n";
  os << indent << "ImageReductionFactor: " << this->ImageReductionFactor << "\n";
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

// Without it vtkCellPicker and its like would read from a null pointer.
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
  return HasTranslucent(FindShownIsovalues(property));
}

bool vtkProgressiveIsosurfaceMapper::DrawsTranslucent(vtkVolumeProperty* property)
{
  const bool hasColors =
    this->GetNumberOfInputConnections(1) > 0 || (this->ColorArrayName && *this->ColorArrayName);
  vtkScalarsToColors* table = hasColors ? this->ColorLookupTable : nullptr;
  return IsTranslucent(property) || (table && !table->IsOpaque());
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

//------------------------------------------------------------------------------
// A render
//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  const vtkSmartPointer<vtkProgressiveIsosurfaceMapper> alive = this; // whatever observers do
  const Stopwatch stopwatch;
  if (this->Impl->AsksObservers)
  {
    return; // one of them renders: there is nothing to show yet
  }
  this->Impl->Renderer = renderer;
  if (!this->CanRender(renderer, volume) || !this->UpdateInputs())
  {
    return;
  }
  if (this->Impl->HandOverTime < this->Impl->Inputs.GetTime())
  {
    this->Impl->InputMilliseconds = stopwatch.GetMilliseconds();
  }
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  window->MakeCurrent();
  if (!this->BindWindow(window, volume) || !this->UpdateScene(renderer, volume))
  {
    return;
  }
  if (vtkHardwareSelector* selector = renderer->GetSelector())
  {
    this->Select(selector);
    return;
  }
  if (!this->Refine(window))
  {
    return;
  }
  if (this->Impl->Told.Renderer == renderer)
  {
    this->Impl->Told = ToldFailure();
  }
  this->Statistics->SetSource(
    [this, detailed = this->DetailedStatistics]() { return this->CollectFigures(detailed); });
  if (this->Impl->Loads && this->Impl->Pipeline.IsStarted())
  {
    this->TellLoading(LoadedBefore::Next);
    this->Impl->Loads = false;
  }
  double fraction = this->GetCompletedFraction();
  this->InvokeEvent(vtkCommand::ProgressEvent, &fraction);
  if (!window->IsCurrent())
  {
    window->MakeCurrent();
  }
  if (this->Impl->Window.Get() == window && this->MayRefineLater(window))
  {
    this->PrepareNextRender(window);
  }
}

// In a window that someone watches: goes on with the image, or uses the time.
void vtkProgressiveIsosurfaceMapper::PrepareNextRender(vtkOpenGLRenderWindow* window)
{
  if (this->GetConverged())
  {
    this->Impl->Pipeline.RequestForClicks();
  }
  else
  {
    this->Impl->Timer.RequestRender(window);
  }
}

bool vtkProgressiveIsosurfaceMapper::CanRender(vtkRenderer* renderer, vtkVolume* volume)
{
  if (!vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow()))
  {
    return this->Fails("needs an OpenGL render window");
  }
  if (IsPeeled(volume))
  {
    return this->Fails("cannot be peeled with other volumes: switch vtkRenderer's "
                       "UseDepthPeelingForVolumes off, or use a vtkIsosurfaceVolume");
  }
  return this->Succeeds(CheckLimits(renderer, volume->GetProperty(), this->ClippingPlanes));
}

bool vtkProgressiveIsosurfaceMapper::UpdateInputs()
{
  if (this->Impl->AsksObservers)
  {
    return true; // what is being loaded has to stay
  }
  if (!this->GetInputAlgorithm())
  {
    return this->Fails("has no input: connect a vtkImageData, plain or compressed");
  }
  this->GetInputAlgorithm()->Update();
  vtkImageData* image = vtkImageData::SafeDownCast(this->GetInput());
  if (!image)
  {
    return this->Fails("needs a vtkImageData as input");
  }
  return this->Succeeds(this->Impl->Inputs.UpdateValues(this->MakeArrayChoice(), image)) &&
    this->UpdateColors(image);
}

ArrayChoice vtkProgressiveIsosurfaceMapper::MakeArrayChoice()
{
  ArrayChoice choice;
  choice.ScalarMode = this->ScalarMode;
  choice.ArrayAccessMode = this->ArrayAccessMode;
  choice.ArrayId = this->ArrayId;
  choice.ArrayName = this->ArrayName;
  choice.Component = this->Component;
  choice.ColorArrayName = this->ColorArrayName;
  choice.ColorComponent = this->ColorComponent;
  choice.Rate = this->Rate;
  choice.MaskNonFinite = this->MaskNonFinite;
  choice.KeepLabels = this->KeepLabels;
  choice.Levels = this->LevelOfDetail == LevelOfDetailOff ? 0 : +vtkCompressedVolume::MaximumLevels;
  return choice;
}

bool vtkProgressiveIsosurfaceMapper::UpdateColors(vtkImageData* image)
{
  const ArrayChoice choice = this->MakeArrayChoice();
  InputArrays& inputs = this->Impl->Inputs;
  if (this->GetNumberOfInputConnections(1) > 0)
  {
    this->GetInputAlgorithm(1, 0)->Update();
    vtkImageData* colors = vtkImageData::SafeDownCast(this->GetInputDataObject(1, 0));
    return this->Succeeds(inputs.UpdateColorsFromImage(choice, colors));
  }
  if (this->ColorArrayName && *this->ColorArrayName)
  {
    return this->Succeeds(inputs.UpdateColorsFromArray(choice, image));
  }
  inputs.RemoveColors();
  return true;
}

// Makes the pipeline ready in the window's context, which is current, and gives it the inputs.
bool vtkProgressiveIsosurfaceMapper::BindWindow(vtkOpenGLRenderWindow* window, vtkVolume* volume)
{
  Internals& impl = *this->Impl;
  if (impl.Window.IsBound() && (impl.Window.Get() != window || !impl.Window.HasContext(window)))
  {
    this->ReleaseGraphics(impl.Window.Get());
    window->MakeCurrent();
  }
  impl.Window.Bind(window);
  window->GetShaderCache()->ReleaseCurrentShader();
  if (!this->Continues(impl.Pipeline.Initialize(BoundWindow::ContextOf(window))))
  {
    return false;
  }
  const int levels = this->CountLevels(volume);
  if (impl.HandOverTime < impl.Inputs.GetTime() || impl.HandedLevels != levels)
  {
    this->Statistics->SetSource(nullptr); // the last image's figures go
    impl.View.Forget();
    impl.Pipeline.SetVolume(impl.Inputs.Describe(levels));
    impl.HandedLevels = levels;
    impl.HandOverTime.Modified();
  }
  return true;
}

// The coarser levels of detail that are drawn, now or while the camera moves.
int vtkProgressiveIsosurfaceMapper::CountLevels(vtkVolume* volume)
{
  const bool exact = this->LevelOfDetail == LevelOfDetailOff || this->HasCategories(volume);
  return exact ? 0 : this->Impl->Inputs.CountLevels();
}

// What maps the values of the volume that gives the colours.
vtkScalarsToColors* vtkProgressiveIsosurfaceMapper::GetColorTable(vtkVolume* volume)
{
  return this->ColorLookupTable ? this->ColorLookupTable
                                : volume->GetProperty()->GetRGBTransferFunction();
}

bool vtkProgressiveIsosurfaceMapper::HasCategories(vtkVolume* volume)
{
  return this->Impl->Inputs.GetColors().GetImage() &&
    this->GetColorTable(volume)->GetIndexedLookup();
}

// Says that there are no levels of detail to draw, once for an input.
void vtkProgressiveIsosurfaceMapper::WarnOfLackOfLevels()
{
  Internals& impl = *this->Impl;
  const vtkMTimeType time = impl.Inputs.GetTime();
  if (this->LevelOfDetail != LevelOfDetailOff && impl.LevelsTime != time)
  {
    impl.LevelsTime = time;
    const std::string lack = impl.Inputs.DescribeLackOfLevels();
    if (!lack.empty())
    {
      vtkWarningMacro("draws exactly: " << lack);
    }
  }
}

// Says where compression may have changed the surfaces, once for an input and its isovalues.
void vtkProgressiveIsosurfaceMapper::WarnOfDoubts(vtkVolumeProperty* property)
{
  Internals& impl = *this->Impl;
  const CompressedInput& input = impl.Inputs.GetValues();
  vtkNew<vtkDoubleArray> isovalues;
  for (const ShownIsovalue& shown : FindShownIsovalues(property))
  {
    isovalues->InsertNextValue(shown.Value);
  }
  const double* const first = isovalues->GetPointer(0);
  const std::vector<double> values(first, first + isovalues->GetNumberOfValues());
  if (values == impl.JudgedIsovalues && input.GetTime() == impl.JudgedTime)
  {
    return;
  }
  impl.JudgedIsovalues = values;
  impl.JudgedTime = input.GetTime();
  const std::string doubts = input.GetVolume()->DescribeDoubts(isovalues);
  if (!doubts.empty())
  {
    vtkWarningMacro(<< doubts);
  }
}

// Says that a memory budget could not be kept, once for it and an input.
void vtkProgressiveIsosurfaceMapper::WarnOfTightBudget()
{
  Internals& impl = *this->Impl;
  const std::string excess = impl.Pipeline.GetMemoryPlan().DescribeExcess();
  const vtkMTimeType time = impl.Inputs.GetTime();
  if (!excess.empty() && (impl.TightBudget != this->MemoryBudget || impl.TightTime != time))
  {
    impl.TightBudget = this->MemoryBudget;
    impl.TightTime = time;
    vtkWarningMacro(<< excess);
  }
}

// Interactive: a still picture is exact.
bool vtkProgressiveIsosurfaceMapper::DrawsLevels(vtkRenderWindow* window) const
{
  const bool moves = window->GetDesiredUpdateRate() >= LeastRateOfMovement;
  return this->Impl->HandedLevels > 0 && (this->LevelOfDetail != LevelOfDetailInteractive || moves);
}

bool vtkProgressiveIsosurfaceMapper::UpdateScene(vtkRenderer* renderer, vtkVolume* volume)
{
  Internals& impl = *this->Impl;
  this->WarnOfDoubts(volume->GetProperty());
  this->WarnOfLackOfLevels();
  // not the renderer's size: a pass may draw into a framebuffer of its own, larger than the window
  int place[4];
  impl.Window.Get()->GetState()->vtkglGetIntegerv(GL_VIEWPORT, place);
  SceneChoice choice = { { place[2], place[3], place[0], place[1] } };
  const CompressedInput& values = impl.Inputs.GetValues();
  choice.ImageReduction = renderer->GetSelector() ? 1 : this->ImageReductionFactor;
  choice.LitSides = !renderer->GetTwoSidedLighting() ? glsl::ONE_SIDED
    : this->LitLikeMeshes                            ? glsl::LIT_LIKE_MESHES
                                                     : glsl::TWO_SIDED;
  if (this->DrawsLevels(renderer->GetRenderWindow()))
  {
    choice.Levels = StepsOfLevels(values.GetVolume(), impl.HandedLevels);
    choice.PixelTolerance = this->PixelTolerance;
  }
  PipelineScene scene =
    TranslateScene(renderer, volume, this, values.GetImage(), values.GetVolume(), choice);
  if (!HasRays(scene.View))
  {
    return this->Fails("cannot show its input: the image's spacing, origin and directions, the "
                       "volume's matrix and the camera must be finite, and none of them flat");
  }
  if (HasTooLongWays(scene.View))
  {
    return this->Fails("cannot show its input: rays would cross 2^29 voxels and more on their way "
                       "through it; resample the image to spacings that differ less");
  }
  vtkScalarsToColors* table = this->GetColorTable(volume);
  const CompressedInput& colors = impl.Inputs.GetColors();
  vtkCompressedVolume* colorVolume = colors.GetImage() ? colors.GetVolume() : nullptr;
  scene.Conservative = this->LevelOfDetail == LevelOfDetailConservative;
  scene.Categories = this->HasCategories(volume);
  scene.Translucent = this->DrawsTranslucent(volume->GetProperty());
  const Obstacles obstacles = scene.Translucent ? FindObstacles(renderer, volume) : Obstacles();
  scene.Obstructed = obstacles.Count > 0;
  const bool continues = impl.View.Update(
    renderer, scene, obstacles, impl.Palettes.Update(table, colorVolume, colors.GetTime()));
  const bool mayWait = !renderer->GetSelector() && this->MayRefineLater(impl.Window.Get());
  return this->UpdatePipeline(!continues, mayWait);
}

// Gives the pipeline its settings and the scene, and starts another image if need be. `mayWait`:
// the image may start at a later render, while programs are being compiled.
bool vtkProgressiveIsosurfaceMapper::UpdatePipeline(bool newImage, bool mayWait)
{
  Internals& impl = *this->Impl;
  if (impl.View.HasNewPalette())
  {
    impl.Pipeline.SetPalette(impl.View.GetPalette());
  }
  this->Statistics->SetSource(nullptr);
  PipelineSettings settings;
  settings.MemoryBudget = this->MemoryBudget;
  settings.MemoryShare = this->MemoryShare;
  settings.LargestBuffer = this->LargestBuffer;
  settings.PixelsPerStraggler = this->PixelsPerStraggler;
  settings.SpeculationLimit = this->SpeculationLimit;
  settings.DecodeWholeVolume = this->DecodeWholeVolume;
  settings.Detailed = this->DetailedStatistics;
  const bool empty = IsEmpty(impl.View.GetScene().View);
  if (!empty && !impl.Pipeline.IsVolumeLoaded() && !this->TellLoading(LoadedBefore::Upload))
  {
    return false;
  }
  const Status made = impl.Pipeline.SetScene(impl.View.GetScene(), settings, newImage);
  if (!made)
  {
    // what follows from the volume's size alone costs nothing at the next render
    return impl.Pipeline.GetStatus() ? this->Succeeds(made) : this->Continues(made);
  }
  this->WarnOfTightBudget();
  const bool starts = !impl.Pipeline.IsStarted() &&
    (!mayWait || empty || impl.Pipeline.AwaitPrograms(1e3 * this->TimeAllowance));
  return !starts || this->StartImage(empty);
}

// Prepares the volume, if the image is not empty and nothing has done so, and starts the image.
bool vtkProgressiveIsosurfaceMapper::StartImage(bool empty)
{
  using namespace LoadedBefore;
  Internals& impl = *this->Impl;
  const bool loads = !empty && impl.Pipeline.IsLoading();
  if (!empty)
  {
    const vtkTimerLogScope timed("Progressive Isosurface: upload");
    const vtkOpenGLRenderWindow* const window = impl.Window.Get();
    const auto tell = [&](double prepared)
    { return this->TellLoading(Preparation + (Start - Preparation) * prepared); };
    if (loads && !tell(0.0))
    {
      return false;
    }
    const Status& prepared = impl.Pipeline.PrepareVolume(tell);
    if (impl.Window.Get() != window || !this->Continues(prepared))
    {
      return false;
    }
  }
  const Stopwatch stopwatch;
  impl.Pipeline.Start();
  impl.TotalMilliseconds = stopwatch.GetMilliseconds();
  return !loads || this->TellLoading(Passes);
}

// Tells how far the loading is. Observers may do anything: returns false if they have released what
// is to be drawn. Afterwards all is bound as it was: Qt binds the framebuffers of its widgets.
bool vtkProgressiveIsosurfaceMapper::TellLoading(double fraction)
{
  Internals& impl = *this->Impl;
  impl.Loads = true;
  if (!this->HasObserver(LoadingEvent))
  {
    return true;
  }
  const vtkSmartPointer<vtkOpenGLRenderWindow> window = impl.Window.Get();
  window->GetState()->PushFramebufferBindings();
  impl.AsksObservers = true;
  this->InvokeEvent(LoadingEvent, &fraction);
  impl.AsksObservers = false;
  window->MakeCurrent();
  window->GetState()->ResetFramebufferBindings();
  window->GetState()->PopFramebufferBindings();
  window->GetShaderCache()->ReleaseCurrentShader();
  return impl.Window.Get() == window;
}

// Performs passes, as many as there is time for, and draws the image as far as it has come.
bool vtkProgressiveIsosurfaceMapper::Refine(vtkOpenGLRenderWindow* window)
{
  Internals& impl = *this->Impl;
  if (!impl.Pipeline.IsStarted())
  {
    return true; // programs are still being compiled
  }
  const vtkTimerLogScope timed("Progressive Isosurface: render");
  const Stopwatch stopwatch;
  const double milliseconds = this->MayRefineLater(window) ? 1e3 * this->TimeAllowance : Unlimited;
  const auto stop = [&]()
  {
    const bool late = stopwatch.GetMilliseconds() >= milliseconds;
    const bool aborted = window->CheckAbortStatus() != 0; // asks observers, who may do anything
    if (!window->IsCurrent())
    {
      window->MakeCurrent();
    }
    return late || aborted || impl.Window.Get() != window;
  };
  const bool unfinished = !this->GetConverged();
  if (unfinished)
  {
    impl.Pipeline.RunPasses(this->MaximumPassesPerRender, milliseconds, stop);
  }
  if (impl.Window.Get() != window)
  {
    return false; // an observer has released what was to be drawn
  }
  if (impl.Pipeline.CheckMemory())
  {
    const PipelineScene& scene = impl.View.GetScene();
    const DrawingState drawing(window->GetState(), scene.View, scene.Translucent);
    impl.Pipeline.Composite();
  }
  if (!this->Continues(impl.Pipeline.GetStatus()))
  {
    return false;
  }
  if (unfinished)
  {
    impl.TotalMilliseconds += stopwatch.GetMilliseconds();
  }
  return true;
}

// Whether somebody will render again if the image stays incomplete now.
bool vtkProgressiveIsosurfaceMapper::MayRefineLater(vtkOpenGLRenderWindow* window)
{
  return this->Impl->View.IsSettled() && RefinementTimer::CanRenderAgain(window);
}

// Completes the image, and draws ids in place of colours.
void vtkProgressiveIsosurfaceMapper::Select(vtkHardwareSelector* selector)
{
  Internals& impl = *this->Impl;
  if (!this->GetConverged())
  {
    impl.Pipeline.RunPasses(0, Unlimited, []() { return false; });
  }
  if (this->Continues(impl.Pipeline.GetStatus()))
  {
    SelectedImage image;
    image.CompositeIndex = this->CompositeIndex;
    const int* extent = this->SelectionExtent;
    if (extent[0] > extent[1])
    {
      extent = vtkImageData::SafeDownCast(this->GetInput())->GetExtent();
    }
    std::copy(extent, extent + 6, image.Extent);
    DrawSelection(selector, impl.Window.Get()->GetState(), impl.View.GetScene().View,
      impl.Inputs.GetValues().GetVolume(), image, impl.Pipeline);
  }
}

// Waits for the GPU.
ImageStatistics vtkProgressiveIsosurfaceMapper::CollectFigures(bool detailed)
{
  Internals& impl = *this->Impl;
  if (impl.Window.Get()) // else it is going, and current
  {
    impl.Window.Get()->MakeCurrent();
  }
  impl.Pipeline.CompleteStatistics();
  const std::int32_t* size = impl.View.GetScene().View.ImageSize;
  const std::int64_t pixels = static_cast<std::int64_t>(size[0]) * size[1];
  ImageStatistics image = CollectStatistics(impl.Pipeline, pixels, detailed);
  const double passes = image.Passes.empty() ? 0.0 : image.Passes.back().ElapsedMilliseconds;
  image.TotalMilliseconds = std::max(impl.TotalMilliseconds, passes);
  image.InputMilliseconds = impl.InputMilliseconds;
  image.HostBytes = impl.Inputs.GetHostBytes();
  this->CountPixelsOfLevels(image);
  return image;
}

// Counts, of the image as far as it has come, the pixels of each level and the uncertain ones.
void vtkProgressiveIsosurfaceMapper::CountPixelsOfLevels(ImageStatistics& statistics)
{
  Internals& impl = *this->Impl;
  const PipelineScene& scene = impl.View.GetScene();
  if (!IsEmpty(scene.View) && impl.Pipeline.GetStatus() && impl.Pipeline.IsStarted())
  {
    HitReadback hits = impl.Pipeline.GetHits();
    const std::vector<float> depths =
      scene.View.NumberOfLevels > 1 ? hits.ReadDepths() : std::vector<float>();
    const PixelsOfLevels counts = ::CountLevels(scene, hits.ReadKeys(), depths);
    statistics.LevelPixels = counts.Pixels;
    statistics.UncertainFraction = counts.UncertainFraction;
  }
}

//------------------------------------------------------------------------------
// Errors and graphics resources
//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceMapper::Succeeds(const Status& status)
{
  return status.IsOk() || this->Fails(status.GetMessage());
}

// Tells a failure unless it is that of the last render and nothing has changed since; false.
bool vtkProgressiveIsosurfaceMapper::Fails(const std::string& message)
{
  Internals& impl = *this->Impl;
  const vtkMTimeType cause = std::max(this->GetMTime(), impl.Inputs.GetTime());
  const bool again = message == impl.Told.Message && cause == impl.Told.Cause;
  impl.Told = { message, cause, impl.Renderer };
  if (!again)
  {
    vtkErrorMacro(<< message);
  }
  return false;
}

// An error of the pipeline may leave anything behind: the next render begins with nothing.
bool vtkProgressiveIsosurfaceMapper::Continues(const Status& pipelineStatus)
{
  // releasing resets the pipeline's
  const Status status = pipelineStatus; // NOLINT(performance-unnecessary-copy-initialization)
  if (!status)
  {
    this->ReleaseGraphics(this->Impl->Window.Get());
  }
  return this->Succeeds(status);
}

void vtkProgressiveIsosurfaceMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  // a window that is being destroyed calls this, too, when weak pointers to it are null already
  if (!window || this->Impl->Window.IsWindow(window))
  {
    this->ReleaseGraphics(window ? window : this->Impl->Window.Get());
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkProgressiveIsosurfaceMapper::ReleaseGraphics(vtkWindow* window)
{
  Internals& impl = *this->Impl;
  auto* glWindow = vtkOpenGLRenderWindow::SafeDownCast(window);
  if (glWindow && impl.Window.HasContext(glWindow))
  {
    glWindow->MakeCurrent();
    this->Statistics->Collect();
    impl.Pipeline.Release();
  }
  else if (impl.Window.IsBound())
  {
    this->Statistics->SetSource(nullptr);
    impl.Pipeline = ProgressivePipeline(); // its objects are gone with their context
  }
  impl.Window.Unbind();
  impl.HandOverTime = vtkTimeStamp();
  impl.View.Forget();
}

//------------------------------------------------------------------------------
// What the last render has shown
//------------------------------------------------------------------------------
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

void vtkProgressiveIsosurfaceMapper::EmptyCache()
{
  this->Impl->Pipeline.EmptyCache();
}

bool vtkProgressiveIsosurfaceMapper::WasRenderedIn(vtkRenderer* renderer)
{
  return this->HasImage() && this->Impl->View.IsOf(renderer);
}

bool vtkProgressiveIsosurfaceMapper::HasImage()
{
  return this->Impl->View.IsKnown() && this->Impl->Window.Get() && this->Impl->Pipeline.IsStarted();
}

bool vtkProgressiveIsosurfaceMapper::GetHit(int x, int y, double position[3], double& isovalue)
{
  Internals& impl = *this->Impl;
  if (!this->HasImage() || !impl.View.RendererToViewport(x, y))
  {
    return false;
  }
  const PipelineScene& scene = impl.View.GetScene();
  const ViewGeometry& view = scene.View;
  const std::optional<std::int64_t> pixel = ImagePixel(view, x, y);
  if (!pixel)
  {
    return false;
  }
  impl.Window.Get()->MakeCurrent();
  const PixelHit hit = impl.Pipeline.GetHits().Read(*pixel);
  if (hit.Key == glsl::NO_HIT)
  {
    return false;
  }
  // the key of a translucent image is that of its last hit
  const double t = scene.Translucent ? hit.Depth : HitDepth(FindDrawnDepths(view), hit.Key);
  impl.View.FindPosition(x, y, t, position);
  const glsl::FloatSum& stored = view.Isovalues[hit.Isovalue];
  isovalue = impl.Inputs.GetValues().GetVolume()->ToSample(double(stored.High) + stored.Low);
  return true;
}

bool vtkProgressiveIsosurfaceMapper::GetDepthImage(vtkImageData* image)
{
  if (!image || !this->HasImage())
  {
    vtkErrorMacro("has no depths yet: render first");
    return false;
  }
  Internals& impl = *this->Impl;
  impl.Window.Get()->MakeCurrent();
  const PipelineScene& scene = impl.View.GetScene();
  const std::vector<std::uint32_t> keys = impl.Pipeline.GetHits().ReadKeys();
  const std::vector<float> firstHits =
    scene.Translucent ? impl.Pipeline.GetHits().ReadDepths() : std::vector<float>();
  const std::vector<float> distances = HitDistances(scene.View, keys, firstHits);
  vtkNew<vtkFloatArray> depths;
  depths->SetName("Depth");
  depths->SetNumberOfValues(static_cast<vtkIdType>(distances.size()));
  std::copy(distances.begin(), distances.end(), depths->GetPointer(0));
  image->SetDimensions(scene.View.ViewportSize[0], scene.View.ViewportSize[1], 1);
  image->GetPointData()->SetScalars(depths);
  return true;
}

bool vtkProgressiveIsosurfaceMapper::DecodeOnGPU(
  vtkRenderWindow* window, vtkImageData* compressed, vtkFloatArray* samples)
{
  auto* glWindow = vtkOpenGLRenderWindow::SafeDownCast(window);
  vtkNew<vtkCompressedVolume> volume;
  if (!glWindow || !compressed || !samples)
  {
    vtkErrorMacro("DecodeOnGPU needs an OpenGL window, a compressed volume and an array");
    return false;
  }
  if (!volume->Read(compressed))
  {
    vtkErrorMacro(<< volume->GetErrorMessage());
    return false;
  }
  return this->Succeeds(::DecodeOnGPU(glWindow, volume, samples));
}
