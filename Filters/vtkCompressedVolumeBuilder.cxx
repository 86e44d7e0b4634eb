// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedVolumeBuilder.h"

#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkZFPBlocks.h"
#include "vtkZFPMemory.h"

#include <algorithm>
#include <cmath>
#include <sstream>

vtkStandardNewMacro(vtkCompressedVolumeBuilder);

//------------------------------------------------------------------------------
struct vtkCompressedVolumeBuilder::Work
{
  Work(const int dims[3], int blockBits)
    : BlockBits(blockBits)
  {
    std::copy_n(dims, 3, this->Dimensions);
  }

  vtkTypeInt64 SamplesPerSlice() const
  {
    return static_cast<vtkTypeInt64>(this->Dimensions[0]) * this->Dimensions[1];
  }

  int Dimensions[3];
  int BlockBits;
  vtkNew<vtkUnsignedCharArray> Stream;
  vtkZFPBlocks::Hidden Hidden;
  vtkZFPBlocks::Summary Summary;
  int Slices = 0; // done
  int ScalarType = VTK_VOID;
  int Component = 0;
  std::string ArrayName;
};

//------------------------------------------------------------------------------
vtkCompressedVolumeBuilder::vtkCompressedVolumeBuilder() = default;
vtkCompressedVolumeBuilder::~vtkCompressedVolumeBuilder() = default;

