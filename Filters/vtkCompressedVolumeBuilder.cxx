// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedVolumeBuilder.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BlockGeometry.h"
#include "Codec/BlockStream.h"
#include "Codec/Magnitude.h"
#include "Codec/Pyramid.h"
#include "Codec/SampleEncoder.h"
#include "Format/StreamArray.h"
#include "Status.h"

#include "vtkBlockRanges.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkCompressedVolumeBuilder);

//------------------------------------------------------------------------------
// The volume that is being built.
struct vtkCompressedVolumeBuilder::Work
{
  Work(const int dims[3], int blockBits)
    : BlockBits(blockBits)
  {
    std::copy_n(dims, 3, this->Dimensions);
  }

  BlockStream GetBlocks(int threads)
  {
    return { this->Dimensions, this->BlockBits, this->Stream->GetPointer(0), threads };
  }

  vtkTypeInt64 SamplesPerSlice() const
  {
    return static_cast<vtkTypeInt64>(this->Dimensions[0]) * this->Dimensions[1];
  }

  Status CheckSlab(vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden) const;
  Status AddSlab(const ChosenSamples& samples, int threads);

  int Dimensions[3];
  int BlockBits;
  vtkNew<StreamArray> Stream;
  SampleEncoder Encoder;
  std::unique_ptr<Pyramid> Levels; // null without levels
  int Slices = 0;                  // encoded so far
  int ScalarType = VTK_VOID;
  int Component = 0;
  std::string ArrayName;
};

//------------------------------------------------------------------------------
Status vtkCompressedVolumeBuilder::Work::CheckSlab(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden) const
{
  const vtkTypeInt64 tuples = samples ? samples->GetNumberOfTuples() : 0;
  const vtkTypeInt64 slices = tuples / this->SamplesPerSlice();
  const vtkTypeInt64 left = this->Dimensions[2] - this->Slices;
  if (tuples == 0 || tuples % this->SamplesPerSlice() != 0)
  {
    return Status::Error("The slab has ", tuples, " samples, which is not a multiple of the ",
      this->Dimensions[0], " x ", this->Dimensions[1], " of a slice.");
  }
  if (slices > left)
  {
    return Status::Error(
      "The slab has ", slices, " slices where ", left, " are left of ", this->Dimensions[2], ".");
  }
  if (slices % BlockSide != 0 && slices < left)
  {
    return Status::Error("The slab has ", slices,
      " slices: only the last may have another number than a multiple of 4.");
  }
  if (!HasComponent(samples, component))
  {
    return Status::Error("Component is ", component, ", but the slab has ",
      samples->GetNumberOfComponents(), " component(s), and -1 for its magnitude.");
  }
  if (hidden && hidden->GetNumberOfValues() != tuples)
  {
    return Status::Error(
      "There are ", hidden->GetNumberOfValues(), " values that hide ", tuples, " samples.");
  }
  return {};
}

//------------------------------------------------------------------------------
Status vtkCompressedVolumeBuilder::Work::AddSlab(const ChosenSamples& samples, int threads)
{
  vtkDataArray* const array = samples.Array;
  if (this->Slices == 0)
  {
    this->ScalarType = array->GetDataType();
    this->Component = samples.Original;
    this->ArrayName = array->GetName() ? array->GetName() : "";
  }
  if (array->GetDataType() != this->ScalarType)
  {
    return Status::Error("The slab is of type ", array->GetDataTypeAsString(),
      ", but those before of ", vtkImageScalarTypeNameMacro(this->ScalarType), ".");
  }
  const int end =
    this->Slices + static_cast<int>(array->GetNumberOfTuples() / this->SamplesPerSlice());
  BlockStream blocks = this->GetBlocks(threads);
  this->Encoder.EncodeSlabs(blocks, this->Slices / BlockSide, BlocksAlong(end), array,
    samples.Component, [](double) { return true; });
  const SampleSummary& summary = this->Encoder.GetSummary();
  if (!summary.IsFinite())
  {
    return Status::Error(
      "Slices ", this->Slices, " to ", end - 1, " have ", summary.CheckValues().GetMessage());
  }
  if (this->Levels)
  {
    this->Levels->Units = this->Encoder.Units;
    this->Levels->Hidden = this->Encoder.Hidden;
    this->Levels->AddSlices(array, samples.Component, [](double) { return true; });
  }
  this->Slices = end;
  return {};
}

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
// Gives up the volume; returns false.
bool vtkCompressedVolumeBuilder::SetError(const std::string& message)
{
  this->Volume.reset();
  this->ErrorMessage = message;
  return false;
}

