// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceRepresentation.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
#include "vtkCompressedVolume.h"
#include "vtkContourValues.h"
#include "vtkDataArray.h"
#include "vtkDiscretizableColorTransferFunction.h"
#include "vtkExtractVOI.h"
#include "vtkGhostCellsGenerator.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkLODProp3D.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkOutlineSource.h"
#include "vtkPVLODVolume.h"
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
/**
 * Draws its volume mapper in the opaque pass, or where isosurfaces are translucent in the
 * volumetric pass, as vtkIsosurfaceVolume does. ParaView's own class draws it always in the latter,
 * and only when the input has scalars, which a compressed volume has not.
 */
class vtkPVIsosurfaceLODVolume : public vtkPVLODVolume
{
public:
  static vtkPVIsosurfaceLODVolume* New();
  vtkTypeMacro(vtkPVIsosurfaceLODVolume, vtkPVLODVolume);

  int RenderOpaqueGeometry(vtkViewport* viewport) override
  {
    if (this->ShowsOutline())
    {
      return this->Superclass::RenderOpaqueGeometry(viewport);
    }
    return this->IsTranslucent() ? 0 : this->RenderIsosurfaces(viewport);
  }

  int RenderVolumetricGeometry(vtkViewport* viewport) override
  {
    return !this->ShowsOutline() && this->IsTranslucent() ? this->RenderIsosurfaces(viewport) : 0;
  }

protected:
  vtkPVIsosurfaceLODVolume() = default;
  ~vtkPVIsosurfaceLODVolume() override = default;

private:
  bool IsTranslucent()
  {
    return vtkProgressiveIsosurfaceMapper::IsTranslucent(this->GetProperty());
  }

  int RenderIsosurfaces(vtkViewport* viewport)
  {
    const int drawn = this->LODProp->RenderVolumetricGeometry(viewport);
    this->EstimatedRenderTime = this->LODProp->GetEstimatedRenderTime();
    return drawn;
  }

  /// True on processes that have no data and show its outline in place of it.
  bool ShowsOutline() { return this->SelectLOD() != this->HighLODId; }

  vtkPVIsosurfaceLODVolume(const vtkPVIsosurfaceLODVolume&) = delete;
  void operator=(const vtkPVIsosurfaceLODVolume&) = delete;
};
vtkStandardNewMacro(vtkPVIsosurfaceLODVolume);

// ---- what the processes that share an image agree on
int NumberOfProcesses()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller ? controller->GetNumberOfProcesses() : 1;
}

bool AnyProcess(bool here)
{
  const int mine = here ? 1 : 0;
  int any = mine;
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    &mine, &any, 1, vtkCommunicator::MAX_OP);
  return any != 0;
}

bool IsEmpty(const int extent[6])
{
  return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
}

bool Contains(const int outer[6], const int inner[6])
{
  return outer[0] <= inner[0] && inner[1] <= outer[1] && outer[2] <= inner[2] &&
    inner[3] <= outer[3] && outer[4] <= inner[4] && inner[5] <= outer[5];
}

// The extent around all processes' own.
void FindWholeExtent(const int own[6], int whole[6])
{
  int mine[6];
  for (int i = 0; i < 6; ++i)
  {
    const int sign = i % 2 == 0 ? -1 : 1; // one reduction to the largest
    mine[i] = IsEmpty(own) ? -VTK_INT_MAX : sign * own[i];
  }
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    mine, whole, 6, vtkCommunicator::MAX_OP);
  for (int i = 0; i < 6; i += 2)
  {
    whole[i] = -whole[i];
  }
}

// The image without its ghost cells and arrays, which a compressed volume has none of.
vtkSmartPointer<vtkImageData> WithoutGhosts(vtkImageData* image)
{
  int extent[6];
  vtkCompressedVolume::GetOwnExtent(image, extent);
  auto own = vtkSmartPointer<vtkImageData>::New();
  own->CopyStructure(image);
  own->GetPointData()->Initialize(); // ghost arrays that hide come with the structure
  own->GetCellData()->Initialize();
  own->SetExtent(extent);
  own->GetFieldData()->PassData(image->GetFieldData());
  return own;
}

constexpr int SPECULATION_ON = 64;
constexpr int SPECULATION_OFF = 1;
}

vtkStandardNewMacro(vtkProgressiveIsosurfaceRepresentation);

