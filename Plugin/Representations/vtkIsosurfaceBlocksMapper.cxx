// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsosurfaceBlocksMapper.h"

#include "BlockOrder.h"
#include "ImageBlocks.h"

#include "vtkBoundingBox.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

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
  return this->Mappers.size() == 1 ? this->Mappers.front()->GetDataSetInput() : nullptr;
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
bool vtkIsosurfaceBlocksMapper::UpdateInputs()
{
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->Update();
  }
  this->UpdateMappers();
  bool all = true;
  for (const auto& mapper : this->Mappers)
  {
    all = mapper->UpdateInputs() && all;
  }
  return all;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  this->NumberOfDrawn = 0;
  this->UpdateMappers();
  const double seconds = this->FindTime(renderer->GetRenderWindow());
  for (const auto& mapper : this->Mappers)
  {
    mapper->SetTimeAllowance(seconds / static_cast<double>(this->Mappers.size()));
  }
  for (std::size_t block : this->FindOrder(renderer, volume))
  {
    this->Mappers[block]->Render(renderer, volume);
  }
  if (this->NumberOfDrawn == this->Mappers.size())
  {
    this->Error.Text.clear();
  }
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::UpdateMappers()
{
  const Images images = FindImages(this->GetInputDataObject(0, 0));
  for (std::size_t i = images.size(); i < this->Mappers.size(); ++i)
  {
    this->Mappers[i]->ReleaseGraphicsResources(nullptr); // of whatever window
  }
  this->Mappers.resize(images.size());
  for (std::size_t i = 0; i < images.size(); ++i)
  {
    if (!this->Mappers[i])
    {
      this->Mappers[i] = vtkSmartPointer<vtkProgressiveIsosurfaceMapper>::New();
      this->Mappers[i]->AddObserver(
        vtkCommand::ProgressEvent, this, &vtkIsosurfaceBlocksMapper::CountDrawn);
      for (const unsigned long event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
      {
        this->Mappers[i]->AddObserver(event, this, &vtkIsosurfaceBlocksMapper::Keep);
      }
    }
    if (this->Mappers[i]->GetInput() != images[i])
    {
      this->Mappers[i]->SetInputData(images[i]);
      this->Mappers[i]->SetCompositeIndex(ImageBlocks::GetCompositeIndex(images[i]));
    }
  }
  this->UpdateSettings();
}

//------------------------------------------------------------------------------
double vtkIsosurfaceBlocksMapper::FindTime(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  const bool goesOn = interactor && interactor->IsA("QVTKInteractor");
  const bool still = window->GetDesiredUpdateRate() < 1.0; // as ParaView sets it
  return still && !goesOn ? VTK_DOUBLE_MAX : this->Settings->GetTimeAllowance();
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::UpdateSettings()
{
  this->Settings->SetClippingPlanes(this->ClippingPlanes);
  this->Settings->SetCropping(this->Cropping);
  this->Settings->SetCroppingRegionPlanes(this->CroppingRegionPlanes);
  this->Settings->SetCroppingRegionFlags(this->CroppingRegionFlags);
  double samples = 0.0;
  for (const auto& mapper : this->Mappers)
  {
    samples += static_cast<double>(mapper->GetInput()->GetNumberOfPoints());
  }
  for (const auto& mapper : this->Mappers)
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
    for (const auto& mapper : this->Mappers)
    {
      bounds.emplace_back();
      mapper->GetInput()->GetBounds(bounds.back().data());
    }
    return BlockOrder::FromBackToFront(
      bounds, FindViewer(renderer->GetActiveCamera(), volume->GetMatrix()));
  }
  std::vector<std::size_t> order(this->Mappers.size());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

//------------------------------------------------------------------------------
// The text is "ERROR: In file, line number\nclass (address): message\n\n", or "Warning: …".
void vtkIsosurfaceBlocksMapper::Keep(vtkObject*, unsigned long event, void* text)
{
  Message& message = event == vtkCommand::ErrorEvent ? this->Error : this->Warning;
  message.Text = static_cast<const char*>(text);
  const std::size_t address = message.Text.find("): ");
  message.Text.erase(0, address == std::string::npos ? 0 : address + 3);
  message.Text.erase(message.Text.find_last_not_of('\n') + 1);
  ++message.Count;
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  for (const auto& mapper : this->Mappers)
  {
    mapper->ReleaseGraphicsResources(window);
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

//------------------------------------------------------------------------------
void vtkIsosurfaceBlocksMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Blocks: " << this->Mappers.size() << "\n";
  os << indent << "Settings:\n";
  this->Settings->PrintSelf(os, indent.GetNextIndent());
}