//------------------------------------------------------------------------------
void vtkCompressedVolumeBuilder::SetArrayName(const std::string& name)
{
  if (this->ArrayName != name)
  {
    this->ArrayName = name;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkCompressedVolumeBuilder::GetNumberOfSlices() const
{
  return this->Volume ? this->Volume->Slices : 0;
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::Refuse(const std::string& reason)
{
  this->Volume.reset();
  this->ErrorMessage = reason;
  return false;
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::Start(const int dims[3], double rate)
{
  this->Volume.reset();
  const int blockBits = vtkCompressedVolume::BlockBitsForRate(rate);
  std::ostringstream error;
  if (blockBits == 0)
  {
    error << "The rate is " << rate << " bits per sample: it must be in (0, 32].";
    return this->Refuse(error.str());
  }
  if (*std::min_element(dims, dims + 3) < 2)
  {
    error << "Only volumes can be compressed: there are " << dims[0] << " x " << dims[1] << " x "
          << dims[2] << " samples, at least 2 along each axis are needed.";
    return this->Refuse(error.str());
  }
  if (!std::isfinite(this->Offset) || !std::isfinite(this->Scale) || !(this->Scale > 0.0))
  {
    error << "The stream's units are an offset of " << this->Offset << " and a scale of "
          << this->Scale << ": both must be finite, and the latter above 0.";
    return this->Refuse(error.str());
  }
  this->Volume = std::make_unique<Work>(dims, blockBits);
  const vtkTypeInt64 bytes = vtkCompressedVolume::StreamBytesFor(dims, blockBits);
  if (!vtkZFPMemory::Allocate(this->Volume->Stream.Get(), bytes))
  {
    return this->Refuse("There is " + vtkZFPMemory::Objection("the stream", dims, bytes) + ".");
  }
  this->ErrorMessage.clear();
  return true;
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolumeBuilder::CheckSlab(vtkDataArray* samples, int component) const
{
  const Work& volume = *this->Volume;
  const vtkTypeInt64 tuples = samples ? samples->GetNumberOfTuples() : 0;
  const vtkTypeInt64 slices = tuples / volume.SamplesPerSlice();
  const vtkTypeInt64 left = volume.Dimensions[2] - volume.Slices;
  std::ostringstream error;
  if (tuples == 0 || tuples % volume.SamplesPerSlice() != 0)
  {
    error << "The slab has " << tuples << " samples, which is not a multiple of the "
          << volume.Dimensions[0] << " x " << volume.Dimensions[1] << " of a slice.";
  }
  else if (slices > left)
  {
    error << "The slab has " << slices << " slices where " << left << " are left of "
          << volume.Dimensions[2] << ".";
  }
  else if (slices % 4 != 0 && slices < left)
  {
    error << "The slab has " << slices << " slices: only the last may have another number than a "
          << "multiple of 4.";
  }
  else if (component < 0 || component >= samples->GetNumberOfComponents())
  {
    error << "Component is " << component << ", but the slab has "
          << samples->GetNumberOfComponents() << " component(s).";
  }
  else if (volume.Slices > 0 && samples->GetDataType() != volume.ScalarType)
  {
    error << "The slab is of type " << samples->GetDataTypeAsString() << ", but those before of "
          << vtkImageScalarTypeNameMacro(volume.ScalarType) << ".";
  }
  return error.str();
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::AddSlab(vtkDataArray* samples, int component)
{
  if (!this->Volume)
  {
    return this->Refuse(
      this->ErrorMessage.empty() ? "Nothing has been started." : this->ErrorMessage);
  }
  std::string error = this->CheckSlab(samples, component);
  if (!error.empty())
  {
    return this->Refuse(error);
  }
  Work& volume = *this->Volume;
  const int slices = static_cast<int>(samples->GetNumberOfTuples() / volume.SamplesPerSlice());
  if (volume.Slices == 0)
  {
    volume.ScalarType = samples->GetDataType();
    volume.Component = component;
    volume.ArrayName = samples->GetName() ? samples->GetName() : "";
  }
  vtkZFPBlocks blocks(
    volume.Dimensions, volume.BlockBits, volume.Stream->GetPointer(0), this->NumberOfThreads);
  const int first = volume.Slices / 4;
  volume.Hidden.NotFinite = this->MaskNonFinite;
  const vtkZFPBlocks::Units units{ this->Offset, this->Scale };
  blocks.Encode(samples, component, first, (volume.Slices + slices + 3) / 4, units, volume.Hidden,
    volume.Summary, [](double) { return true; });
  if (!volume.Summary.IsFinite())
  {
    std::ostringstream message;
    message << "Slices " << volume.Slices << " to " << volume.Slices + slices - 1 << " have "
            << volume.Summary.GetObjection();
    return this->Refuse(message.str());
  }
  volume.Slices += slices;
  this->ErrorMessage.clear();
  return true;
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::Finish(vtkImageData* image)
{
  const int given = this->GetNumberOfSlices();
  if (!this->Volume || given < this->Volume->Dimensions[2])
  {
    std::ostringstream error;
    this->Volume
      ? error << "Only " << given << " slices of " << this->Volume->Dimensions[2]
              << " have been added."
      : error << (this->ErrorMessage.empty() ? "Nothing has been started." : this->ErrorMessage);
    return this->Refuse(error.str());
  }
  const std::string objection = this->Volume->Summary.GetObjection();
  if (!objection.empty())
  {
    return this->Refuse("The volume has " + objection);
  }
  const std::unique_ptr<Work> work = std::move(this->Volume);
  std::string name = this->ArrayName.empty() ? work->ArrayName : this->ArrayName;
  image->SetDimensions(work->Dimensions);
  image->GetPointData()->Initialize();
  image->GetCellData()->Initialize();
  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(work->BlockBits);
  volume->SetDimensions(work->Dimensions);
  volume->SetOffset(this->Offset);
  volume->SetScale(this->Scale);
  volume->SetStoredRange(work->Summary.GetRange()[0], work->Summary.GetRange()[1]);
  volume->SetHiddenSamples(work->Hidden.Mask);
  volume->SetScalarType(work->ScalarType);
  volume->SetArrayName(name.empty() ? "scalars" : name);
  volume->SetComponent(work->Component);
  volume->SetStream(work->Stream);
  volume->Write(image);
  this->ErrorMessage.clear();
  return true;
}

//------------------------------------------------------------------------------
void vtkCompressedVolumeBuilder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "Offset: " << this->Offset << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfSlices: " << this->GetNumberOfSlices() << "\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}
