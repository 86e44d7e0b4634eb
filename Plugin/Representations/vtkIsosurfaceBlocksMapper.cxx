// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceBlocksMapper.h"

#include "BlockOrder.h"
#include "FirstError.h"
#include "ImageBlocks.h"

#include "vtkAbstractMapper.h"
#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkProgressiveIsosurfaceStatistics.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <numeric>

namespace
{
using Images = std::vector<vtkImageData*>;

Images FindImages(vtkDataObject* input)
{
  Images images;
  const auto add = [&images](vtkDataObject* object)
  {
    vtkImageData* image = vtkImageData::SafeDownCast(object);
    if (image && image->GetNumberOfPoints() > 0)
    {
      images.push_back(image);
    }
  };
  add(input);
  if (auto* partitions = vtkPartitionedDataSet::SafeDownCast(input))
  {
    for (unsigned int i = 0; i < partitions->GetNumberOfPartitions(); ++i)
    {
      add(partitions->GetPartitionAsDataObject(i));
    }
  }
  return images;
}

// Finds the range of what a mapper draws; false: there is none, and the mapper says what is wrong.
bool FindRange(vtkProgressiveIsosurfaceMapper* mapper, double range[2])
{
  vtkImageData* image = vtkImageData::SafeDownCast(mapper->GetInput());
  if (vtkCompressedVolume::IsCompressed(image))
  {
    vtkNew<vtkCompressedVolume> volume;
    if (!volume->Read(image))
    {
      return false;
    }
    std::copy(volume->GetRange(), volume->GetRange() + 2, range);
    return true;
  }
  int cellFlag = 0;
  vtkDataArray* array = vtkAbstractMapper::GetScalars(image, mapper->GetScalarMode(),
    mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), cellFlag);
  if (!array || mapper->GetComponent() >= array->GetNumberOfComponents())
  {
    return false;
  }
  array->GetFiniteRange(range, array->GetNumberOfComponents() == 1 ? 0 : mapper->GetComponent());
  return true;
}

// Is an isovalue in the range of what a mapper draws, or does the mapper have to say what is wrong?
bool HasToDraw(vtkProgressiveIsosurfaceMapper* mapper, vtkContourValues* isovalues)
{
  double range[2];
  if (!FindRange(mapper, range))
  {
    return true;
  }
  const double* const values = isovalues->GetValues();
  return std::any_of(values, values + isovalues->GetNumberOfContours(),
    [&](double value) { return range[0] <= value && value <= range[1]; });
}

// Is the camera at rest? ParaView tells windows by the rate that it wants.
bool IsStill(vtkRenderWindow* window)
{
  return window->GetDesiredUpdateRate() < 1.0;
}

// Where the camera is, or for a parallel projection the direction towards it, among the blocks.
BlockOrder::Viewer FindViewer(vtkCamera* camera, vtkMatrix4x4* blocksToWorld)
{
  BlockOrder::Viewer viewer;
  viewer.IsParallel = camera->GetParallelProjection() != 0;
  double place[4] = { 0.0, 0.0, 0.0, viewer.IsParallel ? 0.0 : 1.0 };
  camera->GetPosition(place);
  if (viewer.IsParallel)
  {
    camera->GetDirectionOfProjection(place);
    vtkMath::MultiplyScalar(place, -1.0);
  }
  vtkNew<vtkMatrix4x4> worldToBlocks;
  vtkMatrix4x4::Invert(blocksToWorld, worldToBlocks);
  worldToBlocks->MultiplyPoint(place, place);
  viewer.Position = { place[0], place[1], place[2] };
  return viewer;
}
}

vtkStandardNewMacro(vtkIsosurfaceBlocksMapper);

//------------------------------------------------------------------------------
vtkIsosurfaceBlocksMapper::vtkIsosurfaceBlocksMapper() = default;

//------------------------------------------------------------------------------
vtkIsosurfaceBlocksMapper::~vtkIsosurfaceBlocksMapper() = default;

//------------------------------------------------------------------------------
int vtkIsosurfaceBlocksMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObject");
  return 1;
}

//------------------------------------------------------------------------------
vtkDataSet* vtkIsosurfaceBlocksMapper::GetDataSetInput()
{
  return this->All.size() == 1 ? this->All.front()->GetDataSetInput() : nullptr;
}

//------------------------------------------------------------------------------
double* vtkIsosurfaceBlocksMapper::GetBounds()
{
  vtkMath::UninitializeBounds(this->Bounds);
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->Update();
    vtkBoundingBox box;
    for (vtkImageData* image : FindImages(this->GetInputDataObject(0, 0)))
    {
      box.AddBounds(image->GetBounds());
    }
    box.GetBounds(this->Bounds);
  }
  return this->Bounds;
}

