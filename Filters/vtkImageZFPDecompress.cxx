// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageZFPDecompress.h"

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
#include "vtkZFPBlocks.h"
#include "vtkZFPMemory.h"

#include <algorithm>
#include <limits>

vtkStandardNewMacro(vtkImageZFPDecompress);

namespace
{
//------------------------------------------------------------------------------
// Calls body(number of the element) for all that a mask hides, of `size` elements per axis.
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
      for (int i = 0; i < 64; ++i)
      {
        const vtkIdType x = 4 * (block % blocks[0]) + i % 4;
        const vtkIdType y = 4 * (block / blocks[0] % blocks[1]) + i / 4 % 4;
        const vtkIdType z = 4 * (block / blocks[0] / blocks[1]) + i / 16;
        if ((runs[run].Bits >> i & 1) && x < size[0] && y < size[1] && z < size[2])
        {
          body(x + size[0] * (y + size[1] * z));
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
// The input's ghost array comes along with its structure: only of as many points, or cells, may it
// be added to.
void KeepGhosts(vtkDataSetAttributes* attributes, vtkIdType number)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  vtkAbstractArray* const ghosts = attributes->GetAbstractArray(name);
  if (ghosts && (ghosts->GetNumberOfTuples() != number || ghosts->GetNumberOfComponents() != 1))
  {
    attributes->RemoveArray(name);
  }
}

//------------------------------------------------------------------------------
// Hidden samples become NaN, and the ghost arrays tell of them and of hidden cells.
void Hide(vtkCompressedVolume* volume, vtkDataArray* samples, vtkImageData* output)
{
  int blocks[3];
  volume->GetBlocks(blocks);
  const int* dims = volume->GetDimensions();
  const bool cellData = volume->GetAssociation() == vtkCompressedVolume::CellData;
  if (!volume->GetHiddenSamples().IsEmpty())
  {
    vtkUnsignedCharArray* ghosts =
      cellData ? output->AllocateCellGhostArray() : output->AllocatePointGhostArray();
    unsigned char flag = vtkDataSetAttributes::HIDDENPOINT;
    if (cellData)
    {
      flag = vtkDataSetAttributes::HIDDENCELL;
    }
    const vtkIdType size[3] = { dims[0], dims[1], dims[2] };
    ForEachHidden(volume->GetHiddenSamples(), blocks, size,
      [&](vtkIdType sample)
      {
        samples->SetComponent(sample, 0, std::numeric_limits<double>::quiet_NaN());
        ghosts->SetValue(sample, ghosts->GetValue(sample) | flag);
      });
  }
  if (!volume->GetHiddenCells().IsEmpty())
  {
    vtkUnsignedCharArray* ghosts = output->AllocateCellGhostArray();
    const vtkIdType size[3] = { dims[0] - 1, dims[1] - 1, dims[2] - 1 };
    ForEachHidden(volume->GetHiddenCells(), blocks, size,
      [&](vtkIdType cell)
      { ghosts->SetValue(cell, ghosts->GetValue(cell) | vtkDataSetAttributes::HIDDENCELL); });
  }
}

//------------------------------------------------------------------------------
// What the samples are that a stream has in units of its own.
vtkSmartPointer<vtkDataArray> InSamplesUnits(vtkCompressedVolume* volume, vtkFloatArray* stored)
{
  vtkNew<vtkDoubleArray> samples;
  samples->SetName(stored->GetName());
  if (!vtkZFPMemory::Allocate(samples.Get(), stored->GetNumberOfValues()))
  {
    return nullptr;
  }
  std::transform(stored->GetPointer(0), stored->GetPointer(0) + stored->GetNumberOfValues(),
    samples->GetPointer(0), [volume](float value) { return volume->ToSample(value); });
  return samples;
}
}

//------------------------------------------------------------------------------
int vtkImageZFPDecompress::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  vtkInformation* out = outputVector->GetInformationObject(0);
  out->CopyEntry(in, vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  out->CopyEntry(in, vtkDataObject::SPACING());
  out->CopyEntry(in, vtkDataObject::ORIGIN());
  out->CopyEntry(in, vtkDataObject::DIRECTION());
  vtkDataObject::SetPointDataActiveScalarInfo(out, VTK_FLOAT, 1);
  return 1;
}

//------------------------------------------------------------------------------
// Blocks lie across any cut through the image: the whole is taken and made.
int vtkImageZFPDecompress::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  in->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
    in->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
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
    return 1; // the message is out already: the executive need not add its own
  }

  int own[6];
  input->GetExtent(own);
  volume->Crop(own);
  output->SetExtent(volume->GetExtent());
  KeepGhosts(output->GetPointData(), output->GetNumberOfPoints());
  KeepGhosts(output->GetCellData(), output->GetNumberOfCells());
  if (!volume->Covers(input))
  {
    output->GenerateGhostArray(own); // the samples around a piece
  }
  int dims[3];
  volume->GetDimensions(dims);
  vtkNew<vtkFloatArray> stored;
  stored->SetName(volume->GetArrayName().c_str());
  const vtkTypeInt64 count = static_cast<vtkTypeInt64>(dims[0]) * dims[1] * dims[2];
  const auto lacksMemory = [&](vtkTypeInt64 bytes)
  {
    vtkErrorMacro("There is " << vtkZFPMemory::Objection("the values", dims, bytes) << ".");
    this->SetErrorCode(vtkErrorCode::UserError);
    return 1;
  };
  if (!vtkZFPMemory::Allocate(stored.Get(), count))
  {
    return lacksMemory(4 * count);
  }

  const auto stream = vtkZFPBlocks::Align(volume->GetStream());
  vtkZFPBlocks blocks(dims, volume->GetBlockBits(), stream->GetPointer(0), this->NumberOfThreads);
  if (!blocks.Decode(stored->GetPointer(0), vtkZFPBlocks::ReportOf(this)))
  {
    return 1;
  }
  vtkSmartPointer<vtkDataArray> samples = stored;
  if (volume->HasUnits())
  {
    samples = InSamplesUnits(volume, stored);
    if (!samples)
    {
      return lacksMemory(8 * count);
    }
  }
  vtkDataSetAttributes* attributes = output->GetPointData();
  if (volume->GetAssociation() == vtkCompressedVolume::CellData)
  {
    attributes = output->GetCellData();
  }
  attributes->SetScalars(samples);
  Hide(volume, samples, output);
  return 1;
}

//------------------------------------------------------------------------------
void vtkImageZFPDecompress::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
