// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageZFPCompress.h"

#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkZFPBlocks.h"

#include <algorithm>
#include <cstring>
#include <sstream>

vtkStandardNewMacro(vtkImageZFPCompress);

namespace
{
//------------------------------------------------------------------------------
// The active scalars, else the first array that is not VTK's ghost marker.
vtkDataArray* DefaultArray(vtkDataSetAttributes* attributes)
{
  if (attributes->GetScalars())
  {
    return attributes->GetScalars();
  }
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    const char* name = array ? array->GetName() : nullptr;
    if (array && !(name && !strcmp(name, vtkDataSetAttributes::GhostArrayName())))
    {
      return array;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
// "a, b" for an error message.
std::string ArrayNames(vtkImageData* image)
{
  std::string names;
  for (vtkDataSetAttributes* attributes :
    { static_cast<vtkDataSetAttributes*>(image->GetPointData()),
      static_cast<vtkDataSetAttributes*>(image->GetCellData()) })
  {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      const char* name = attributes->GetArrayName(i);
      names += (names.empty() ? "" : ", ") + std::string(name ? name : "(unnamed)");
    }
  }
  return names.empty() ? "none" : names;
}
}

//------------------------------------------------------------------------------
double vtkImageZFPCompress::GetActualRate() const
{
  return vtkCompressedVolume::BlockBitsForRate(this->Rate) / 64.0;
}

//------------------------------------------------------------------------------
int vtkImageZFPCompress::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  vtkInformation* out = outputVector->GetInformationObject(0);
  out->CopyEntry(in, vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  out->CopyEntry(in, vtkDataObject::SPACING());
  out->CopyEntry(in, vtkDataObject::ORIGIN());
  out->CopyEntry(in, vtkDataObject::DIRECTION());
  // the output has no scalars
  out->Remove(vtkDataObject::POINT_DATA_VECTOR());
  out->Remove(vtkDataObject::CELL_DATA_VECTOR());
  return 1;
}

//------------------------------------------------------------------------------
// A stream is made of the whole image, whatever part of it is asked for.
int vtkImageZFPCompress::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  in->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
    in->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageZFPCompress::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkImageData* output = vtkImageData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  output->Initialize();
  output->CopyStructure(input);
  output->GetFieldData()->PassData(input->GetFieldData());
  vtkCompressedVolume::Remove(output);

  int association = vtkCompressedVolume::PointData;
  vtkDataArray* array = this->FindArray(inputVector, input, association);
  if (!array || !this->Compress(input, array, association, output))
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  return 1; // the message is out already: the executive need not add its own
}

//------------------------------------------------------------------------------
vtkDataArray* vtkImageZFPCompress::FindArray(
  vtkInformationVector** inputVector, vtkImageData* input, int& association)
{
  vtkInformation* choice = this->GetInputArrayInformation(0);
  const char* chosen =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  chosen = chosen && *chosen ? chosen
                             : nullptr; // ParaView's property for "not chosen yet" is an empty name
  vtkDataArray* array = this->GetInputArrayToProcess(0, inputVector);
  if (!array && !chosen)
  {
    array = DefaultArray(input->GetPointData());
    array = array ? array : DefaultArray(input->GetCellData());
  }
  if (!array)
  {
    std::ostringstream message;
    if (vtkCompressedVolume::IsCompressed(input))
    {
      message << "The input is a compressed volume already: decompress it first.";
    }
    else
    {
      message << "There is no "
              << (chosen ? "point or cell array '" + std::string(chosen) + "'" : "array")
              << " to compress; the input's arrays: " << ArrayNames(input) << ".";
    }
    vtkErrorMacro(<< message.str());
    return nullptr;
  }
  // by identity: the same name may occur in both
  const bool isCellArray = [&]
  {
    for (int i = 0; i < input->GetCellData()->GetNumberOfArrays(); ++i)
    {
      if (input->GetCellData()->GetAbstractArray(i) == array)
      {
        return true;
      }
    }
    return false;
  }();
  association = isCellArray ? vtkCompressedVolume::CellData : vtkCompressedVolume::PointData;
  return array;
}

//------------------------------------------------------------------------------
bool vtkImageZFPCompress::Compress(
  vtkImageData* input, vtkDataArray* array, int association, vtkImageData* output)
{
  const char* name = array->GetName() && *array->GetName() ? array->GetName() : "scalars";
  const int blockBits = vtkCompressedVolume::BlockBitsForRate(this->Rate);
  if (blockBits == 0)
  {
    vtkErrorMacro("Rate is " << this->Rate << " bits per sample: it must be in (0, 32].");
    return false;
  }
  if (this->Component < 0 || this->Component >= array->GetNumberOfComponents())
  {
    vtkErrorMacro("Component is " << this->Component << ", but array '" << name << "' has "
                                  << array->GetNumberOfComponents() << " component(s).");
    return false;
  }
  int dims[3];
  input->GetDimensions(dims);
  vtkIdType samples = 1;
  for (int& n : dims)
  {
    n -= association == vtkCompressedVolume::CellData ? 1 : 0;
    samples *= n;
  }
  if (*std::min_element(dims, dims + 3) < 2)
  {
    vtkErrorMacro("Only volumes can be compressed: array '"
      << name << "' has " << dims[0] << " x " << dims[1] << " x " << dims[2]
      << " samples, at least 2 along each axis are needed.");
    return false;
  }
  if (array->GetNumberOfTuples() != samples)
  {
    vtkErrorMacro("Array '" << name << "' has " << array->GetNumberOfTuples()
                            << " tuples, the image needs " << samples << ".");
    return false;
  }

  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetNumberOfValues(vtkCompressedVolume::StreamBytesFor(dims, blockBits));
  vtkZFPBlocks blocks(dims, blockBits, stream->GetPointer(0), this->NumberOfThreads);
  vtkZFPBlocks::Summary summary;
  const vtkTypeInt64 layers = blocks.GetNumberOfLayers();
  const vtkTypeInt64 step = blocks.GetLayersPerStep();
  for (vtkTypeInt64 layer = 0; layer < layers; layer += step)
  {
    const vtkTypeInt64 end = std::min(layer + step, layers);
    blocks.Encode(array, this->Component, layer, end, summary);
    this->UpdateProgress(static_cast<double>(end) / layers);
    if (this->GetAbortExecute())
    {
      return false;
    }
  }
  if (!summary.IsFinite())
  {
    vtkErrorMacro("Array '" << name << "' has " << summary.NaNs << " NaN and " << summary.Infinities
                            << " infinite values (as float32), which ZFP cannot compress: replace "
                               "them first.");
    return false;
  }
  // zeros in place of tiny values are below float32's precision of the largest value, or else an
  // error
  const float visible = vtkZFPBlocks::TinyMagnitude() * 16777216.0f; // 2^24
  if (summary.TinyBlocks > 0 && summary.Magnitude() < visible)
  {
    vtkErrorMacro("Array '" << name << "' has values too small for ZFP: the largest is "
                            << summary.Magnitude() << ", and in " << summary.TinyBlocks
                            << " blocks of 4x4x4 all are below 3e-30. Scale the values up first.");
    return false;
  }

  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(blockBits);
  volume->SetDimensions(dims);
  volume->SetRange(summary.Minimum, summary.Maximum);
  volume->SetScalarType(array->GetDataType());
  volume->SetArrayName(name);
  volume->SetComponent(this->Component);
  volume->SetAssociation(association);
  volume->SetStream(stream);
  volume->Write(output);
  return true;
}

//------------------------------------------------------------------------------
void vtkImageZFPCompress::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << " (actually " << this->GetActualRate() << ")\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
