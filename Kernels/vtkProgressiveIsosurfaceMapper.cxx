// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceMapper.h"

#include "ProgressivePipeline.h"
#include "SceneTranslation.h"
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "vtkCamera.h"
#include "vtkCellData.h"
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
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace
{
using Clock = std::chrono::steady_clock;

double MillisecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The pipeline's view of a volume; words of 64 bits, as zfp writes them.
PipelineVolume DescribeVolume(vtkCompressedVolume* source)
{
  PipelineVolume volume;
  volume.Stream = source->GetStream()->GetPointer(0);
  volume.StreamBytes = source->GetStream()->GetNumberOfValues() / 8 * 8;
  source->GetDimensions(volume.Samples);
  volume.BlockBits = source->GetBlockBits();
  return volume;
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
  void ReleaseGraphics();
  void ReleaseInput();
  bool Report(const std::string& problem);

  vtkProgressiveIsosurfaceMapper* Owner;
  ProgressivePipeline Pipeline;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;

  vtkSmartPointer<vtkImageData> Compressed; // the input, or what it was compressed to
  vtkNew<vtkCompressedVolume> Volume;
  // what Compressed was made from, when, and how: image, array, rate, component
  using SourceKey =
    std::tuple<vtkImageData*, vtkMTimeType, vtkDataArray*, vtkMTimeType, double, int>;
  SourceKey Source;
  vtkTimeStamp VolumeTime; // of Compressed; the pipeline has the one of HandOverTime
  vtkTimeStamp HandOverTime;

  SceneBlock Scene;
  bool HaveScene = false;
  vtkNew<vtkMatrix4x4> EyeToWorld;        // of Scene
  std::pair<int, vtkMTimeType> Obstacles; // of Scene: how many props, and when they last changed
  std::pair<vtkRenderer*, int> View;      // renderer and eye of the last render
  int RendersOfView = 0;                  // since another view was rendered
  bool CacheToEmpty = false;              // at the next render, when the context is current
  double TotalMilliseconds = 0.0;

  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  unsigned long TimerObserver = 0;
  int TimerId = -1;

private:
  vtkDataArray* FindArray(vtkImageData* image, bool& cellData);
  vtkSmartPointer<vtkImageData> Compress(vtkImageData* image, vtkDataArray* array, bool cellData);
  std::pair<int, vtkMTimeType> FindObstacles(vtkRenderer* renderer, vtkVolume* volume) const;
  bool MayRefineLater(vtkOpenGLRenderWindow* window) const;
  void OnTimer(vtkObject*, unsigned long, void* data);
};

vtkProgressiveIsosurfaceMapper::Internals::~Internals()
{
  this->ReleaseGraphics();
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->TimerObserver);
  }
}

// What the stages have room for.
bool vtkProgressiveIsosurfaceMapper::Internals::CheckLimits(
  vtkRenderer* renderer, vtkVolume* volume)
{
  vtkVolumeProperty* property = volume->GetProperty();
  vtkContourValues* values = property->GetIsoSurfaceValues();
  int shown = 0, lit = 0;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
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
  return check(shown, SceneBlock::MaximumIsovalues, "isovalues that show") &&
    check(planes, SceneBlock::MaximumClippingPlanes, "clipping planes") &&
    check(lit, SceneBlock::MaximumLights, "lights that are switched on");
}

bool vtkProgressiveIsosurfaceMapper::Internals::Report(const std::string& problem)
{
  vtkErrorWithObjectMacro(this->Owner, << problem);
  return false;
}

//------------------------------------------------------------------------------
// The input
//------------------------------------------------------------------------------
vtkDataArray* vtkProgressiveIsosurfaceMapper::Internals::FindArray(
  vtkImageData* image, bool& cellData)
{
  int cellFlag = 0;
  vtkDataArray* array = vtkAbstractMapper::GetScalars(image, this->Owner->ScalarMode,
    this->Owner->ArrayAccessMode, this->Owner->ArrayId, this->Owner->ArrayName, cellFlag);
  cellData = cellFlag == 1;
  if (!array && this->Owner->ScalarMode == VTK_SCALAR_MODE_DEFAULT &&
    image->GetPointData()->GetNumberOfArrays() > 0)
  {
    array =
      image->GetPointData()->GetArray(0); // no active scalars: the first array, as the filters do
  }
  return array;
}

vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceMapper::Internals::Compress(
  vtkImageData* image, vtkDataArray* array, bool cellData)
{
  vtkNew<vtkImageData> single;
  single->CopyStructure(image);
  if (cellData)
  {
    single->GetCellData()->SetScalars(array);
  }
  else
  {
    single->GetPointData()->SetScalars(array);
  }
  single->GetCellData()->AddArray(image->GetCellGhostArray()); // of a piece of a volume
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(single);
  compress->SetInputArrayToProcess(0, 0, 0,
    cellData ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
    vtkDataSetAttributes::SCALARS);
  compress->SetRate(this->Owner->Rate);
  compress->SetComponent(this->Owner->Component);
  compress->Update();
  return compress->GetOutput();
}

void vtkProgressiveIsosurfaceMapper::Internals::ReleaseInput()
{
  this->Compressed = nullptr;
  this->Source = SourceKey();
}

// Makes sure that Compressed and Volume are those of the present input; compresses a plain one.
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
  const bool compressed = vtkCompressedVolume::IsCompressed(image);
  bool cellData = false;
  vtkDataArray* array = compressed ? nullptr : this->FindArray(image, cellData);
  if (!compressed && !array)
  {
    return this->Report("the input image has no scalars: select an array that it has");
  }
  // of the mapper's own parameters only these make a plain image another volume
  const SourceKey key = { image, image->GetMTime(), array, array ? array->GetMTime() : 0,
    array ? self->Rate : 0.0, array ? self->Component : 0 };
  if (this->Compressed && key == this->Source)
  {
    return true;
  }
  this->ReleaseInput();
  vtkSmartPointer<vtkImageData> volume =
    compressed ? vtkSmartPointer<vtkImageData>(image) : this->Compress(image, array, cellData);
  if (!this->Volume->Read(volume))
  {
    return compressed ? this->Report(this->Volume->GetErrorMessage())
                      : false; // the filter has told why
  }
  this->Compressed = volume;
  this->Source = key;
  this->VolumeTime.Modified();
  return true;
}

//------------------------------------------------------------------------------
// The GPU's objects
//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceMapper::Internals::BindWindow(vtkOpenGLRenderWindow* window)
{
  if (this->Window && this->Window != window)
  {
    this->ReleaseGraphics();
    window->MakeCurrent();
  }
  this->Window = window;
  window->GetShaderCache()->ReleaseCurrentShader();
  return this->Pipeline.Initialize(window) || this->Report(this->Pipeline.GetError());
}

void vtkProgressiveIsosurfaceMapper::Internals::ReleaseGraphics()
{
  if (this->Window)
  {
    this->Window->MakeCurrent();
    this->Pipeline.Release();
  }
  this->Window = nullptr;
  this->HandOverTime = vtkTimeStamp();
  this->HaveScene = false;
}

