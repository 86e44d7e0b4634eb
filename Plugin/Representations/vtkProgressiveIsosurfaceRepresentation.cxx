// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceRepresentation.h"

#include "DistributedPieces.h"
#include "ImageBlocks.h"
#include "Pieces/PieceExtents.h"
#include "vtkIsosurfaceBlocksMapper.h"
#include "vtkPVIsosurfaceLODVolume.h"

#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVRenderView.h"
#include "vtkPVView.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProcessModule.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUniformGridAMR.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

namespace
{
// Blocks that a ray may test in one pass.
constexpr int SPECULATION_ON = 64;
constexpr int SPECULATION_OFF = 1;

using Message = vtkIsosurfaceBlocksMapper::Message;

// Finds the box around a transformed one; ParaView's own is turned inside out by a mirroring scale.
void TransformBounds(const double bounds[6], vtkMatrix4x4* matrix, double transformed[6])
{
  vtkBoundingBox box;
  for (int corner = 0; corner < 8 && vtkMath::AreBoundsInitialized(bounds); ++corner)
  {
    double place[4] = { bounds[corner % 2], bounds[2 + corner / 2 % 2], bounds[4 + corner / 4], 1 };
    matrix->MultiplyPoint(place, place);
    box.AddPoint(place);
  }
  vtkMath::UninitializeBounds(transformed);
  box.GetBounds(transformed);
}

// Does ParaView reduce images itself while the camera moves?
bool IsReducedByParaView()
{
  const int process = vtkProcessModule::GetProcessType();
  return process == vtkProcessModule::PROCESS_SERVER ||
    process == vtkProcessModule::PROCESS_RENDER_SERVER ||
    DistributedPieces::GetNumberOfProcesses() > 1;
}

Message Join(const Message& first, const Message& second)
{
  return { first.Text.empty() ? second.Text : first.Text, first.Count + second.Count };
}
}

