// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageZFPCompress.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BlockStream.h"
#include "Codec/LabelDetector.h"
#include "Codec/Magnitude.h"
#include "Codec/Pyramid.h"
#include "Codec/RateFinder.h"
#include "Codec/SampleEncoder.h"
#include "Format/StreamArray.h"
#include "Pieces/CompressedPart.h"
#include "Pieces/HidingFlags.h"
#include "Pieces/PipelineRequests.h"
#include "Status.h"

#include "vtkBlockRanges.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstring>
#include <string>

vtkStandardNewMacro(vtkImageZFPCompress);

namespace
{
// The part of the work that the volume's own stream takes, where levels are made, too.
constexpr double StreamPart = 0.7;

//------------------------------------------------------------------------------
// Returns the first array that is not VTK's ghost array.
vtkDataArray* FirstArray(vtkDataSetAttributes* attributes)
{
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
// Lists all arrays for an error message: "a, b".
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
// Whether an array is one of these attributes. Not by name, which a point and a cell array may
// share.
bool HasArray(vtkDataSetAttributes* attributes, vtkDataArray* array)
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

//------------------------------------------------------------------------------
// Copies the input without its point and cell arrays, and without a stream.
void CopyWithoutArrays(vtkImageData* input, vtkImageData* output)
{
  output->Initialize();
  output->CopyStructure(input);
  output->GetPointData()->Initialize(); // ghost arrays that hide come with the structure
  output->GetCellData()->Initialize();
  output->GetFieldData()->PassData(input->GetFieldData());
  vtkCompressedVolume::Remove(output);
}
}

//------------------------------------------------------------------------------
vtkDataArray* vtkImageZFPCompress::FindDefaultArray(vtkImageData* image, int& association)
{
  vtkPointData* points = image->GetPointData();
  vtkCellData* cells = image->GetCellData();
  association = vtkCompressedVolume::PointData;
  if (points->GetScalars())
  {
    return points->GetScalars();
  }
  vtkDataArray* firstOfPoints = cells->GetScalars() ? nullptr : FirstArray(points);
  if (firstOfPoints)
  {
    return firstOfPoints;
  }
  association = vtkCompressedVolume::CellData;
  return cells->GetScalars() ? cells->GetScalars() : FirstArray(cells);
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
  vtkInformation* out = outputVector->GetInformationObject(0);
  PipelineRequests::CopyGeometry(inputVector[0]->GetInformationObject(0), out);
  // the output has no scalars
  out->Remove(vtkDataObject::POINT_DATA_VECTOR());
  out->Remove(vtkDataObject::CELL_DATA_VECTOR());
  return 1;
}

//------------------------------------------------------------------------------
// A stream is made of the whole image, or of this process' piece of it with ghost cells around.
int vtkImageZFPCompress::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  PipelineRequests::RequestWholeExtent(in);
  vtkInformationIntegerKey* ghosts =
    vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS();
  if (in->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1)
  {
    in->Set(ghosts, std::max(in->Get(ghosts), +vtkCompressedVolume::NumberOfGhostLevels));
  }
  return 1;
}

//------------------------------------------------------------------------------
// One update.
class vtkImageZFPCompress::Work
{
public:
  Work(vtkImageZFPCompress* self, vtkInformationVector** inputVector)
    : Self(self)
    , InputVector(inputVector)
    , Input(vtkImageData::GetData(inputVector[0]))
  {
  }

  Status Run(vtkImageData* output);

private:
  Status FindArray();
  int GetComponent() const;
  Status CheckInput(const CompressedPart& part) const;
  Status FindBlockBits(const int dims[3], const ChosenSamples& samples,
    const SampleEncoder& encoder, int& blockBits) const;
  Status Compress(const CompressedPart& part, vtkImageData* output) const;
  Status MakeLevels(
    const ChosenSamples& samples, const SampleEncoder& encoder, vtkCompressedVolume* volume) const;
  ProgressCallback ProgressFrom(double begin, double end) const;
  void PassArrays(vtkImageData* output) const;

