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
#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkDiscretizableColorTransferFunction.h"
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

constexpr int Magnitude = -1; // as component of a vector, for the mapper

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
  this->Property->SetScalarOpacity(this->SurfaceOpacity);
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
    this->UpdateLook();
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
    this->CanDraw = this->FindDrawnArray(image);
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
    this->DrawnArray.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPartitionedDataSet> vtkProgressiveIsosurfaceRepresentation::MakeBlocks(
  vtkDataObject* input)
{
  auto made = vtkSmartPointer<vtkPartitionedDataSet>::New();
  const ImageBlocks::Found blocks = ImageBlocks::Find(input);
  if (!this->FindArrayOfBlocks(blocks))
  {
    return made;
  }
  const ImageBlocks::Arrays arrays = { this->DrawnArray.Association, this->DrawnArray.Name,
    this->FindColorArrayOfBlocks(blocks) };
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
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::SelectArrays(
  vtkImageData* image)
{
  auto selected = vtkSmartPointer<vtkImageData>::New();
  selected->CopyStructure(image);
  selected->GetPointData()->AddArray(image->GetPointGhostArray());
  selected->GetCellData()->AddArray(image->GetCellGhostArray());
  vtkDataSetAttributes* from = image->GetAttributes(this->DrawnArray.Association);
  vtkDataSetAttributes* to = selected->GetAttributes(this->DrawnArray.Association);
  to->AddArray(from->GetArray(this->DrawnArray.Name.c_str()));
  const ArraySelection color = this->GetColorArray();
  if (color.Association == this->DrawnArray.Association)
  {
    to->AddArray(from->GetArray(color.Name.c_str()));
  }
  return selected;
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindDrawnArray(vtkImageData* image)
{
  this->DrawnArray = ArraySelection();
  return vtkCompressedVolume::IsCompressed(image) ? this->FindCompressedArray(image)
                                                  : this->FindPlainArray(image);
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindCompressedArray(vtkImageData* image)
{
  vtkNew<vtkCompressedVolume> volume;
  vtkSmartPointer<vtkImageData> piece = DistributedPieces::WithoutGhosts(image);
  if (piece->GetNumberOfPoints() == 0)
  {
    return false; // other processes have all pieces
  }
  if (!volume->Read(piece))
  {
    this->Fail(volume->GetErrorMessage());
    return false;
  }
  this->DrawnArray = { volume->GetAssociation(), volume->GetArrayName() };
  return true;
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::ArraySelection
vtkProgressiveIsosurfaceRepresentation::ChooseArray(vtkDataSet* grid)
{
  if (!this->IsosurfaceArray.Name.empty())
  {
    return this->IsosurfaceArray;
  }
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* array = ImageBlocks::FindDefaultArray(grid, association);
  return { association, array && array->GetName() ? array->GetName() : "" };
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindPlainArray(vtkImageData* image)
{
  this->DrawnArray = this->ChooseArray(image);
  vtkDataSetAttributes* arrays = image->GetAttributes(this->DrawnArray.Association);
  if (arrays && arrays->GetArray(this->DrawnArray.Name.c_str()))
  {
    return true;
  }
  // a process may hold an empty piece of a distributed image, which has no arrays
  if (image->GetNumberOfPoints() > 0)
  {
    this->Fail(this->DrawnArray.Name.empty()
        ? "the image has no array of numbers, and is no compressed volume"
        : "the image has no array \"" + this->DrawnArray.Name +
          "\" of numbers; choose an Isosurface Array");
  }
  return false;
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindArrayOfBlocks(const ImageBlocks::Found& blocks)
{
  this->DrawnArray = ArraySelection();
  bool found = false;
  for (const ImageBlocks::Block& block : blocks.Blocks)
  {
    this->DrawnArray = found ? this->DrawnArray : this->ChooseArray(block.Grid);
    vtkImageData* image = vtkImageData::SafeDownCast(block.Grid);
    if (image && vtkCompressedVolume::IsCompressed(image) && !found)
    {
      found = this->FindCompressedArray(image);
    }
    found = found ||
      ImageBlocks::HasArrays(
        block.Grid, { this->DrawnArray.Association, this->DrawnArray.Name, "" });
  }
  // other processes may have the blocks that can be drawn
  if (!DistributedPieces::IsTrueAnywhere(found))
  {
    const bool anyGrid = DistributedPieces::IsTrueAnywhere(!blocks.Blocks.empty());
    this->Fail(anyGrid
        ? "no block has the array \"" + this->DrawnArray.Name + "\"; choose an Isosurface Array"
        : "none of the blocks is an image; use the filter Resample To Image");
  }
  return found;
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::ArraySelection
vtkProgressiveIsosurfaceRepresentation::GetColorArray()
{
  vtkInformation* color = this->GetInputArrayInformation(0);
  const bool chosen = this->ColorMap && color && color->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    color->Has(vtkDataObject::FIELD_NAME()) && color->Get(vtkDataObject::FIELD_NAME());
  return chosen ? ArraySelection{ color->Get(vtkDataObject::FIELD_ASSOCIATION()),
    color->Get(vtkDataObject::FIELD_NAME()) }
                : ArraySelection();
}

//------------------------------------------------------------------------------
vtkDataArray* vtkProgressiveIsosurfaceRepresentation::FindArray(const std::string& name)
{
  vtkImageData* image = vtkImageData::SafeDownCast(this->Cache);
  int association = this->DrawnArray.Association;
  auto* blocks = vtkPartitionedDataSet::SafeDownCast(this->Cache);
  if (blocks && blocks->GetNumberOfPartitions() > 0)
  {
    image = vtkImageData::SafeDownCast(blocks->GetPartition(0));
    association = vtkDataObject::FIELD_ASSOCIATION_POINTS; // whatever it was
  }
  return image ? image->GetAttributes(association)->GetArray(name.c_str()) : nullptr;
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::GetDrawnComponent()
{
  vtkDataArray* array = this->FindArray(this->DrawnArray.Name);
  const bool isLast = array && this->IsosurfaceComponent == array->GetNumberOfComponents();
  return isLast ? Magnitude : this->IsosurfaceComponent; // as ParaView numbers them
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::GetColorComponent()
{
  vtkDataArray* array = this->FindArray(this->GetColorArray().Name);
  if (!array || array->GetNumberOfComponents() == 1)
  {
    return 0;
  }
  return this->ColorMap->GetVectorMode() == vtkScalarsToColors::MAGNITUDE
    ? Magnitude
    : std::max(this->ColorMap->GetVectorComponent(), 0);
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::IsColoredByDrawnArray()
{
  const ArraySelection color = this->GetColorArray();
  if (color.Name.empty() || color.Association != this->DrawnArray.Association ||
    color.Name != this->DrawnArray.Name)
  {
    return false;
  }
  vtkDataArray* array = this->FindArray(color.Name); // a compressed volume has one component
  return !array || array->GetNumberOfComponents() == 1 ||
    this->GetColorComponent() == this->GetDrawnComponent();
}

//------------------------------------------------------------------------------
std::string vtkProgressiveIsosurfaceRepresentation::FindColorArrayOfBlocks(
  const ImageBlocks::Found& blocks)
{
  const ArraySelection color = this->GetColorArray();
  const ImageBlocks::Arrays drawn = { this->DrawnArray.Association, this->DrawnArray.Name, "" };
  ImageBlocks::Arrays arrays = drawn;
  arrays.Color = color.Association == this->DrawnArray.Association ? color.Name : "";
  const bool everywhere = std::all_of(blocks.Blocks.begin(), blocks.Blocks.end(),
    [&](const ImageBlocks::Block& block)
    {
      return ImageBlocks::HasArrays(block.Grid, arrays) ||
        !ImageBlocks::HasArrays(block.Grid, drawn);
    });
  return everywhere ? arrays.Color : "";
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
  const bool cellData = this->DrawnArray.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS &&
    vtkImageData::SafeDownCast(this->Cache); // of blocks it has become point data
  mapper->SelectScalarArray(this->DrawnArray.Name.c_str());
  mapper->SetScalarMode(
    cellData ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  mapper->SetComponent(this->GetDrawnComponent());
  this->UpdateCropping();
  this->UpdateLook();
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
void vtkProgressiveIsosurfaceRepresentation::UpdateColors()
{
  vtkProgressiveIsosurfaceMapper* mapper = this->GetIsosurfaceMapper();
  const ArraySelection color = this->GetColorArray();
  const bool byOther = color.Association == this->DrawnArray.Association &&
    !this->IsColoredByDrawnArray() && this->FindArray(color.Name);
  mapper->SetColorArrayName(byOther ? color.Name.c_str() : nullptr);
  mapper->SetColorComponent(byOther ? this->GetColorComponent() : 0);
  mapper->SetColorLookupTable(byOther ? this->ColorMap.Get() : nullptr);
  this->WarnOfLostColors(!byOther && !this->IsColoredByDrawnArray() ? color : ArraySelection());
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::WarnOfLostColors(const ArraySelection& lost)
{
  const bool points = this->DrawnArray.Association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const bool ofOthers = points ? lost.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS
                               : lost.Association == vtkDataObject::FIELD_ASSOCIATION_POINTS;
  const std::string name = this->CanDraw && ofOthers ? lost.Name : "";
  if (name != this->LostColor && !name.empty())
  {
    const std::string filter = points ? "Cell Data to Point Data" : "Point Data to Cell Data";
    this->Warn(std::string("the surface of ") + (points ? "point" : "cell") +
      " data has its solid colour: the array \"" + name + "\" belongs to " +
      (points ? "cells" : "points") + "; use the filter " + filter + " to colour by it");
  }
  this->LostColor = name;
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
void vtkProgressiveIsosurfaceRepresentation::UpdateLook()
{
  const bool mapped = this->IsColoredByDrawnArray();
  this->Property->SetColor(mapped ? this->ColorMap.Get() : this->SolidColor.Get());
  auto* map = vtkDiscretizableColorTransferFunction::SafeDownCast(this->ColorMap);
  vtkPiecewiseFunction* opacities =
    mapped && map && map->GetEnableOpacityMapping() ? map->GetScalarOpacityFunction() : nullptr;
  vtkContourValues* values = this->Property->GetIsoSurfaceValues();
  vtkNew<vtkPiecewiseFunction> wanted;
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    const double value = values->GetValue(i);
    wanted->AddPoint(value, this->Opacity * (opacities ? opacities->GetValue(value) : 1.0));
  }
  const int nodes = wanted->GetSize();
  if (nodes != this->SurfaceOpacity->GetSize() ||
    !std::equal(wanted->GetDataPointer(), wanted->GetDataPointer() + 2 * nodes,
      this->SurfaceOpacity->GetDataPointer()))
  {
    this->SurfaceOpacity->DeepCopy(wanted);
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetIsosurfaceArray(
  int, int, int, int association, const char* name)
{
  const std::string newName = name ? name : "";
  if (association == this->IsosurfaceArray.Association && newName == this->IsosurfaceArray.Name)
  {
    return;
  }
  this->IsosurfaceArray = { association, newName };
  this->MarkModified();
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetIsosurfaceComponent(int component)
{
  this->IsosurfaceComponent = component;
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
  // one node gives every isovalue the same colour
  this->SolidColor->RemoveAllPoints();
  this->SolidColor->AddRGBPoint(0.0, red, green, blue);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetOpacity(double opacity)
{
  this->Opacity = opacity;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetColor(vtkColorTransferFunction* colorMap)
{
  this->ColorMap = colorMap;
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
  os << indent << "IsosurfaceArray: " << this->IsosurfaceArray.Name << "\n";
  os << indent << "DrawnArray: " << this->DrawnArray.Name << "\n";
  os << indent << "CanDraw: " << this->CanDraw << "\n";
}
