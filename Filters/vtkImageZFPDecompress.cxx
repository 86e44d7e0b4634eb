// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageZFPDecompress.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BlockGeometry.h"
#include "Codec/BlockStream.h"
#include "Codec/LevelShape.h"
#include "Format/LevelGeometry.h"
#include "Pieces/PipelineRequests.h"
#include "Status.h"

#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <limits>
#include <vector>

vtkStandardNewMacro(vtkImageZFPDecompress);

namespace
{
//------------------------------------------------------------------------------
// Calls body(index of the element) for all that a mask hides, of `size` elements per axis.
template <typename Body>
void ForEachHidden(
  const vtkBlockMask& mask, const int blocks[3], const vtkIdType size[3], Body body)
{
  const std::vector<vtkBlockMask::Run>& runs = mask.GetRuns();
  const vtkTypeUInt64 end = static_cast<vtkTypeUInt64>(blocks[0]) * blocks[1] * blocks[2];
  for (std::size_t run = 0; run < runs.size(); ++run)
  {
    const vtkTypeUInt64 next = run + 1 < runs.size() ? runs[run + 1].First : end;
    for (vtkTypeUInt64 block = runs[run].First; runs[run].Bits && block < next; ++block)
    {
      for (int i = 0; i < BlockSamples; ++i)
      {
        const vtkIdType x = BlockSide * (block % blocks[0]) + i % BlockSide;
        const vtkIdType y = BlockSide * (block / blocks[0] % blocks[1]) + i / BlockSide % BlockSide;
        const vtkIdType z = BlockSide * (block / blocks[0] / blocks[1]) + i / BlockSlice;
        if ((runs[run].Bits >> i & 1) && x < size[0] && y < size[1] && z < size[2])
        {
          body(x + size[0] * (y + size[1] * z));
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
// Removes a ghost array that came along with the input's structure if it does not fit the output's
// number of points, or cells.
void RemoveUnfitGhosts(vtkDataSetAttributes* attributes, vtkIdType number)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  vtkAbstractArray* const ghosts = attributes->GetAbstractArray(name);
  if (ghosts && (ghosts->GetNumberOfTuples() != number || ghosts->GetNumberOfComponents() != 1))
  {
    attributes->RemoveArray(name);
  }
}

//------------------------------------------------------------------------------
// Gives the output the extent of the stream; the samples around a process' piece are ghosts.
void SetOutputExtent(vtkCompressedVolume* volume, int piece[6], bool isPiece, vtkImageData* output)
{
  output->SetExtent(volume->GetExtent());
  RemoveUnfitGhosts(output->GetPointData(), output->GetNumberOfPoints());
  RemoveUnfitGhosts(output->GetCellData(), output->GetNumberOfCells());
  if (isPiece && !std::equal(piece, piece + 6, volume->GetExtent()))
  {
    output->GenerateGhostArray(piece);
  }
}

//------------------------------------------------------------------------------
// Whether several processes share the image, of which the input is a piece.
bool IsPiece(vtkInformation* input)
{
  return input->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
}

//------------------------------------------------------------------------------
// Makes hidden samples NaN, and flags them in the output's ghost array.
void HideSamples(vtkCompressedVolume* volume, vtkDataArray* samples, vtkImageData* output)
{
  const bool cellData = volume->GetAssociation() == vtkCompressedVolume::CellData;
  vtkUnsignedCharArray* ghosts =
    cellData ? output->AllocateCellGhostArray() : output->AllocatePointGhostArray();
  const unsigned char flag = cellData ? static_cast<int>(vtkDataSetAttributes::HIDDENCELL)
                                      : static_cast<int>(vtkDataSetAttributes::HIDDENPOINT);
  int blocks[3];
  volume->GetBlocks(blocks);
  const int* dims = volume->GetDimensions();
  const vtkIdType size[3] = { dims[0], dims[1], dims[2] };
  ForEachHidden(volume->GetHiddenSamples(), blocks, size,
    [&](vtkIdType sample)
    {
      samples->SetComponent(sample, 0, std::numeric_limits<double>::quiet_NaN());
      ghosts->SetValue(sample, ghosts->GetValue(sample) | flag);
    });
}

//------------------------------------------------------------------------------
void HideCells(vtkCompressedVolume* volume, vtkImageData* output)
{
  vtkUnsignedCharArray* ghosts = output->AllocateCellGhostArray();
  int blocks[3];
  volume->GetBlocks(blocks);
  const int* dims = volume->GetDimensions();
  const vtkIdType size[3] = { dims[0] - 1, dims[1] - 1, dims[2] - 1 };
  ForEachHidden(volume->GetHiddenCells(), blocks, size,
    [&](vtkIdType cell)
    { ghosts->SetValue(cell, ghosts->GetValue(cell) | vtkDataSetAttributes::HIDDENCELL); });
}

//------------------------------------------------------------------------------
void SetOutputSamples(vtkCompressedVolume* volume, vtkDataArray* samples, vtkImageData* output)
{
  vtkDataSetAttributes* attributes = output->GetPointData();
  if (volume->GetAssociation() == vtkCompressedVolume::CellData)
  {
    attributes = output->GetCellData();
  }
  attributes->SetScalars(samples);
  if (!volume->GetHiddenSamples().IsEmpty())
  {
    HideSamples(volume, samples, output);
  }
  if (!volume->GetHiddenCells().IsEmpty() && attributes == output->GetPointData())
  {
    HideCells(volume, output);
  }
}

//------------------------------------------------------------------------------
vtkIdType CountSamples(const int dims[3])
{
  return static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2];
}

//------------------------------------------------------------------------------
// Decodes a stream's values, in its own units.
Status DecodeStored(
  vtkCompressedVolume* volume, int threads, const ProgressCallback& progress, vtkFloatArray* stored)
{
  const int* dims = volume->GetDimensions();
  if (Status status = AllocateArray(stored, CountSamples(dims), "the values", dims); !status)
  {
    return status;
  }
  const auto stream = BlockStream::Align(volume->GetStream());
  const BlockStream blocks(dims, volume->GetBlockBits(), stream->GetPointer(0), threads);
  return blocks.Decode(stored->GetPointer(0), progress) ? Status() : Status::Aborted();
}

//------------------------------------------------------------------------------
// Computes samples from values in units of the stream.
Status ConvertStored(vtkCompressedVolume* volume, vtkFloatArray* stored, vtkDoubleArray* samples)
{
  const int* dims = volume->GetDimensions();
  if (Status status = AllocateArray(samples, CountSamples(dims), "the values", dims); !status)
  {
    return status;
  }
  std::transform(stored->GetPointer(0), stored->GetPointer(0) + stored->GetNumberOfValues(),
    samples->GetPointer(0), [volume](float value) { return volume->ToSample(value); });
  return {};
}

//------------------------------------------------------------------------------
Status DecodeSamples(vtkCompressedVolume* volume, int threads, const ProgressCallback& progress,
  vtkSmartPointer<vtkDataArray>& samples)
{
  const auto stored = vtkSmartPointer<vtkFloatArray>::New();
  samples = stored;
  Status status = DecodeStored(volume, threads, progress, stored);
  if (status && volume->HasUnits())
  {
    const auto converted = vtkSmartPointer<vtkDoubleArray>::New();
    samples = converted;
    status = ConvertStored(volume, stored, converted);
  }
  samples->SetName(volume->GetArrayName().c_str());
  return status;
}

//------------------------------------------------------------------------------
Status DecodeLevel(vtkCompressedVolume* volume, int number, int threads,
  const ProgressCallback& progress, vtkImageData* output)
{
  vtkCompressedVolume* const level = volume->GetLevel(number);
  if (!level)
  {
    return Status::Error("no level ", number, ": the volume has ", volume->GetNumberOfLevels(),
      " levels of detail beside itself");
  }
  output->GetPointData()->Initialize(); // what hides samples of the volume came with its structure
  output->GetCellData()->Initialize();
  LevelGeometry::Set(volume, level, output);
  vtkSmartPointer<vtkDataArray> samples;
  const Status status = DecodeSamples(level, threads, progress, samples);
  if (status)
  {
    SetOutputSamples(level, samples, output);
  }
  return status;
}

//------------------------------------------------------------------------------
// Tells the geometry of a level of point data that has been made by the image's present spacing.
void PredictLevelGeometry(int number, vtkInformation* information)
{
  int extent[6], dims[3];
  vtkNew<vtkImageData> image;
  information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  image->SetExtent(extent);
  image->GetDimensions(dims);
  image->SetSpacing(information->Get(vtkDataObject::SPACING()));
  image->SetOrigin(information->Get(vtkDataObject::ORIGIN()));
  if (information->Has(vtkDataObject::DIRECTION()))
  {
    image->SetDirectionMatrix(information->Get(vtkDataObject::DIRECTION()));
  }
  const std::vector<LevelShape> shapes = PlanLevels(dims, image->GetSpacing(), number);
  if (static_cast<int>(shapes.size()) == number)
  {
    const LevelShape& shape = shapes.back();
    const int first[3] = { extent[0], extent[2], extent[4] };
    LevelGeometry::Set(first, shape.Dimensions, shape.Steps, false, image);
    information->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), image->GetExtent(), 6);
    information->Set(vtkDataObject::SPACING(), image->GetSpacing(), 3);
    information->Set(vtkDataObject::ORIGIN(), image->GetOrigin(), 3);
  }
}
}

//------------------------------------------------------------------------------
int vtkImageZFPDecompress::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* out = outputVector->GetInformationObject(0);
  PipelineRequests::CopyGeometry(inputVector[0]->GetInformationObject(0), out);
  if (this->Level > 0)
  {
    PredictLevelGeometry(this->Level, out);
  }
  vtkDataObject::SetPointDataActiveScalarInfo(out, VTK_FLOAT, 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageZFPDecompress::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  PipelineRequests::RequestWholeExtent(inputVector[0]->GetInformationObject(0));
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageZFPDecompress::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkImageData* output = vtkImageData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  output->Initialize();
  output->CopyStructure(input);
  output->GetFieldData()->PassData(input->GetFieldData());
  vtkCompressedVolume::Remove(output);
  if (vtkCompressedVolume::IsEmptyPiece(inputVector[0]->GetInformationObject(0)))
  {
    return 1;
  }
  vtkNew<vtkCompressedVolume> volume;
  if (!volume->Read(input))
  {
    vtkErrorMacro("The input is " << volume->GetErrorMessage() << ".");
    this->SetErrorCode(vtkErrorCode::UserError);
    return 1; // the executive need not add a message of its own
  }

  if (this->Level > 0)
  {
    this->Report(DecodeLevel(volume, this->Level, this->NumberOfThreads, ProgressOf(this), output));
    return 1;
  }
  int piece[6];
  input->GetExtent(piece);
  volume->Crop(piece);
  const bool isPiece = IsPiece(inputVector[0]->GetInformationObject(0));
  SetOutputExtent(volume, piece, isPiece, output);
  vtkSmartPointer<vtkDataArray> samples;
  const Status status = DecodeSamples(volume, this->NumberOfThreads, ProgressOf(this), samples);
  if (status)
  {
    SetOutputSamples(volume, samples, output);
    if (!isPiece)
    {
      output->Crop(piece); // a subset has no samples around it
    }
  }
  this->Report(status);
  return 1;
}

//------------------------------------------------------------------------------
void vtkImageZFPDecompress::Report(const Status& status)
{
  if (!status && !status.IsAborted())
  {
    vtkErrorMacro("There is " << status.GetMessage() << ".");
    this->SetErrorCode(vtkErrorCode::UserError);
  }
}

//------------------------------------------------------------------------------
void vtkImageZFPDecompress::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