//------------------------------------------------------------------------------
// Says that nothing has been started, or why it was given up; returns false.
bool vtkCompressedVolumeBuilder::SetErrorWithoutVolume()
{
  return this->SetError(
    this->ErrorMessage.empty() ? "Nothing has been started." : this->ErrorMessage);
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::Start(const int dims[3], double rate)
{
  this->Volume.reset();
  const int blockBits = vtkCompressedVolume::BlockBitsForRate(rate);
  Status status;
  if (blockBits == 0)
  {
    status = Status::Error("The rate is ", rate, " bits per sample: it must be in (0, 32].");
  }
  else if (*std::min_element(dims, dims + 3) < 2)
  {
    status = Status::Error("Only volumes can be compressed: there are ", dims[0], " x ", dims[1],
      " x ", dims[2], " samples, at least 2 along each axis are needed.");
  }
  else if (!std::isfinite(this->Offset) || !std::isfinite(this->Scale) || !(this->Scale > 0.0))
  {
    status = Status::Error("The stream's units are an offset of ", this->Offset, " and a scale of ",
      this->Scale, ": both must be finite, and the latter above 0.");
  }
  if (!status)
  {
    return this->SetError(status.GetMessage());
  }
  this->Volume = std::make_unique<Work>(dims, blockBits);
  const vtkTypeInt64 bytes = vtkCompressedVolume::StreamBytesFor(dims, blockBits);
  status = AllocateArray(this->Volume->Stream.Get(), bytes, "the stream", dims);
  if (status)
  {
    status = this->Volume->Encoder.Allocate(this->Volume->GetBlocks(this->NumberOfThreads));
  }
  if (status && this->Levels > 0)
  {
    this->Volume->Levels = std::make_unique<Pyramid>(dims, this->NumberOfThreads);
    status = this->Volume->Levels->Start(this->Spacing, this->Levels, blockBits);
  }
  if (!status)
  {
    return this->SetError("There is " + status.GetMessage() + ".");
  }
  this->ErrorMessage.clear();
  return true;
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::AddSlab(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden)
{
  if (!this->Volume)
  {
    return this->SetErrorWithoutVolume();
  }
  Status status = this->Volume->CheckSlab(samples, component, hidden);
  ChosenSamples chosen;
  if (status)
  {
    status = ChooseSamples(samples, component, chosen);
  }
  if (status)
  {
    SampleEncoder& encoder = this->Volume->Encoder;
    encoder.Hidden = HiddenSamples::FromMask(hidden);
    encoder.Hidden.HideNonFinite = this->MaskNonFinite && HasNonFinite(chosen.Array);
    encoder.Units = { this->Offset, this->Scale };
    status = this->Volume->AddSlab(chosen, this->NumberOfThreads);
  }
  if (!status)
  {
    return this->SetError(status.GetMessage());
  }
  this->ErrorMessage.clear();
  return true;
}

//------------------------------------------------------------------------------
bool vtkCompressedVolumeBuilder::Finish(vtkImageData* image)
{
  if (!this->Volume)
  {
    return this->SetErrorWithoutVolume();
  }
  if (this->Volume->Slices < this->Volume->Dimensions[2])
  {
    return this->SetError("Only " + std::to_string(this->Volume->Slices) + " slices of " +
      std::to_string(this->Volume->Dimensions[2]) + " have been added.");
  }
  const SampleSummary summary = this->Volume->Encoder.GetSummary();
  if (Status status = summary.CheckValues(); !status)
  {
    return this->SetError("The volume has " + status.GetMessage());
  }
  const std::unique_ptr<Work> work = std::move(this->Volume);
  const std::string name = this->ArrayName.empty() ? work->ArrayName : this->ArrayName;
  if (!std::equal(work->Dimensions, work->Dimensions + 3, image->GetDimensions()))
  {
    image->SetDimensions(work->Dimensions);
  }
  image->GetPointData()->Initialize();
  image->GetCellData()->Initialize();
  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(work->BlockBits);
  volume->SetDimensions(work->Dimensions);
  volume->SetOffset(this->Offset);
  volume->SetScale(this->Scale);
  volume->SetStoredRange(summary.GetRange()[0], summary.GetRange()[1]);
  volume->SetLargestError(summary.LargestError);
  volume->SetMeanError(summary.GetMeanError());
  volume->SetMacrocellErrors(work->Encoder.GetErrors().MakeArray());
  volume->SetHiddenSamples(work->Encoder.GetMask());
  volume->SetScalarType(work->ScalarType);
  volume->SetArrayName(name.empty() ? "scalars" : name);
  volume->SetComponent(work->Component);
  volume->SetStream(work->Stream);
  volume->SetRanges(work->Encoder.GetRanges().Finish(
    work->GetBlocks(this->NumberOfThreads), volume->GetCellsWithoutSurface()));
  if (work->Levels)
  {
    for (const auto& level : work->Levels->Finish())
    {
      volume->AddLevel(level);
    }
  }
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
  os << indent << "Levels: " << this->Levels << "\n";
  os << indent << "Spacing: " << this->Spacing[0] << " " << this->Spacing[1] << " "
     << this->Spacing[2] << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfSlices: " << this->GetNumberOfSlices() << "\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}