  vtkImageZFPCompress* Self;
  vtkInformationVector** InputVector;
  vtkImageData* Input;
  vtkDataArray* Array = nullptr; // to compress
  int Association = vtkCompressedVolume::PointData;
};

//------------------------------------------------------------------------------
Status vtkImageZFPCompress::Work::Run(vtkImageData* output)
{
  if (Status status = this->FindArray(); !status)
  {
    return status;
  }
  CompressedPart part(this->Input, this->InputVector[0]->GetInformationObject(0),
    this->Association == vtkCompressedVolume::CellData);
  output->SetExtent(part.WithoutGhosts);
  if (output->GetNumberOfPoints() == 0)
  {
    return {}; // all cells are ghost cells
  }
  const Status status = this->CheckInput(part);
  return status ? this->Compress(part, output) : status;
}

//------------------------------------------------------------------------------
Status vtkImageZFPCompress::Work::FindArray()
{
  vtkInformation* choice = this->Self->GetInputArrayInformation(0);
  const char* name =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool chosen = name && *name; // ParaView sends an empty name for "none chosen yet"
  this->Array = this->Self->GetInputArrayToProcess(0, this->InputVector);
  this->Association = this->Array && HasArray(this->Input->GetCellData(), this->Array)
    ? vtkCompressedVolume::CellData
    : vtkCompressedVolume::PointData;
  if (!this->Array && !chosen)
  {
    this->Array = FindDefaultArray(this->Input, this->Association);
  }
  if (this->Array)
  {
    return {};
  }
  return !chosen && vtkCompressedVolume::IsCompressed(this->Input)
    ? Status::Error("The input is a compressed volume already: decompress it first.")
    : Status::Error("There is no ",
        chosen ? "point or cell array '" + std::string(name) + "'" : "array",
        " to compress; the input's arrays: ", ArrayNames(this->Input), ".");
}

//------------------------------------------------------------------------------
// Returns the component of the array to compress; -1: the magnitude.
int vtkImageZFPCompress::Work::GetComponent() const
{
  const int count = this->Array->GetNumberOfComponents();
  const bool isMagnitude =
    this->Self->MagnitudeIsLast && count > 1 && this->Self->Component == count;
  return isMagnitude ? -1 : this->Self->Component;
}

//------------------------------------------------------------------------------
Status vtkImageZFPCompress::Work::CheckInput(const CompressedPart& part) const
{
  const int* dims = part.Size;
  const vtkIdType samples =
    part.CellData ? this->Input->GetNumberOfCells() : this->Input->GetNumberOfPoints();
  const std::string name = NameOf(this->Array);
  const double rate = this->Self->Rate;
  const int component = this->GetComponent();
  if (vtkCompressedVolume::BlockBitsForRate(rate) == 0)
  {
    return Status::Error("Rate is ", rate, " bits per sample: it must be in (0, 32].");
  }
  if (!HasComponent(this->Array, component))
  {
    return Status::Error("Component is ", component, ", but array '", name, "' has ",
      this->Array->GetNumberOfComponents(), " component(s), and -1 for its magnitude.");
  }
  if (*std::min_element(dims, dims + 3) < 2)
  {
    return Status::Error("Only volumes can be compressed: array '", name, "' has ", dims[0], " x ",
      dims[1], " x ", dims[2], " samples, at least 2 along each axis are needed.");
  }
  if (this->Array->GetNumberOfTuples() != samples)
  {
    return Status::Error("Array '", name, "' has ", this->Array->GetNumberOfTuples(),
      " tuples, the image needs ", samples, ".");
  }
  return {};
}