//------------------------------------------------------------------------------
vtkProgressiveIsosurfaceRepresentation::vtkProgressiveIsosurfaceRepresentation()
{
  auto mapper = vtkSmartPointer<vtkProgressiveIsosurfaceMapper>::New();
  mapper->LitLikeMeshesOn(); // as Contour's surface, whose place it takes
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
    // The superclass asks for ordered compositing, as translucent volumes need it; opaque surfaces
    // composite by depth.
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
  if (inputVector[0]->GetNumberOfInformationObjects() == 1 && NumberOfProcesses() > 1)
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
  // A process without input has no data of its own and shows the outline.
  this->CanDraw = !hasInput || this->FindDrawnArray(image);
  if (!image)
  {
    return this->Superclass::RequestData(request, inputVector, outputVector);
  }
  vtkSmartPointer<vtkImageData> piece = this->MakePiece(image);
  int own[6];
  vtkCompressedVolume::GetOwnExtent(piece, own);
  this->SetPiece(piece, own);
  vtkStreamingDemandDrivenPipeline::GetWholeExtent(
    inputVector[0]->GetInformationObject(0), this->WholeExtent);
  // not vtkImageVolumeRepresentation's: it would cut off the ghost cells
  return this->vtkVolumeRepresentation::RequestData(request, inputVector, outputVector);
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::SetPiece(vtkImageData* piece, const int own[6])
{
  vtkNew<vtkImageData> outline;
  outline->CopyStructure(piece);
  outline->SetExtent(const_cast<int*>(own));
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
  if (NumberOfProcesses() == 1)
  {
    auto whole = vtkSmartPointer<vtkImageData>::Take(image->NewInstance());
    whole->ShallowCopy(image);
    return whole;
  }
  int own[6];
  vtkCompressedVolume::GetOwnExtent(image, own);
  // all processes have to take the same way: they exchange samples on it
  const bool compressed = AnyProcess(vtkCompressedVolume::IsCompressed(image));
  return compressed ? this->MakeCompressedPiece(image, own) : this->MakePlainPiece(image, own);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::MakeCompressedPiece(
  vtkImageData* image, const int own[6])
{
  vtkSmartPointer<vtkImageData> piece = WithoutGhosts(image);
  vtkNew<vtkCompressedVolume> volume;
  if (this->CanDraw && piece->GetNumberOfPoints() > 0 && volume->Read(piece))
  {
    volume->Crop(own);
    volume->Write(piece);
  }
  return piece;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::MakePlainPiece(
  vtkImageData* image, const int own[6])
{
  vtkSmartPointer<vtkImageData> piece = this->SelectDrawnArray(image);
  int whole[6], covering[6];
  FindWholeExtent(own, whole);
  vtkCompressedVolume::GetCoveringExtent(own, whole, this->DrawnArray.Association, covering);
  const bool lacks = !IsEmpty(own) && !Contains(image->GetExtent(), covering);
  if (AnyProcess(lacks))
  {
    vtkNew<vtkGhostCellsGenerator> generator;
    generator->SetInputData(piece);
    generator->BuildIfRequiredOff();
    generator->SetNumberOfGhostLayers(vtkCompressedVolume::NumberOfGhostLevels);
    generator->Update();
    piece = vtkImageData::SafeDownCast(generator->GetOutput());
  }
  if (IsEmpty(own))
  {
    return piece;
  }
  vtkNew<vtkExtractVOI> cut;
  cut->SetInputData(piece);
  cut->SetVOI(covering);
  cut->Update();
  return cut->GetOutput();
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> vtkProgressiveIsosurfaceRepresentation::SelectDrawnArray(
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
  vtkSmartPointer<vtkImageData> own = WithoutGhosts(image);
  if (own->GetNumberOfPoints() == 0)
  {
    return false; // there is more than one process, and this one has no piece
  }
  if (!volume->Read(own))
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
    vtkDataArray* scalars = image->GetPointData()->GetScalars();
    this->DrawnArray.Association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
    if (!scalars)
    {
      scalars = image->GetCellData()->GetScalars();
      this->DrawnArray.Association = vtkDataObject::FIELD_ASSOCIATION_CELLS;
    }
    this->DrawnArray.Name = scalars && scalars->GetName() ? scalars->GetName() : "";
  }
  vtkDataSetAttributes* arrays = image->GetAttributes(this->DrawnArray.Association);
  if (arrays && arrays->GetArray(this->DrawnArray.Name.c_str()))
  {
    return true;
  }
  // A process may hold an empty piece of a distributed image, which has no arrays at all.
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
// Of the arrays that could give the colours; empty where none beside the drawn one does.
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
  if (NumberOfProcesses() > 1)
  {
    this->MarkModified(); // the pieces hold no other arrays than those that are seen
  }
}

//------------------------------------------------------------------------------
void vtkProgressiveIsosurfaceRepresentation::UpdateMapperParameters()
{
  // Nothing here may touch a modified time without need: ParaView calls this before every image,
  // and a mapper that believes its scene changed starts its refinement anew.
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
  // One node: the same colour at every isovalue.
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
