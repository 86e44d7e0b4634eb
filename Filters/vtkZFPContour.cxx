// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPContour.h"

#include "Contour/BrickContour.h"
#include "Contour/BrickRanges.h"
#include "Contour/Bricks.h"
#include "Contour/OtherArrays.h"
#include "Contour/PartExtractor.h"
#include "Contour/SurfaceJoiner.h"
#include "Contour/SurfaceParts.h"
#include "Format/LevelGeometry.h"
#include "Pieces/PipelineRequests.h"
#include "Status.h"

#include "vtkBlockMask.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArrayRange.h"
#include "vtkErrorCode.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkImageTransform.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

vtkStandardNewMacro(vtkZFPContour);

namespace
{
//------------------------------------------------------------------------------
Status CheckIsovalues(const std::vector<double>& isovalues)
{
  for (std::size_t i = 0; i < isovalues.size(); ++i)
  {
    if (!std::isfinite(isovalues[i]))
    {
      return Status::Error("Isovalue ", i, " is ", isovalues[i], ": it must be finite.");
    }
  }
  return {};
}

//------------------------------------------------------------------------------
// Makes an image whose points are the stream's samples: for cell data, the centres of cells.
vtkSmartPointer<vtkImageData> MakeSampleGeometry(vtkImageData* image, vtkCompressedVolume* volume)
{
  auto geometry = vtkSmartPointer<vtkImageData>::New();
  geometry->CopyStructure(image);
  geometry->SetExtent(volume->GetExtent());
  if (volume->GetAssociation() == vtkCompressedVolume::CellData)
  {
    int extent[6];
    double origin[3];
    volume->GetExtent(extent);
    image->TransformContinuousIndexToPhysicalPoint(0.5, 0.5, 0.5, origin);
    geometry->SetExtent(
      extent[0], extent[1] - 1, extent[2], extent[3] - 1, extent[4], extent[5] - 1);
    geometry->SetOrigin(origin);
  }
  return geometry;
}

//------------------------------------------------------------------------------
// Checks that there is such a level.
Status CheckLevel(vtkCompressedVolume* volume, int level)
{
  return level <= volume->GetNumberOfLevels()
    ? Status()
    : Status::Error("There is no level ", level, ": the volume has ", volume->GetNumberOfLevels(),
        " levels of detail beside itself.");
}

//------------------------------------------------------------------------------
// Finds the cells between samples that are contoured, and whether some of them are ghosts: those of
// the image, and where it is a piece of one that several processes share, the requested levels
// around it. Without information it is none. `samples` is the extent of the stream's samples. Of
// cell data, the cells behind an image's last samples belong to it where another process has the
// next samples.
Bricks::Box FindCells(vtkCompressedVolume* volume, const int own[6], vtkInformation* inputInfo,
  vtkInformation* outputInfo, const int samples[6], bool& hasGhosts)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool isPiece = inputInfo && inputInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  const int levels = isPiece ? outputInfo->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS()) : 0;
  int whole[6];
  std::copy_n(own, 6, whole);
  if (isPiece && inputInfo->Has(Pipeline::WHOLE_EXTENT()))
  {
    inputInfo->Get(Pipeline::WHOLE_EXTENT(), whole);
  }
  const int fewer = volume->GetAssociation() == vtkCompressedVolume::CellData ? 2 : 1;
  Bricks::Box cells;
  hasGhosts = false;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int low = 2 * axis, high = low + 1, start = samples[low];
    const int first = std::max({ own[low] - levels, whole[low], start });
    const int last = std::min({ own[high] - 1 + levels, whole[high] - fewer, samples[high] - 1 });
    hasGhosts = hasGhosts || first < own[low] || last > own[high] - 1;
    cells.First[axis] = first - start;
    cells.Last[axis] = last - start;
  }
  return cells;
}

