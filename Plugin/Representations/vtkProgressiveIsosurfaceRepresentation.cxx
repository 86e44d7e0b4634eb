// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceRepresentation.h"

#include "DistributedPieces.h"
#include "Pieces/PieceExtents.h"
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
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVRenderView.h"
#include "vtkPVView.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkProgressiveIsosurfaceStatistics.h"
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
  auto mapper = vtkSmartPointer<vtkProgressiveIsosurfaceMapper>::New();
  mapper->LitLikeMeshesOn(); // looks like the surface of ParaView's Contour
  this->VolumeMapper = mapper;
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
  if (inputVector[0]->GetNumberOfInformationObjects() == 1 &&
    DistributedPieces::GetNumberOfProcesses() > 1)
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
  const bool hasInput = inputVector[0]->GetNumberOfInformationObjects() == 1;
  vtkImageData* image = hasInput ? vtkImageData::GetData(inputVector[0], 0) : nullptr;
  // a process without input has no data and shows the outline
  this->CanDraw = !hasInput || this->FindDrawnArray(image);
  if (!image)
  {
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  this->SetPiece(this->MakePiece(image));
  this->GetIsosurfaceMapper()->SetSelectionExtent(image->GetExtent()); // of what is selected from
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
  outline->GetBounds(this->DataBounds);
  this->OutlineSource->SetBounds(this->DataBounds);
  this->OutlineSource->Update();
  this->DataSize = piece->GetActualMemorySize();
  this->Cache = piece;
  this->Actor->SetEnableLOD(0);
  this->CanDraw = this->CanDraw && outline->GetNumberOfPoints() > 0;
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
  if (!image)
  {
    vtkErrorMacro(
      "Progressive Isosurface shows image data only; use the filter Resample To Image, or Extract "
      "Block for one image of a composite data set.");
    return false;
  }
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
    vtkErrorMacro("Progressive Isosurface: " << volume->GetErrorMessage());
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
    vtkErrorMacro("Progressive Isosurface: the image has no array \""
      << this->DrawnArray.Name << "\" and is no compressed volume; choose an Isosurface Array.");
  }
  return false;
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
  vtkInformation* color = this->GetInputArrayInformation(0);
  if (!image || !color || !color->Has(vtkDataObject::FIELD_ASSOCIATION()) ||
    !color->Has(vtkDataObject::FIELD_NAME()) || !color->Get(vtkDataObject::FIELD_NAME()) ||
    color->Get(vtkDataObject::FIELD_ASSOCIATION()) != this->DrawnArray.Association)
  {
    return "";
  }
  const std::string name = color->Get(vtkDataObject::FIELD_NAME());
  vtkDataSetAttributes* arrays = image->GetAttributes(this->DrawnArray.Association);
  const bool there = name != this->DrawnArray.Name && arrays && arrays->GetArray(name.c_str());
  return there && !vtkCompressedVolume::IsCompressed(image) ? name : "";
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  // Pieces hold only the arrays that are drawn. The client, a process by itself without data, has
  // to ask for new ones too: the view delivers only what all processes take for new.
  if (DistributedPieces::GetNumberOfProcesses() > 1 || this->GetNumberOfInputConnections(0) == 0)
  {
    this->MarkModified();
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateMapperParameters()
{
  // ParaView calls this before every image: what has not changed must keep its modified time, or
  // the mapper restarts the image.
  this->VolumeMapper->SelectScalarArray(this->DrawnArray.Name.c_str());
  this->VolumeMapper->SetScalarMode(
    this->DrawnArray.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS
      ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA
      : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  this->UpdateLook();
  this->UpdateColors();
  this->Actor->SetMapper(this->VolumeMapper);
  this->Actor->SetVisibility(this->CanDraw);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateColors()
{
  vtkProgressiveIsosurfaceMapper* mapper = this->GetIsosurfaceMapper();
  const std::string name = this->ColorMap
    ? this->FindOtherColorArray(vtkImageData::SafeDownCast(this->Cache))
    : std::string();
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
vtkProgressiveIsosurfaceMapper* vtkProgressiveIsosurfaceRepresentation::GetIsosurfaceMapper()
{
  return vtkProgressiveIsosurfaceMapper::SafeDownCast(this->VolumeMapper);
}

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceStatistics* vtkProgressiveIsosurfaceRepresentation::GetStatistics()
{
  return this->GetIsosurfaceMapper()->GetStatistics();
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "IsosurfaceArray: " << this->IsosurfaceArray.Name << "\n";
  os << indent << "DrawnArray: " << this->DrawnArray.Name << "\n";
  os << indent << "CanDraw: " << this->CanDraw << "\n";
}