//------------------------------------------------------------------------------
// Finds the rate that was asked for: itself, or by a tolerance, or by what the samples are.
Status vtkImageZFPCompress::Work::FindBlockBits(const int dims[3], const ChosenSamples& samples,
  const SampleEncoder& encoder, int& blockBits) const
{
  const int component = samples.Component;
  blockBits = vtkCompressedVolume::BlockBitsForRate(this->Self->Rate);
  RateFinder finder;
  finder.Units = encoder.Units;
  finder.Hidden = encoder.Hidden;
  finder.Threads = this->Self->NumberOfThreads;
  finder.Tolerance = this->Self->Tolerance;
  if (finder.Tolerance > 0.0)
  {
    const bool isFound = finder.Find(dims, samples.Array, component);
    blockBits = finder.GetBlockBits();
    return isFound ? Status()
                   : Status::Error("No rate keeps the samples within ", finder.Tolerance,
                       ": at 32 bits some are off by ", finder.GetLeastError(), ".");
  }
  if (this->Self->KeepLabels)
  {
    LabelDetector detector;
    detector.Hidden = encoder.Hidden;
    detector.AddSlabs(dims, 0, BlocksAlong<vtkTypeInt64>(dims[2]), samples.Array, component);
    if (detector.FindsLabels())
    {
      finder.Tolerance = LabelDetector::Tolerance;
      finder.SetBlockBits(blockBits);
      blockBits = finder.Find(dims, samples.Array, component)
        ? finder.GetBlockBits()
        : +vtkCompressedVolume::MaximumBlockBits;
    }
  }
  return {};
}

//------------------------------------------------------------------------------
Status vtkImageZFPCompress::Work::Compress(const CompressedPart& part, vtkImageData* output) const
{
  const int* dims = part.Size;
  ChosenSamples samples;
  if (Status status = ChooseSamples(part.CutSamples(this->Array), this->GetComponent(), samples);
      !status)
  {
    return Status::Error("There is ", status.GetMessage(), ".");
  }
  const vtkSmartPointer<vtkUnsignedCharArray> flags = part.FindHiddenSamples(this->Input);
  SampleEncoder encoder;
  encoder.Hidden.Flags = flags ? flags->GetPointer(0) : nullptr;
  encoder.Hidden.HidingFlags = part.CellData ? HidingFlags::OfCells : HidingFlags::OfPoints;
  encoder.Hidden.HideNonFinite = this->Self->MaskNonFinite && HasNonFinite(samples.Array);
  encoder.Units = SampleUnits::Find(samples.Array, samples.Component, encoder.Hidden);

  int blockBits = 0;
  if (Status status = this->FindBlockBits(dims, samples, encoder, blockBits); !status)
  {
    return status;
  }
  const vtkTypeInt64 bytes = vtkCompressedVolume::StreamBytesFor(dims, blockBits);
  vtkNew<StreamArray> stream;
  if (Status status = AllocateArray(stream.Get(), bytes, "the stream", dims); !status)
  {
    return Status::Error("There is ", status.GetMessage(), ".");
  }
  BlockStream blocks(dims, blockBits, stream->GetPointer(0), this->Self->NumberOfThreads);
  if (Status status = encoder.Allocate(blocks); !status)
  {
    return Status::Error("There is ", status.GetMessage(), ".");
  }
  if (!encoder.EncodeSlabs(blocks, 0, blocks.GetNumberOfSlabs(), samples.Array, samples.Component,
        this->ProgressFrom(0.0, this->Self->Levels > 0 ? StreamPart : 1.0)))
  {
    return Status::Aborted();
  }
  const SampleSummary& summary = encoder.GetSummary();
  if (Status status = summary.CheckValues(); !status)
  {
    return status.WithPrefix("Array '" + NameOf(this->Array) + "' has ");
  }

  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(blockBits);
  volume->SetDimensions(dims[0], dims[1], dims[2]);
  volume->SetOffset(encoder.Units.Offset);
  volume->SetScale(encoder.Units.Scale);
  volume->SetStoredRange(summary.GetRange()[0], summary.GetRange()[1]);
  volume->SetLargestError(summary.LargestError);
  volume->SetMeanError(summary.GetMeanError());
  volume->SetMacrocellErrors(encoder.GetErrors().MakeArray());
  volume->SetHiddenSamples(encoder.GetMask());
  volume->SetHiddenCells(part.FindHiddenCells(this->Input));
  volume->SetScalarType(samples.Array->GetDataType());
  volume->SetArrayName(NameOf(this->Array));
  volume->SetComponent(samples.Original);
  volume->SetAssociation(this->Association);
  volume->SetExtent(part.Covered[0], part.Covered[1], part.Covered[2], part.Covered[3],
    part.Covered[4], part.Covered[5]);
  volume->SetStream(stream);
  volume->SetRanges(encoder.GetRanges().Finish(blocks, volume->GetCellsWithoutSurface()));
  if (Status status = this->MakeLevels(samples, encoder, volume); !status)
  {
    return status;
  }
  volume->Write(output);
  this->Self->OutputRate = volume->GetRate();
  this->Self->OutputError = volume->GetLargestError();
  if (this->Self->PassOtherArrays)
  {
    this->PassArrays(output);
  }
  return {};
}