//------------------------------------------------------------------------------
// Whether a triangle, in the samples' index space, lies within the image's extent.
bool IsOwnTriangle(
  vtkPolyData* surface, vtkIdList* corners, const int extent[6], const int samples[6])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    double middle = 0.0; // of the triangle; it lies in the same cell as all of it
    for (const vtkIdType corner : *corners)
    {
      middle += surface->GetPoint(corner)[axis] / 3.0;
    }
    const int end = extent[2 * axis + 1];
    if (!(middle >= extent[2 * axis] && (middle < end || end == samples[2 * axis + 1])))
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
// Marks the triangles beyond the image's extent as ghosts: a piece of a volume has samples around
// it, and the triangles between them belong to other pieces.
void MarkGhosts(vtkPolyData* surface, const int extent[6], const int samples[6])
{
  vtkCellArray* triangles = surface->GetPolys();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(triangles->GetNumberOfCells());
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < triangles->GetNumberOfCells(); ++i)
  {
    triangles->GetCellAtId(i, corners);
    const bool own = IsOwnTriangle(surface, corners, extent, samples);
    ghosts->SetValue(i, own ? 0 : vtkDataSetAttributes::DUPLICATECELL);
  }
  surface->GetCellData()->AddArray(ghosts);
}

//------------------------------------------------------------------------------
// Runs work with vtkSMPTools set to a number of threads; 0 takes all. VTK's wheels have the backend
// Sequential by default, for which STDThread stands in.
void RunWithThreads(int threads, const std::function<void()>& work)
{
  std::string backend = vtkSMPTools::GetBackend();
  if (threads != 1 && backend == "Sequential")
  {
    backend = "STDThread";
  }
  const vtkSMPTools::Config config(threads, backend, false);
  vtkSMPTools::LocalScope(config, work);
}
}

//------------------------------------------------------------------------------
vtkZFPContour::vtkZFPContour()
  : Ranges(std::make_unique<BrickRanges>())
{
}

//------------------------------------------------------------------------------
vtkZFPContour::~vtkZFPContour() = default;

//------------------------------------------------------------------------------
vtkMTimeType vtkZFPContour::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->ContourValues->GetMTime());
}

//------------------------------------------------------------------------------
void vtkZFPContour::SetBrickSize(int size)
{
  size = std::min(std::max(size, 4), 256) / 4 * 4;
  if (this->BrickSize != size)
  {
    this->BrickSize = size;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkZFPContour::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
int vtkZFPContour::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  PipelineRequests::RequestWholeExtent(inputVector[0]->GetInformationObject(0));
  return 1;
}

//------------------------------------------------------------------------------
int vtkZFPContour::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  this->NumberOfBricks = this->NumberOfDecodedBricks = 0;
  this->PeakSampleBytes = 0;
  vtkCompressedVolume::Remove(output); // the executive has passed all field data
  if (vtkCompressedVolume::IsEmptyPiece(inputVector[0]->GetInformationObject(0)))
  {
    return 1;
  }
  vtkNew<vtkCompressedVolume> volume;
  Status status = volume->Read(input)
    ? CheckIsovalues(this->GetIsovalues())
    : Status::Error("The input is ", volume->GetErrorMessage(), ".");
  if (status)
  {
    status = CheckLevel(volume, this->Level);
  }
  if (!status)
  {
    vtkErrorMacro(<< status.GetMessage());
    this->SetErrorCode(vtkErrorCode::UserError);
    return 1; // the executive need not add a message of its own
  }
  vtkInformation* const inputInfo = inputVector[0]->GetInformationObject(0);
  vtkInformation* const outputInfo = outputVector->GetInformationObject(0);
  RunWithThreads(this->NumberOfThreads,
    [&]()
    {
      if (this->Level > 0)
      {
        this->ContourLevel(input, volume, output);
      }
      else
      {
        this->ContourVolume(input, volume, inputInfo, outputInfo, output);
      }
    });
  return 1;
}

//------------------------------------------------------------------------------
std::vector<double> vtkZFPContour::GetIsovalues()
{
  const double* values = this->GetValues();
  return { values, values + this->GetNumberOfContours() };
}

//------------------------------------------------------------------------------
// A level is a volume of its own, on an image of its own.
void vtkZFPContour::ContourLevel(
  vtkImageData* input, vtkCompressedVolume* volume, vtkPolyData* output)
{
  vtkCompressedVolume* const level = volume->GetLevel(this->Level);
  vtkNew<vtkImageData> image;
  image->CopyStructure(input);
  image->GetPointData()->Initialize(); // what hides samples of the volume came with its structure
  image->GetCellData()->Initialize();
  LevelGeometry::Set(volume, level, image);
  level->SetExtent(image->GetExtent());
  this->ContourVolume(image, level, nullptr, nullptr, output);
}