// The stream stays here, in Volume, for as long as the pipeline may want to upload it.
void vtkProgressiveIsosurfaceMapper::Internals::HandOverVolume()
{
  if (this->HandOverTime < this->VolumeTime)
  {
    this->HaveScene = false;
    this->Pipeline.SetVolume(DescribeVolume(this->Volume));
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

// Restarts the image where its hits change. A new look is a matter of the composite alone, but not
// where layers were blended.
bool vtkProgressiveIsosurfaceMapper::Internals::UpdateScene(
  vtkRenderer* renderer, vtkVolume* volume)
{
  SceneBlock scene = TranslateScene(renderer, volume, this->Owner, this->Compressed, this->Volume);
  vtkCamera* camera = renderer->GetActiveCamera();
  vtkMatrix4x4::Invert(camera->GetModelViewTransformMatrix(), this->EyeToWorld);
  const bool translucent = scene.Lighting[1] != 0;
  const auto obstacles =
    translucent ? this->FindObstacles(renderer, volume) : std::pair<int, vtkMTimeType>();
  scene.Lighting[2] = obstacles.first > 0 ? 1 : 0;
  const std::pair<vtkRenderer*, int> view = { renderer, camera->GetLeftEye() };
  this->RendersOfView = view == this->View ? this->RendersOfView + 1 : 0;
  const bool sameHits = this->HaveScene && view == this->View && SameHits(this->Scene, scene) &&
    (!translucent || (SameLook(this->Scene, scene) && obstacles == this->Obstacles));
  this->View = view;
  this->Obstacles = obstacles;
  if (sameHits)
  {
    KeepHits(this->Scene, scene);
  }
  this->Scene = scene;
  this->HaveScene = true;
  PipelineSettings settings;
  settings.MemoryBudget = this->Owner->MemoryBudget;
  settings.LargestBuffer = this->Owner->LargestBuffer;
  settings.SpeculationLimit = this->Owner->SpeculationLimit;
  settings.DecodeWholeVolume = this->Owner->DecodeWholeVolume;
  settings.Detailed = this->Owner->DetailedStatistics;
  this->Pipeline.SetSettings(settings);
  if (this->CacheToEmpty)
  {
    this->Pipeline.EmptyCache();
    this->CacheToEmpty = false;
  }
  if (!this->Pipeline.SetScene(scene, !sameHits))
  {
    return this->Report(this->Pipeline.GetError());
  }
  if (!sameHits || !this->Pipeline.IsStarted())
  {
    const Clock::time_point start = Clock::now();
    this->Pipeline.Start();
    this->TotalMilliseconds = MillisecondsSince(start);
  }
  return true;
}

// Whether somebody will render again if the image stays incomplete now. Where several views, or
// eyes, take turns each of them begins anew: none would ever be complete.
bool vtkProgressiveIsosurfaceMapper::Internals::MayRefineLater(vtkOpenGLRenderWindow* window) const
{
  const int alone = 3;
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  return this->RendersOfView >= alone && interactor && interactor->GetInitialized() &&
    !window->GetOffScreenRendering() && window->GetSwapBuffers();
}

// Passes, as many as there is time for, and the image as far as it has come.
bool vtkProgressiveIsosurfaceMapper::Internals::Refine(vtkOpenGLRenderWindow* window)
{
  const Clock::time_point start = Clock::now();
  const bool interactive = this->MayRefineLater(window);
  const double allowance = this->Owner->TimeAllowance;
  auto stop = [&]()
  {
    return interactive &&
      (MillisecondsSince(start) >= 1e3 * allowance || window->CheckAbortStatus());
  };
  const bool unfinished = !this->Pipeline.GetConverged();
  if (unfinished)
  {
    this->Pipeline.RunPasses(this->Owner->MaximumPassesPerRender, interactive, stop);
  }
  if (!this->Pipeline.GetError().empty())
  {
    return this->Report(this->Pipeline.GetError());
  }
  this->Composite(window);
  this->Pipeline.CompleteStatistics();
  if (unfinished)
  {
    this->TotalMilliseconds += MillisecondsSince(start);
  }
  return true;
}

void vtkProgressiveIsosurfaceMapper::Internals::Composite(vtkOpenGLRenderWindow* window)
{
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglEnableDisable cullFace(state, GL_CULL_FACE);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
  const bool translucent = this->Scene.Lighting[1] != 0;
  state->vtkglDisable(GL_CULL_FACE);
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthFunc(GL_LEQUAL);
  state->vtkglDepthMask(translucent ? GL_FALSE : GL_TRUE);
  if (translucent)
  {
    state->vtkglEnable(GL_BLEND); // the layers' colours are multiplied by their opacities
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  else
  {
    state->vtkglDisable(GL_BLEND);
  }
  this->Pipeline.Composite();
}

// All passes that are still needed.
bool vtkProgressiveIsosurfaceMapper::Internals::Complete()
{
  if (!this->Pipeline.GetConverged())
  {
    this->Pipeline.RunPasses(0, false, []() { return false; });
  }
  return this->Pipeline.GetError().empty() || this->Report(this->Pipeline.GetError());
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
    cells *= this->Volume->GetDimensions()[axis] - 1;
  }
  selector->UpdateMaximumCellId(cells);
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  vtkOpenGLState::ScopedglDepthFunc depthFunction(state);
  state->vtkglDisable(GL_BLEND);
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglDepthFunc(GL_LEQUAL);
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
  const double pixels = static_cast<double>(this->Scene.Image[0]) * this->Scene.Image[1];
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
  PipelineResources& resources = this->Pipeline.GetResources();
  statistics->Buffers.clear();
  for (const BufferInfo& info : PipelineBuffers())
  {
    if (resources.GetBytes(info.Id) > 0)
    {
      statistics->Buffers.emplace_back(info.Name, resources.GetBytes(info.Id));
    }
  }
  statistics->Buffers.emplace_back("scene", sizeof(SceneBlock));
  statistics->Buffers.emplace_back("staging", resources.GetStagingBytes());
  statistics->Stages.clear();
  statistics->StagesLeftOut.clear();
  std::map<Stage, double> milliseconds = resources.GetStageMilliseconds();
  for (const StageInfo& info : PipelineStages())
  {
    if (resources.GetStagesRun().count(info.Id) > 0)
    {
      statistics->Stages.emplace_back(info.Name, milliseconds[info.Id]);
    }
    else
    {
      statistics->StagesLeftOut.emplace_back(info.Name);
    }
  }
  statistics->MemoryBudget = this->Pipeline.GetMemoryBudget();
  statistics->LeastMemoryBudget = this->Pipeline.GetLeastMemoryBudget();
  statistics->TotalMilliseconds = this->TotalMilliseconds;
  statistics->Converged = this->Pipeline.GetConverged();
  statistics->GLDescription = PipelineResources::GetDescription();
  statistics->Modified();
}

//------------------------------------------------------------------------------
// The mapper
//------------------------------------------------------------------------------
vtkStandardNewMacro(vtkProgressiveIsosurfaceMapper);

vtkProgressiveIsosurfaceMapper::vtkProgressiveIsosurfaceMapper()
  : Impl(new Internals(this))
{
}

vtkProgressiveIsosurfaceMapper::~vtkProgressiveIsosurfaceMapper() = default;

void vtkProgressiveIsosurfaceMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << "\n";
  os << indent << "Component: " << this->Component << "\n";
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

int vtkProgressiveIsosurfaceMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
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
  return this->Impl->Pipeline.GetResources().GetNumberOfGLErrors();
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
  this->Impl->RequestRender(window);
}

void vtkProgressiveIsosurfaceMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  if (this->Impl->Window && (!window || window == this->Impl->Window))
  {
    this->Impl->ReleaseGraphics();
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkProgressiveIsosurfaceMapper::EmptyCache()
{
  this->Impl->CacheToEmpty = true;
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
  const SceneBlock& scene = impl->Pipeline.GetScene();
  if (!impl->HaveScene || !impl->Window || x < 0 || y < 0 || x >= scene.Image[0] ||
    y >= scene.Image[1])
  {
    return false;
  }
  impl->Window->MakeCurrent();
  const PixelHit hit = impl->Pipeline.ReadHit(static_cast<std::int64_t>(y) * scene.Image[0] + x);
  if (hit.Key == PixelHit().Key)
  {
    return false;
  }
  const bool translucent = scene.Lighting[1] != 0;
  const double t = translucent ? hit.Depth : HitParameter(scene, x, y, hit.Key);
  double point[4] = { 0.0, 0.0, 0.0, 1.0 };
  EyePosition(scene, x, y, t, point);
  impl->EyeToWorld->MultiplyPoint(point, point);
  std::copy(point, point + 3, position);
  isovalue = double(scene.Isovalues[hit.Surface][0]) + scene.Isovalues[hit.Surface][1];
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
  const SceneBlock& scene = this->Impl->Pipeline.GetScene();
  const std::vector<std::uint32_t> keys = this->Impl->Pipeline.ReadHitKeys();
  const bool translucent = scene.Lighting[1] != 0; // the keys are those of the last hits
  const std::vector<float> first =
    translucent ? this->Impl->Pipeline.ReadHitDepths() : std::vector<float>();
  vtkNew<vtkFloatArray> depths;
  depths->SetName("Depth");
  depths->SetNumberOfValues(static_cast<vtkIdType>(keys.size()));
  for (int y = 0; y < scene.Image[1]; ++y)
  {
    for (int x = 0; x < scene.Image[0]; ++x)
    {
      const vtkIdType pixel = static_cast<vtkIdType>(y) * scene.Image[0] + x;
      const double last = HitParameter(scene, x, y, keys[pixel]);
      const double t = translucent && std::isfinite(last) ? first[pixel] : last;
      depths->SetValue(pixel, static_cast<float>(RayLength(scene, x, y, t)));
    }
  }
  image->SetDimensions(scene.Image[0], scene.Image[1], 1);
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
  bool good = pipeline.Initialize(glWindow);
  if (good)
  {
    pipeline.SetVolume(DescribeVolume(source));
    good = pipeline.DecodeVolume(values);
  }
  const std::string error = pipeline.GetError();
  pipeline.Release();
  glUseProgram(0);
  if (good)
  {
    CopyBlocks(values, source, samples);
  }
  return good || this->Impl->Report(error);
}