//------------------------------------------------------------------------------
// Returns what reports the progress of a part of the work.
ProgressCallback vtkImageZFPCompress::Work::ProgressFrom(double begin, double end) const
{
  const ProgressCallback report = ProgressOf(this->Self);
  return [=](double fraction) { return report(begin + fraction * (end - begin)); };
}

//------------------------------------------------------------------------------
Status vtkImageZFPCompress::Work::MakeLevels(
  const ChosenSamples& samples, const SampleEncoder& encoder, vtkCompressedVolume* volume) const
{
  Pyramid pyramid(volume->GetDimensions(), this->Self->NumberOfThreads);
  pyramid.Units = encoder.Units;
  pyramid.Hidden = encoder.Hidden;
  pyramid.HiddenCells = volume->GetHiddenCells();
  if (Status status =
        pyramid.Start(this->Input->GetSpacing(), this->Self->Levels, volume->GetBlockBits());
      !status)
  {
    return Status::Error("There is ", status.GetMessage(), ".");
  }
  if (this->Self->Levels > 0 &&
    !pyramid.AddSlices(samples.Array, samples.Component, this->ProgressFrom(StreamPart, 1.0)))
  {
    return Status::Aborted();
  }
  for (const auto& level : pyramid.Finish())
  {
    volume->AddLevel(level);
  }
  return {};
}

//------------------------------------------------------------------------------
// Passes all arrays but the compressed one, and those that hide, which the stream's metadata tell.
void vtkImageZFPCompress::Work::PassArrays(vtkImageData* output) const
{
  vtkNew<vtkImageData> own;
  own->ShallowCopy(this->Input);
  own->Crop(output->GetExtent());
  for (const int association : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const from = this->Input->GetAttributes(association);
    vtkDataSetAttributes* const to = output->GetAttributes(association);
    to->PassData(own->GetAttributes(association));
    to->RemoveArray(vtkDataSetAttributes::GhostArrayName());
    if (HasArray(from, this->Array))
    {
      to->RemoveArray(this->Array->GetName());
    }
  }
}

//------------------------------------------------------------------------------
int vtkImageZFPCompress::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* output = vtkImageData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  this->OutputRate = 0.0;
  this->OutputError = -1.0;
  CopyWithoutArrays(vtkImageData::GetData(inputVector[0]), output);
  if (vtkCompressedVolume::IsEmptyPiece(inputVector[0]->GetInformationObject(0)))
  {
    return 1;
  }
  const Status status = Work(this, inputVector).Run(output);
  if (!status)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  if (!status && !status.IsAborted())
  {
    vtkErrorMacro(<< status.GetMessage());
  }
  return 1; // the executive need not add a message of its own
}

//------------------------------------------------------------------------------
void vtkImageZFPCompress::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << " (actually " << this->GetActualRate() << ")\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "MagnitudeIsLast: " << (this->MagnitudeIsLast ? "on\n" : "off\n");
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "KeepLabels: " << (this->KeepLabels ? "on\n" : "off\n");
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Levels: " << this->Levels << "\n";
  os << indent << "PassOtherArrays: " << (this->PassOtherArrays ? "on\n" : "off\n");
  os << indent << "OutputRate: " << this->OutputRate << "\n";
  os << indent << "OutputError: " << this->OutputError << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