//------------------------------------------------------------------------------
void vtkZFPContour::ContourVolume(vtkImageData* input, vtkCompressedVolume* volume,
  vtkInformation* inputInfo, vtkInformation* outputInfo, vtkPolyData* output)
{
  const auto geometry = MakeSampleGeometry(input, volume);
  const int* const extent = geometry->GetExtent();
  const int extentStart[3] = { extent[0], extent[2], extent[4] };
  const vtkBlockMask hidden = volume->GetCellsWithoutSurface();
  const Bricks bricks(volume->GetDimensions(), this->BrickSize);
  BrickContour contour(bricks, extentStart);
  contour.Scale = volume->GetScale();
  contour.ComputeNormals = this->ComputeNormals;
  contour.ComputeGradients = this->ComputeGradients;
  contour.Hidden = hidden.IsEmpty() ? nullptr : &hidden;
  int own[6];
  vtkCompressedVolume::GetOwnExtent(input, own);
  bool hasGhosts = false;
  contour.Cells = FindCells(volume, own, inputInfo, outputInfo, extent, hasGhosts);
  const std::vector<double> isovalues = this->GetIsovalues();
  std::vector<double> stored(isovalues.size()); // in the stream's units
  std::transform(isovalues.begin(), isovalues.end(), stored.begin(),
    [&](double isovalue) { return volume->ToStored(isovalue); });

  this->NumberOfBricks = bricks.GetNumberOfBricks();
  this->Ranges->Prepare(volume, this->BrickSize, this->NumberOfBricks);
  PartExtractor extractor(volume, bricks, contour, stored, *this->Ranges);
  SurfaceParts parts;
  const bool complete = extractor.Extract(this, parts);
  this->NumberOfDecodedBricks = extractor.GetNumberOfDecodedBricks();
  this->PeakSampleBytes = extractor.GetPeakSampleBytes();
  if (!complete)
  {
    return;
  }
  const std::string name = volume->GetArrayName();
  SurfaceJoiner(contour, parts)
    .Join(output, this->ComputeScalars ? name.c_str() : nullptr, isovalues);
  if (hasGhosts)
  {
    MarkGhosts(output, own, extent);
  }
  int samples[6];
  std::copy_n(input->GetExtent(), 6, samples);
  const bool ofCells = volume->GetAssociation() == vtkCompressedVolume::CellData;
  for (int axis = 0; axis < 3; ++axis)
  {
    samples[2 * axis + 1] -= ofCells ? 1 : 0;
  }
  OtherArrays::Interpolate(
    input->GetAttributes(ofCells ? vtkDataObject::CELL : vtkDataObject::POINT), samples, output);
  vtkImageTransform::TransformPointSet(geometry, output);
  TurnOutward(geometry, output);
  this->UpdateProgress(1.0);
}

//------------------------------------------------------------------------------
void vtkZFPContour::TurnOutward(vtkImageData* image, vtkPolyData* surface)
{
  // vtkImageTransform multiplies normals by cofactors, which have the determinant's sign
  const double mirrors = image->GetDirectionMatrix()->Determinant();
  vtkDataArray* const normals = surface->GetPointData()->GetNormals();
  if (mirrors < 0.0 && normals)
  {
    auto values = vtk::DataArrayValueRange<3>(normals);
    std::transform(values.begin(), values.end(), values.begin(), [](auto v) { return -v; });
    normals->Modified();
  }
  const double* const spacing = image->GetSpacing();
  if (mirrors * spacing[0] * spacing[1] * spacing[2] < 0.0)
  {
    vtkCellArray* const triangles = surface->GetPolys();
    for (vtkIdType i = 0; i < triangles->GetNumberOfCells(); ++i)
    {
      triangles->ReverseCellAtId(i);
    }
    triangles->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkZFPContour::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ContourValues:\n";
  this->ContourValues->PrintSelf(os, indent.GetNextIndent());
  os << indent << "ComputeNormals: " << (this->ComputeNormals ? "on\n" : "off\n");
  os << indent << "ComputeGradients: " << (this->ComputeGradients ? "on\n" : "off\n");
  os << indent << "ComputeScalars: " << (this->ComputeScalars ? "on\n" : "off\n");
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "BrickSize: " << this->BrickSize << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfBricks: " << this->NumberOfBricks << "\n";
  os << indent << "NumberOfDecodedBricks: " << this->NumberOfDecodedBricks << "\n";
  os << indent << "PeakSampleBytes: " << this->PeakSampleBytes << "\n";
}