//------------------------------------------------------------------------------
bool vtkIsosurfaceBlocksMapper::UpdateInputs(vtkVolumeProperty* property)
{
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->Update();
  }
  this->UpdateMappers(property);
  bool all = true;
  for (const auto& mapper : this->Drawn)
  {
    all = mapper->UpdateInputs() && all;
  }
  return all;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  this->NumberOfComplete = 0;
  this->Settings->SetImageReductionFactor(this->FindReduction(renderer->GetRenderWindow()));
  this->UpdateMappers(volume->GetProperty());
  const double seconds = this->FindTime(renderer->GetRenderWindow());
  for (const auto& mapper : this->Drawn)
  {
    mapper->SetTimeAllowance(seconds / static_cast<double>(this->Drawn.size()));
  }
  for (std::size_t block : this->FindOrder(renderer, volume))
  {
    this->Drawn[block]->Render(renderer, volume);
  }
  if (this->NumberOfComplete == this->Drawn.size())
  {
    this->Error.Text.clear();
  }
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::UpdateMappers(vtkVolumeProperty* property)
{
  const Images images = FindImages(this->GetInputDataObject(0, 0));
  for (std::size_t i = images.size(); i < this->All.size(); ++i)
  {
    this->All[i]->ReleaseGraphicsResources(nullptr); // of whatever window
  }
  this->All.resize(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    if (!this->All[i])
    {
      this->All[i] = vtkSmartPointer<vtkProgressiveIsosurfaceMapper>::New();
      this->All[i]->AddObserver(
        vtkCommand::ProgressEvent, this, &vtkIsosurfaceBlocksMapper::CountComplete);
      for (const unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
      {
        this->All[i]->AddObserver(event, this, &vtkIsosurfaceBlocksMapper::Keep);
      }
      for (const unsigned long event : { vtkProgressiveIsosurfaceMapper::CompressionEvent,
             vtkProgressiveIsosurfaceMapper::LoadingEvent })
      {
        this->All[i]->AddObserver(event, this, &vtkIsosurfaceBlocksMapper::OnProgress);
      }
    }
    if (this->All[i]->GetInput() != images[i])
    {
      this->All[i]->SetInputData(images[i]);
      this->All[i]->SetCompositeIndex(ImageBlocks::GetCompositeIndex(images[i]));
    }
  }
  this->UpdateSettings();
  this->Drawn.clear();
  for (const auto& mapper : this->All)
  {
    if (this->All.size() == 1 || HasToDraw(mapper, property->GetIsoSurfaceValues()))
    {
      this->Drawn.push_back(mapper);
    }
  }
}

//------------------------------------------------------------------------------
double vtkIsosurfaceBlocksMapper::FindTime(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  const bool goesOn = interactor && interactor->IsA("QVTKInteractor");
  return IsStill(window) && !goesOn ? VTK_DOUBLE_MAX : this->Settings->GetTimeAllowance();
}

//------------------------------------------------------------------------------
// As for ParaView's Volume it does not depend on the data's size, which LOD Threshold is of.
int vtkIsosurfaceBlocksMapper::FindReduction(vtkRenderWindow* window)
{
  const int wanted = this->MovingReductionFactor;
  if (wanted <= 1 || IsStill(window))
  {
    return 1;
  }
  double milliseconds = 0.0; // of the last image, at full resolution
  for (const auto& mapper : this->Drawn)
  {
    const int pixelsPerRay = mapper->GetImageReductionFactor() * mapper->GetImageReductionFactor();
    milliseconds += mapper->GetStatistics()->GetTotalMilliseconds() * pixelsPerRay;
  }
  const double allowed = 1e3 * this->Settings->GetTimeAllowance();
  int factor = milliseconds > allowed ? wanted : 1;
  while (factor < 2 * wanted && milliseconds > allowed * factor * factor)
  {
    ++factor;
  }
  return factor;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::UpdateSettings()
{
  this->Settings->SetClippingPlanes(this->ClippingPlanes);
  this->Settings->SetCropping(this->Cropping);
  this->Settings->SetCroppingRegionPlanes(this->CroppingRegionPlanes);
  this->Settings->SetCroppingRegionFlags(this->CroppingRegionFlags);
  double samples = 0.0;
  for (const auto& mapper : this->All)
  {
    samples += static_cast<double>(mapper->GetInput()->GetNumberOfPoints());
  }
  for (const auto& mapper : this->All)
  {
    mapper->CopySettings(this->Settings);
    mapper->SetMemoryShare(static_cast<double>(mapper->GetInput()->GetNumberOfPoints()) / samples);
  }
}

//------------------------------------------------------------------------------
std::vector<std::size_t> vtkIsosurfaceBlocksMapper::FindOrder(
  vtkRenderer* renderer, vtkVolume* volume)
{
  if (this->Settings->DrawsTranslucent(volume->GetProperty()))
  {
    std::vector<BlockOrder::Bounds> bounds;
    for (const auto& mapper : this->Drawn)
    {
      bounds.emplace_back();
      mapper->GetInput()->GetBounds(bounds.back().data());
    }
    return BlockOrder::FromBackToFront(
      bounds, FindViewer(renderer->GetActiveCamera(), volume->GetMatrix()));
  }
  std::vector<std::size_t> order(this->Drawn.size());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::Keep(vtkObject*, unsigned long event, void* text)
{
  Message& message = event == vtkCommand::ErrorEvent ? this->Error : this->Warning;
  message.Text = MessageOfEvent(text);
  ++message.Count;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::OnProgress(vtkObject* mapper, unsigned long event, void* fraction)
{
  const auto block = std::find(this->Drawn.begin(), this->Drawn.end(), mapper);
  const auto before = static_cast<double>(block - this->Drawn.begin());
  const auto blocks = static_cast<double>(std::max<std::size_t>(this->Drawn.size(), 1));
  double ofAll = std::min((before + *static_cast<double*>(fraction)) / blocks, 1.0);
  this->InvokeEvent(event, &ofAll);
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  for (const auto& mapper : this->All)
  {
    mapper->ReleaseGraphicsResources(window);
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Blocks: " << this->All.size() << "\n";
  os << indent << "Settings:\n";
  this->Settings->PrintSelf(os, indent.GetNextIndent());
}
