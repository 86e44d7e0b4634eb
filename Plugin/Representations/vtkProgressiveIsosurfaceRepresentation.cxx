// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceRepresentation.h"

#include "DistributedPieces.h"
#include "ImageBlocks.h"
#include "Pieces/PieceExtents.h"
#include "vtkIsosurfaceBlocksMapper.h"
#include "vtkPVIsosurfaceLODVolume.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVRenderView.h"
#include "vtkPVView.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

namespace
{
// Blocks that a ray may test in one pass.
constexpr int SPECULATION_ON = 64;
constexpr int SPECULATION_OFF = 1;
}

vtkStandardNewMacro(vtkProgressiveIsosurfaceRepresentation);

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::vtkProgressiveIsosurfaceRepresentation()
{
  auto mapper = vtkSmartPointer<vtkIsosurfaceBlocksMapper>::New();
  mapper->GetSettings()->LitLikeMeshesOn(); // looks like the surface of ParaView's Contour
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
    if (!vtkProgressiveIsosurfaceMapper::IsTranslucent(this->Property))
    {
      outInfo->Remove(vtkPVRenderView::NEED_ORDERED_COMPOSITING());
    }
    vtkPVRenderView::SetGeometryBounds(inInfo, this, this->DataBounds, this->Actor->GetMatrix());
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkProgressiveIsosurfaceRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int good = this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  // blocks of composite data belong to a process as a whole
  if (inputVector[0]->GetNumberOfInformationObjects() == 1 &&
    vtkImageData::GetData(inputVector[0], 0) && DistributedPieces::GetNumberOfProcesses() > 1)
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
  this->ErrorMessage.clear();
  if (inputVector[0]->GetNumberOfInformationObjects() == 0)
  {
    this->CanDraw = true; // without data the outline
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  if (vtkImageData* image = vtkImageData::GetData(inputVector[0], 0))
  {
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
  this->DataSize = drawn->GetActualMemorySize();
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
  this->ColorOfBlocks = this->FindOtherColorArray(blocks);
  const ImageBlocks::Arrays arrays = { this->DrawnArray.Association, this->DrawnArray.Name,
    this->ColorOfBlocks };
  for (vtkDataSet* block : blocks.Grids)
  {
    if (!ImageBlocks::HasArrays(block, { arrays.Association, arrays.Drawn, "" }))
    {
      continue; // as for Contour: arrays may be partial
    }
    if (auto image = ImageBlocks::MakeImage(block, arrays, this->ResampleUnevenGrids))
    {
      made->SetPartition(made->GetNumberOfPartitions(), image);
    }
    else
    {
      this->ErrorMessage = "the steps of a rectilinear grid are uneven: switch Resample Uneven "
                           "Grids on, or use the filter Resample To Image";
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
  to->AddArray(from->GetArray(this->FindOtherColorArray(image).c_str()));
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
    this->ErrorMessage = volume->GetErrorMessage();
    return false;
  }
  this->DrawnArray = { volume->GetAssociation(), volume->GetArrayName() };
  return true;
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindPlainArray(vtkImageData* image)
{
  this->DrawnArray = this->IsosurfaceArray;
  if (this->DrawnArray.Name.empty())
  {
    int association = vtkCompressedVolume::PointData;
    vtkDataArray* array = vtkImageZFPCompress::FindDefaultArray(image, association);
    this->DrawnArray = { association, array && array->GetName() ? array->GetName() : "" };
  }
  vtkDataSetAttributes* arrays = image->GetAttributes(this->DrawnArray.Association);
  if (arrays && arrays->GetArray(this->DrawnArray.Name.c_str()))
  {
    return true;
  }
  // a process may hold an empty piece of a distributed image, which has no arrays
  if (image->GetNumberOfPoints() > 0)
  {
    this->ErrorMessage = "the image has no array \"" + this->DrawnArray.Name +
      "\" and is no compressed volume; choose an Isosurface Array";
  }
  return false;
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::FindArrayOfBlocks(const ImageBlocks::Found& blocks)
{
  this->DrawnArray = this->IsosurfaceArray;
  bool found = false;
  for (vtkDataSet* block : blocks.Grids)
  {
    vtkImageData* image = vtkImageData::SafeDownCast(block);
    if (image && vtkCompressedVolume::IsCompressed(image) && !found)
    {
      found = this->FindCompressedArray(image);
    }
    found = found ||
      ImageBlocks::HasArrays(block, { this->DrawnArray.Association, this->DrawnArray.Name, "" });
  }
  // other processes may have the blocks that can be drawn
  if (!DistributedPieces::IsTrueAnywhere(found))
  {
    const bool anyGrid = DistributedPieces::IsTrueAnywhere(!blocks.Grids.empty());
    this->ErrorMessage = anyGrid
      ? "no block has the array \"" + this->DrawnArray.Name + "\"; choose an Isosurface Array"
      : "none of the blocks is an image; use the filter Resample To Image";
  }
  return found;
}

//------------------------------------------------------------------------------
bool vtkProgressiveIsosurfaceRepresentation::IsColoredByDrawnArray()
{
  vtkInformation* color = this->GetInputArrayInformation(0);
  return color && color->Has(vtkDataObject::FIELD_ASSOCIATION()) &&
    color->Has(vtkDataObject::FIELD_NAME()) && color->Get(vtkDataObject::FIELD_NAME()) &&
    color->Get(vtkDataObject::FIELD_ASSOCIATION()) == this->DrawnArray.Association &&
    color->Get(vtkDataObject::FIELD_NAME()) == this->DrawnArray.Name;
}

//------------------------------------------------------------------------------
std::string vtkProgressiveIsosurfaceRepresentation::FindOtherColorArray(vtkImageData* image)
{
  const std::string name = image ? this->GetWantedColorArray() : std::string();
  const bool there = !name.empty() && !vtkCompressedVolume::IsCompressed(image) &&
    image->GetAttributes(this->DrawnArray.Association)->GetArray(name.c_str());
  return there ? name : "";
}

//------------------------------------------------------------------------------
std::string vtkProgressiveIsosurfaceRepresentation::FindOtherColorArray(
  const ImageBlocks::Found& blocks)
{
  const ImageBlocks::Arrays drawn = { this->DrawnArray.Association, this->DrawnArray.Name, "" };
  ImageBlocks::Arrays arrays = drawn;
  arrays.Color = this->GetWantedColorArray();
  const bool everywhere = std::all_of(blocks.Grids.begin(), blocks.Grids.end(),
    [&](vtkDataSet* block)
    { return ImageBlocks::HasArrays(block, arrays) || !ImageBlocks::HasArrays(block, drawn); });
  return everywhere ? arrays.Color : "";
}

//------------------------------------------------------------------------------
std::string vtkProgressiveIsosurfaceRepresentation::GetWantedColorArray()
{
  vtkInformation* color = this->GetInputArrayInformation(0);
  if (!color || !color->Has(vtkDataObject::FIELD_ASSOCIATION()) ||
    !color->Has(vtkDataObject::FIELD_NAME()) || !color->Get(vtkDataObject::FIELD_NAME()) ||
    color->Get(vtkDataObject::FIELD_ASSOCIATION()) != this->DrawnArray.Association ||
    color->Get(vtkDataObject::FIELD_NAME()) == this->DrawnArray.Name)
  {
    return "";
  }
  return color->Get(vtkDataObject::FIELD_NAME());
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
  this->UpdateCropping();
  this->UpdateLook();
  this->UpdateColors();
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
  vtkImageData* image = vtkImageData::SafeDownCast(this->Cache);
  const std::string other = image ? this->FindOtherColorArray(image) : this->ColorOfBlocks;
  const std::string name = this->ColorMap ? other : "";
  mapper->SetColorArrayName(name.empty() ? nullptr : name.c_str());
  mapper->SetColorComponent(this->ColorMap ? std::max(this->ColorMap->GetVectorComponent(), 0) : 0);
  mapper->SetColorLookupTable(name.empty() ? nullptr : this->ColorMap.Get());
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateLook()
{
  const bool mapped = this->ColorMap && this->IsColoredByDrawnArray();
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
  this->GetIsosurfaceMapper()->SetComponent(component);
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
const std::string& vtkProgressiveIsosurfaceRepresentation::GetErrorMessage()
{
  return this->ErrorMessage.empty() ? this->GetBlocksMapper()->GetErrorMessage()
                                    : this->ErrorMessage;
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsosurfaceArray: " << this->IsosurfaceArray.Name << "\n";
  os << indent << "DrawnArray: " << this->DrawnArray.Name << "\n";
  os << indent << "CanDraw: " << this->CanDraw << "\n";
}
