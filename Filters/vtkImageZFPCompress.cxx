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
#include <string>

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

//------------------------------------------------------------------------------
std::string NameOf(vtkDataArray* array)
{
  return array->GetName() && *array->GetName() ? array->GetName() : "scalars";
}

//------------------------------------------------------------------------------
// By identity: point and cell arrays may have the same name.
bool Contains(vtkDataSetAttributes* attributes, vtkDataArray* array)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    if (attributes->GetAbstractArray(i) == array)
    {
      return true;
    }
  }
  return false;
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
  const char* name =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool chosen = name && *name; // ParaView sends an empty name for "none chosen yet"
  vtkDataArray* array = this->GetInputArrayToProcess(0, inputVector);
  if (!array && !chosen)
  {
    array = DefaultArray(input->GetPointData());
    array = array ? array : DefaultArray(input->GetCellData());
  }
  if (!array && !chosen && vtkCompressedVolume::IsCompressed(input))
  {
    vtkErrorMacro("The input is a compressed volume already: decompress it first.");
  }
  else if (!array)
  {
    vtkErrorMacro(
      "There is no " << (chosen ? "point or cell array '" + std::string(name) + "'" : "array")
                     << " to compress; the input's arrays: " << ArrayNames(input) << ".");
  }
  association = array && Contains(input->GetCellData(), array) ? vtkCompressedVolume::CellData
                                                               : vtkCompressedVolume::PointData;
  return array;
}

//------------------------------------------------------------------------------
// What is wrong with the settings or the array's shape; else the samples per axis.
std::string vtkImageZFPCompress::Check(
  vtkImageData* input, vtkDataArray* array, int association, int dims[3])
{
  std::ostringstream error;
  input->GetDimensions(dims);
  vtkIdType samples = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    dims[axis] -= association == vtkCompressedVolume::CellData ? 1 : 0;
    samples *= dims[axis];
  }
  if (vtkCompressedVolume::BlockBitsForRate(this->Rate) == 0)
  {
    error << "Rate is " << this->Rate << " bits per sample: it must be in (0, 32].";
  }
  else if (this->Component < 0 || this->Component >= array->GetNumberOfComponents())
  {
    error << "Component is " << this->Component << ", but array '" << NameOf(array) << "' has "
          << array->GetNumberOfComponents() << " component(s).";
  }
  else if (*std::min_element(dims, dims + 3) < 2)
  {
    error << "Only volumes can be compressed: array '" << NameOf(array) << "' has " << dims[0]
          << " x " << dims[1] << " x " << dims[2]
          << " samples, at least 2 along each axis are needed.";
  }
  else if (array->GetNumberOfTuples() != samples)
  {
    error << "Array '" << NameOf(array) << "' has " << array->GetNumberOfTuples()
          << " tuples, the image needs " << samples << ".";
  }
  return error.str();
}

//------------------------------------------------------------------------------
bool vtkImageZFPCompress::Compress(
  vtkImageData* input, vtkDataArray* array, int association, vtkImageData* output)
{
  int dims[3];
  std::string error = this->Check(input, array, association, dims);
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
    return false;
  }
  const int blockBits = vtkCompressedVolume::BlockBitsForRate(this->Rate);
  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetNumberOfValues(vtkCompressedVolume::StreamBytesFor(dims, blockBits));
  vtkZFPBlocks blocks(dims, blockBits, stream->GetPointer(0), this->NumberOfThreads);
  vtkZFPBlocks::Summary summary;
  if (!blocks.Encode(array, this->Component, 0, blocks.GetNumberOfLayers(), summary,
        vtkZFPBlocks::ReportOf(this)))
  {
    return false;
  }
  error = summary.GetObjection();
  if (!error.empty())
  {
    vtkErrorMacro("Array '" << NameOf(array) << "' has " << error);
    return false;
  }

  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(blockBits);
  volume->SetDimensions(dims);
  volume->SetRange(summary.Minimum, summary.Maximum);
  volume->SetScalarType(array->GetDataType());
  volume->SetArrayName(NameOf(array));
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