vtkStandardNewMacro(vtkProgressiveIsosurfaceRepresentation);

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::vtkProgressiveIsosurfaceRepresentation()
{
  auto mapper = vtkSmartPointer<vtkIsosurfaceBlocksMapper>::New();
  mapper->GetSettings()->LitLikeMeshesOn(); // looks like the surface of ParaView's Contour
  for (const unsigned long event : { vtkProgressiveIsosurfaceMapper::CompressionEvent,
         vtkProgressiveIsosurfaceMapper::LoadingEvent })
  {
    mapper->AddObserver(event, this, &vtkProgressiveIsosurfaceRepresentation::ShowProgress);
  }
  this->SetProgressText("Progressive Isosurface"); // while ParaView updates it
  this->VolumeMapper = mapper;
  vtkMath::UninitializeBounds(this->WholeBounds);
  this->Actor = vtkSmartPointer<vtkPVIsosurfaceLODVolume>::New();
  this->Actor->SetProperty(this->Property);
  this->Actor->SetLODMapper(this->OutlineMapper);
  this->Property->ShadeOn();
  this->Property->SetScalarOpacity(this->Colors.GetOpacities());
  this->SetDiffuseColor(1.0, 1.0, 1.0);
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::~vtkProgressiveIsosurfaceRepresentation() = default;

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkRectilinearGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* requestType, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (!this->Superclass::ProcessViewRequest(requestType, inInfo, outInfo))
  {
    return 0;
  }
  if (requestType == vtkPVView::REQUEST_UPDATE())
  {
    // The superclass asks for ordered compositing; opaque surfaces are composited by depth.
    this->UpdateColors();
    if (!this->GetIsosurfaceMapper()->DrawsTranslucent(this->Property))
    {
      outInfo->Remove(vtkPVRenderView::NEED_ORDERED_COMPOSITING());
    }
    double bounds[6];
    TransformBounds(this->DataBounds, this->Actor->GetMatrix(), bounds);
    vtkPVRenderView::SetGeometryBounds(inInfo, this, bounds);
  }
  else if (requestType == vtkPVView::REQUEST_RENDER())
  {
    auto* view = vtkPVRenderView::SafeDownCast(inInfo->Get(vtkPVView::VIEW()));
    const bool reduces = view && !IsReducedByParaView();
    this->GetBlocksMapper()->SetMovingReductionFactor(
      reduces ? view->GetInteractiveRenderImageReductionFactor() : 1);
    if (DistributedPieces::GetNumberOfProcesses() > 1)
    {
      // What one process cannot draw is drawn by none, as if it were one: no half of a surface
      // shows.
      const bool good = !this->CanDraw || this->GetBlocksMapper()->UpdateInputs(this->Property);
      this->Actor->SetVisibility(!DistributedPieces::IsTrueAnywhere(!good) && this->CanDraw);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::ShowProgress(
  vtkObject*, unsigned long event, void* fraction)
{
  const bool compresses = event == vtkProgressiveIsosurfaceMapper::CompressionEvent;
  this->SetProgressText(
    compresses ? "Compressing for Progressive Isosurface" : "Loading Progressive Isosurface");
  this->UpdateProgress(*static_cast<double*>(fraction));
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int good = this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  // blocks may be in pieces, too; those of AMR belong to a process as a whole
  if (inputVector[0]->GetNumberOfInformationObjects() == 1 &&
    !vtkUniformGridAMR::GetData(inputVector[0], 0) && DistributedPieces::GetNumberOfProcesses() > 1)
  {
    inputVector[0]->GetInformationObject(0)->Set(
      vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(),
      vtkCompressedVolume::NumberOfGhostLevels);
  }
  return good;
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Cache = nullptr;
  this->Error.Text.clear();
  if (inputVector[0]->GetNumberOfInformationObjects() == 0)
  {
    this->CanDraw = true; // without data the outline
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  if (vtkImageData* input = vtkImageData::GetData(inputVector[0], 0))
  {
    const vtkSmartPointer<vtkImageData> image = ImageBlocks::WithNamedScalars(input);
    this->CanDraw = this->FindArray(image);
    this->SetPiece(this->MakePiece(image));
    this->GetIsosurfaceMapper()->SetSelectionExtent(image->GetExtent()); // of what is selected from
  }
  else
  {
    this->SetBlocks(this->MakeBlocks(vtkDataObject::GetData(inputVector[0], 0)));
    this->GetIsosurfaceMapper()->SetSelectionExtent(0, -1, 0, -1, 0, -1); // each block's own
  }
  DistributedPieces::FindWholeBounds(this->DataBounds, this->WholeBounds);
  vtkStreamingDemandDrivenPipeline::GetWholeExtent(
    inputVector[0]->GetInformationObject(0), this->WholeExtent);
  // skips vtkImageVolumeRepresentation's, which would cut off the ghost cells
  // NOLINTNEXTLINE(bugprone-parent-virtual-call)
  return this->vtkVolumeRepresentation::RequestData(request, inputVector, outputVector);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetPiece(vtkImageData* piece)
{
  int extent[6];
  PieceExtents::GetExtentWithoutGhosts(piece, extent);
  vtkNew<vtkImageData> outline;
  outline->CopyStructure(piece);
  outline->SetExtent(extent);
  this->CanDraw = this->CanDraw && outline->GetNumberOfPoints() > 0;
  this->SetDrawn(piece, outline->GetBounds());
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetBlocks(vtkPartitionedDataSet* blocks)
{
  double bounds[6];
  blocks->GetBounds(bounds);
  this->CanDraw = blocks->GetNumberOfPartitions() > 0;
  this->SetDrawn(blocks, bounds);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetDrawn(vtkDataObject* drawn, const double bounds[6])
{
  std::copy(bounds, bounds + 6, this->DataBounds);
  this->OutlineSource->SetBounds(this->DataBounds);
  this->OutlineSource->Update();
  // of what is drawn, which a compressed volume becomes: ParaView's LOD Threshold goes by it
  const vtkIdType samples = drawn->GetNumberOfElements(vtkDataObject::POINT);
  const auto decoded = static_cast<unsigned long>(samples * sizeof(float) >> 10);
  this->DataSize = std::max(drawn->GetActualMemorySize(), decoded);
  this->Cache = drawn;
  this->Actor->SetEnableLOD(0);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::MakePiece(vtkImageData* image)
{
  if (DistributedPieces::GetNumberOfProcesses() == 1)
  {
    auto whole = vtkSmartPointer<vtkImageData>::Take(image->NewInstance());
    whole->ShallowCopy(image);
    return whole;
  }
  // all processes have to make the same kind of piece: they exchange samples for it
  if (DistributedPieces::IsTrueAnywhere(vtkCompressedVolume::IsCompressed(image)))
  {
    return DistributedPieces::MakeCompressedPiece(image, this->CanDraw);
  }
  return DistributedPieces::MakePlainPiece(this->SelectArrays(image),
    this->Drawn.Get().Association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPartitionedDataSet> vtkProgressiveIsosurfaceRepresentation::MakeBlocks(
  vtkDataObject* input)
{
  auto made = vtkSmartPointer<vtkPartitionedDataSet>::New();
  const ImageBlocks::Found blocks = ImageBlocks::Find(input);
  if (!this->FindArray(blocks))
  {
    return made;
  }
  const ImageBlocks::Arrays arrays = { this->Drawn.Get().Association, this->Drawn.Get().Name,
    SurfaceColors::FindArrayOfBlocks(this->GetColorScene(), blocks) };
  for (const ImageBlocks::Block& block : blocks.Blocks)
  {
    if (!ImageBlocks::HasArrays(block.Grid, { arrays.Association, arrays.Drawn, "" }))
    {
      continue; // as for Contour: arrays may be partial
    }
    if (auto image = ImageBlocks::MakeImage(block, arrays, this->ResampleUnevenGrids))
    {
      made->SetPartition(made->GetNumberOfPartitions(), image);
    }
    else
    {
      this->Fail("the steps of a rectilinear grid are uneven: switch Resample Uneven Grids on, or "
                 "use the filter Resample To Image");
    }
  }
  return made;
}

//------------------------------------------------------------------------------
template <typename Input>
bool vtkProgressiveIsosurfaceRepresentation::FindArray(const Input& input)
{
  std::string error;
  const bool found = this->Drawn.Find(input, error);
  if (!error.empty())
  {
    this->Fail(error);
  }
  return found;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::SelectArrays(
  vtkImageData* image)
{
  auto selected = vtkSmartPointer<vtkImageData>::New();
  selected->CopyStructure(image);
  selected->GetPointData()->AddArray(image->GetPointGhostArray());
  selected->GetCellData()->AddArray(image->GetCellGhostArray());
  vtkDataSetAttributes* from = image->GetAttributes(this->Drawn.Get().Association);
  vtkDataSetAttributes* to = selected->GetAttributes(this->Drawn.Get().Association);
  to->AddArray(from->GetArray(this->Drawn.Get().Name.c_str()));
  const ArrayName color = this->GetColorScene().Color;
  if (color.Association == this->Drawn.Get().Association)
  {
    to->AddArray(from->GetArray(color.Name.c_str()));
  }
  return selected;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  // Pieces and blocks hold only the arrays that are drawn. The client, a process by itself without
  // data, has to ask for new ones too: the view delivers only what all processes take for new.
  if (DistributedPieces::GetNumberOfProcesses() > 1 || this->GetNumberOfInputConnections(0) == 0 ||
    vtkPartitionedDataSet::SafeDownCast(this->Cache))
  {
    this->MarkModified();
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateMapperParameters()
{
  // ParaView calls this before every image: what has not changed must keep its modified time, or
  // the mapper restarts the image.
  vtkProgressiveIsosurfaceMapper* mapper = this->GetIsosurfaceMapper();
  const bool cellData = this->Drawn.Get().Association == vtkDataObject::FIELD_ASSOCIATION_CELLS &&
    vtkImageData::SafeDownCast(this->Cache); // of blocks it has become point data
  mapper->SelectScalarArray(this->Drawn.Get().Name.c_str());
  mapper->SetScalarMode(
    cellData ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  mapper->SetComponent(this->Drawn.GetComponent(this->Cache));
  this->UpdateCropping();
  this->UpdateColors();
  this->UpdateClipping(this->VolumeMapper);
  this->Actor->SetMapper(this->VolumeMapper);
  this->Actor->SetVisibility(this->CanDraw);
}

//------------------------------------------------------------------------------
// As ParaView's Volume does, but with the bounds of all pieces.
void vtkProgressiveIsosurfaceRepresentation::UpdateCropping()
{
  double planes[6];
  for (int i = 0; i < 6; ++i)
  {
    planes[i] = this->CroppingOrigin[i / 2] + this->WholeBounds[i] * this->CroppingScale[i / 2];
  }
  this->VolumeMapper->SetCroppingRegionPlanes(planes);
}

//------------------------------------------------------------------------------
SurfaceColors::Scene vtkProgressiveIsosurfaceRepresentation::GetColorScene()
{
  return { this->Drawn, this->Cache, this->Colors.GetArray(this->GetInputArrayInformation(0)) };
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateColors()
{
  const SurfaceColors::Scene scene = this->GetColorScene();
  this->Colors.UpdateProperty(this->Property, scene);
  this->Colors.UpdateMapper(this->GetIsosurfaceMapper(), scene);
  const std::string loss = this->Colors.DescribeLoss(scene, this->CanDraw);
  if (!loss.empty())
  {
    this->Warn(loss);
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateClipping(vtkVolumeMapper* mapper)
{
  for (const ClipPlane& clip : this->ClipPlanes)
  {
    vtkPlaneCollection* planes = mapper->GetClippingPlanes();
    const bool has = planes && planes->IsItemPresent(clip.Plane) != 0;
    if (clip.Used && !has)
    {
      mapper->AddClippingPlane(clip.Plane);
    }
    else if (!clip.Used && has)
    {
      mapper->RemoveClippingPlane(clip.Plane);
    }
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetIsosurfaceArray(
  int, int, int, int association, const char* name)
{
  if (this->Drawn.Choose({ association, name ? name : "" }))
  {
    this->MarkModified();
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetIsosurfaceComponent(int component)
{
  this->Drawn.ChooseComponent(component);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetNumberOfIsovalues(int number)
{
  vtkContourValues* values = this->Property->GetIsoSurfaceValues();
  if (values->GetNumberOfContours() != number)
  {
    values->SetNumberOfContours(number);
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetIsovalue(int index, double value)
{
  vtkContourValues* values = this->Property->GetIsoSurfaceValues();
  if (index >= values->GetNumberOfContours() || values->GetValue(index) != value)
  {
    values->SetValue(index, value);
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetDiffuseColor(double red, double green, double blue)
{
  this->Colors.SetSolid(red, green, blue);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetOpacity(double opacity)
{
  this->Colors.SetOpacity(opacity);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetColor(vtkColorTransferFunction* colorMap)
{
  this->Colors.SetMap(colorMap);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetRate(double bitsPerVoxel)
{
  this->GetIsosurfaceMapper()->SetRate(bitsPerVoxel);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetMaskNonFinite(bool on)
{
  this->GetIsosurfaceMapper()->SetMaskNonFinite(on);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetSpeculation(bool on)
{
  this->GetIsosurfaceMapper()->SetSpeculationLimit(on ? SPECULATION_ON : SPECULATION_OFF);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetMemoryBudget(int mebibytes)
{
  this->GetIsosurfaceMapper()->SetMemoryBudget(static_cast<vtkTypeInt64>(mebibytes) << 20);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetFrameTime(double milliseconds)
{
  this->GetIsosurfaceMapper()->SetTimeAllowance(1e-3 * milliseconds);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetLevelOfDetail(int when)
{
  this->GetIsosurfaceMapper()->SetLevelOfDetail(when);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetPixelTolerance(double pixels)
{
  this->GetIsosurfaceMapper()->SetPixelTolerance(pixels);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetUseClipPlane(bool on)
{
  this->ClipPlanes[0].Used = on;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetClipPlaneOrigin(double x, double y, double z)
{
  this->ClipPlanes[0].Plane->SetOrigin(x, y, z);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetClipPlaneNormal(double x, double y, double z)
{
  this->ClipPlanes[0].Plane->SetNormal(x, y, z);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetUseClipPlane2(bool on)
{
  this->ClipPlanes[1].Used = on;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetClipPlaneOrigin2(double x, double y, double z)
{
  this->ClipPlanes[1].Plane->SetOrigin(x, y, z);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetClipPlaneNormal2(double x, double y, double z)
{
  this->ClipPlanes[1].Plane->SetNormal(x, y, z);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetResampleUnevenGrids(bool on)
{
  if (this->ResampleUnevenGrids != on)
  {
    this->ResampleUnevenGrids = on;
    this->MarkModified();
  }
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceMapper* vtkProgressiveIsosurfaceRepresentation::GetIsosurfaceMapper()
{
  return this->GetBlocksMapper()->GetSettings();
}

//------------------------------------------------------------------------------
vtkIsosurfaceBlocksMapper* vtkProgressiveIsosurfaceRepresentation::GetBlocksMapper()
{
  return vtkIsosurfaceBlocksMapper::SafeDownCast(this->VolumeMapper);
}

//------------------------------------------------------------------------------
vtkIsosurfaceBlocksMapper::Message vtkProgressiveIsosurfaceRepresentation::GetError()
{
  return Join(this->Error, this->GetBlocksMapper()->GetError());
}

//------------------------------------------------------------------------------
vtkIsosurfaceBlocksMapper::Message vtkProgressiveIsosurfaceRepresentation::GetWarning()
{
  return Join(this->Warning, this->GetBlocksMapper()->GetWarning());
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::Fail(const std::string& message)
{
  this->Error = { message, this->Error.Count + 1 };
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::Warn(const std::string& message)
{
  this->Warning = { message, this->Warning.Count + 1 };
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsosurfaceArray: " << this->Drawn.GetChoice().Name << "\n";
  os << indent << "DrawnArray: " << this->Drawn.Get().Name << "\n";
  os << indent << "CanDraw: " << this->CanDraw << "\n";
}
