// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedVolume.h"

#include "Codec/BitCopy.h"
#include "Codec/BlockGeometry.h"
#include "Codec/BlockRangeFinder.h"
#include "Codec/BlockStream.h"
#include "Codec/MacrocellErrors.h"
#include "Codec/SampleSummary.h"
#include "Format/CompressedVolumeFormat.h"
#include "Format/StreamArray.h"
#include "Pieces/PieceExtents.h"
#include "Status.h"

#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

vtkStandardNewMacro(vtkCompressedVolume);

//------------------------------------------------------------------------------
vtkCompressedVolume::vtkCompressedVolume() = default;
vtkCompressedVolume::~vtkCompressedVolume() = default;

//------------------------------------------------------------------------------
bool vtkCompressedVolume::IsCompressed(vtkDataObject* object)
{
  return CompressedVolumeFormat::HasStream(object);
}

//------------------------------------------------------------------------------
int vtkCompressedVolume::BlockBitsForRate(double rate)
{
  if (!(rate > 0.0 && rate <= MaximumBlockBits / 64.0))
  {
    return 0;
  }
  // rounds as zfp_stream_set_rate() does
  return std::max(static_cast<int>(std::floor(64.0 * rate + 0.5)), +MinimumBlockBits);
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkCompressedVolume::NumberOfBlocksFor(const int dims[3])
{
  vtkTypeInt64 blocks = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 along = BlocksAlong(static_cast<vtkTypeInt64>(dims[axis]));
    if (dims[axis] < 1 || blocks > std::numeric_limits<vtkTypeInt64>::max() / along)
    {
      return -1;
    }
    blocks *= along;
  }
  return blocks;
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkCompressedVolume::StreamBytesFor(const int dims[3], int blockBits)
{
  const vtkTypeInt64 blocks = NumberOfBlocksFor(dims);
  if (blocks < 0 || blockBits < 1 ||
    blocks > (std::numeric_limits<vtkTypeInt64>::max() - 63) / blockBits)
  {
    return -1;
  }
  return (blocks * blockBits + 63) / 64 * 8;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Clear()
{
  this->BlockBits = 0;
  std::fill_n(this->Dimensions, 3, 0);
  for (int i = 0; i < 6; ++i)
  {
    this->Extent[i] = -(i % 2);
  }
  std::fill_n(this->Range, 2, 0.0);
  this->Offset = 0.0;
  this->Scale = 1.0;
  this->ScalarType = 0;
  this->ArrayName.clear();
  this->Component = 0;
  this->Association = PointData;
  this->HiddenSamples = this->HiddenCells = vtkBlockMask();
  this->LargestError = this->MeanError = -1.0;
  this->MacrocellErrors = nullptr;
  this->Stream = nullptr;
  this->Ranges = vtkBlockRanges();
  this->HasChecksums = false;
  std::fill_n(this->Steps, 3, 1);
  this->LargestDistance = -1.0;
  this->Levels.clear();
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::Read(vtkImageData* image)
{
  this->Clear();
  const Status status = CompressedVolumeFormat::Read(image, this);
  if (!status)
  {
    this->Clear();
  }
  this->ErrorMessage = status.WithPrefix("not a valid compressed volume: ").GetMessage();
  return status.IsOk();
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Write(vtkImageData* image) const
{
  // not const in the call, because the functions of VTK's get macros are not
  CompressedVolumeFormat::Write(const_cast<vtkCompressedVolume*>(this), image);
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Remove(vtkDataObject* object)
{
  CompressedVolumeFormat::Remove(object);
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::Place(vtkImageData* image)
{
  return CompressedVolumeFormat::Place(image).IsOk();
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SpeedUpRanges(vtkDataObject* object)
{
  CompressedVolumeFormat::SpeedUpRanges(object);
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::IsEmptyPiece(vtkInformation* input)
{
  return PieceExtents::IsEmptyPiece(input);
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::GetOwnExtent(vtkImageData* image, int own[6])
{
  PieceExtents::GetExtentWithoutGhosts(image, own);
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::GetCoveringExtent(
  const int own[6], const int whole[6], int association, int covering[6])
{
  PieceExtents::GetCoveringExtent(own, whole, association == CellData, covering);
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::Covers(vtkImageData* image) const
{
  return std::equal(this->Extent, this->Extent + 6, image->GetExtent());
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Crop(const int own[6])
{
  int kept[6], first[3], count[3], dims[3];
  GetCoveringExtent(own, this->Extent, this->Association, kept);
  if (!this->Stream || std::equal(kept, kept + 6, this->Extent))
  {
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    dims[axis] = kept[2 * axis + 1] - kept[2 * axis] + (this->Association == CellData ? 0 : 1);
    first[axis] = (kept[2 * axis] - this->Extent[2 * axis]) / BlockSide;
    count[axis] = BlocksAlong(dims[axis]);
  }
  vtkNew<StreamArray> stream;
  stream->SetNumberOfValues(StreamBytesFor(dims, this->BlockBits));
  this->CopyBlocks(first, count, stream);
  int blocks[3];
  this->GetBlocks(blocks);
  this->HiddenSamples = this->HiddenSamples.Crop(first, count, blocks);
  this->HiddenCells = this->HiddenCells.Crop(first, count, blocks);
  this->CropErrors(first, count);
  this->Levels.clear();
  this->SetStream(stream);
  this->SetDimensions(dims);
  this->SetExtent(kept);
}

//------------------------------------------------------------------------------
// Gives every macrocell of a box of blocks the range and the error of all those that it lies in:
// the box need not begin with a macrocell.
void vtkCompressedVolume::CropErrors(const int first[3], const int count[3])
{
  if (!this->MacrocellErrors)
  {
    return;
  }
  vtkTypeInt64 blocks[3], kept[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    blocks[axis] = BlocksAlong(this->Dimensions[axis]);
    kept[axis] = count[axis];
  }
  ::MacrocellErrors cropped(kept);
  vtkTypeInt64 at[3];
  for (at[2] = 0; at[2] < kept[2]; ++at[2])
  {
    for (at[1] = 0; at[1] < kept[1]; ++at[1])
    {
      for (at[0] = 0; at[0] < kept[0]; ++at[0])
      {
        const vtkTypeInt64 from[3] = { first[0] + at[0], first[1] + at[1], first[2] + at[2] };
        const float* entry =
          this->MacrocellErrors->GetPointer(3 * ::MacrocellErrors::IndexOf(from, blocks));
        if (entry[0] <= entry[1])
        {
          cropped.Add(at, entry[0], entry[1], entry[2]);
        }
      }
    }
  }
  this->MacrocellErrors = cropped.MakeArray();
}

//------------------------------------------------------------------------------
// Copies the box of blocks row by row: the blocks of a row lie side by side.
void vtkCompressedVolume::CopyBlocks(
  const int first[3], const int count[3], vtkUnsignedCharArray* target) const
{
  int blocks[3];
  this->GetBlocks(blocks);
  const vtkTypeInt64 rowBits = static_cast<vtkTypeInt64>(count[0]) * this->BlockBits;
  vtkTypeInt64 end = 0;
  for (int z = first[2]; z < first[2] + count[2]; ++z)
  {
    for (int y = first[1]; y < first[1] + count[1]; ++y)
    {
      const vtkTypeInt64 block = BlockIndex(first[0], y, z, blocks);
      CopyBits(
        this->Stream->GetPointer(0), block * this->BlockBits, target->GetPointer(0), end, rowBits);
      end += rowBits;
    }
  }
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::GetBlocks(int blocks[3]) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    blocks[axis] = BlocksAlong(this->Dimensions[axis]);
  }
}

//------------------------------------------------------------------------------
vtkIdType vtkCompressedVolume::GetNumberOfBlocks() const
{
  return this->Stream ? static_cast<vtkIdType>(NumberOfBlocksFor(this->Dimensions)) : 0;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetArrayName(const std::string& name)
{
  if (this->ArrayName != name)
  {
    this->ArrayName = name;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
// Clamps to finite doubles: the largest ones, rounded to float32 in the stream's units, may
// overflow.
void vtkCompressedVolume::SetStoredRange(double low, double high)
{
  const double most = std::numeric_limits<double>::max();
  const auto bounded = [=](double value) { return std::min(std::max(value, -most), most); };
  this->SetRange(bounded(this->ToSample(low)), bounded(this->ToSample(high)));
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetHiddenSamples(const vtkBlockMask& mask)
{
  if (!(this->HiddenSamples == mask))
  {
    this->Ranges = vtkBlockRanges();
    this->HiddenSamples = mask;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetHiddenCells(const vtkBlockMask& mask)
{
  if (!(this->HiddenCells == mask))
  {
    this->Ranges = vtkBlockRanges();
    this->HiddenCells = mask;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkBlockMask vtkCompressedVolume::GetCellsWithoutSurface() const
{
  int blocks[3];
  this->GetBlocks(blocks);
  return this->HiddenSamples.ToCells(blocks, this->HiddenCells);
}

//------------------------------------------------------------------------------
vtkFloatArray* vtkCompressedVolume::GetMacrocellErrors() const
{
  return this->MacrocellErrors;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetMacrocellErrors(vtkFloatArray* macrocells)
{
  if (this->MacrocellErrors != macrocells)
  {
    this->MacrocellErrors = macrocells;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
// A bit more halves the error, or more than that.
std::string vtkCompressedVolume::DescribeDoubts(vtkDoubleArray* isovalues) const
{
  const vtkIdType count = this->LargestError > 0.0 ? isovalues->GetNumberOfValues() : 0;
  std::ostringstream listed;
  int number = 0;
  double rate = 0.0, error = 0.0, distance = std::numeric_limits<double>::infinity();
  for (vtkIdType i = 0; i < count && this->MacrocellErrors; ++i)
  {
    const double isovalue = isovalues->GetValue(i);
    const ::MacrocellErrors::Doubt doubt =
      ::MacrocellErrors::Judge(this->MacrocellErrors, this->ToStored(isovalue));
    if (doubt.IsLikely)
    {
      listed << (number++ > 0 ? ", " : "") << isovalue;
      error = std::max(error, this->Scale * doubt.Error);
      distance = std::min(distance, this->Scale * doubt.Distance);
    }
  }
  if (number == 0)
  {
    return {};
  }
  const double exact = (this->Range[1] - this->Range[0]) / 16777216.0; // float32's own digits
  const double bits = std::log2(error / std::max(distance, exact));
  rate = std::min(32.0, std::ceil(2.0 * (this->GetRate() + std::max(bits, 0.0)) + 1.0) / 2.0);
  std::ostringstream text;
  text << "Isovalue" << (number > 1 ? "s " : " ") << listed.str()
       << " may show another surface than the original's: at " << this->GetRate()
       << " bits per sample, samples " << distance << " from the isovalue are off by up to "
       << error << ". Compress at " << rate << " bits, or choose an isovalue farther from where "
       << "samples have one value.";
  return text.str();
}

//------------------------------------------------------------------------------
vtkUnsignedCharArray* vtkCompressedVolume::GetStream() const
{
  return this->Stream;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetStream(vtkUnsignedCharArray* stream)
{
  if (this->Stream != stream)
  {
    this->Ranges = vtkBlockRanges();
    this->Stream = stream;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkCompressedVolume* vtkCompressedVolume::GetLevel(int level) const
{
  return level >= 1 && level <= this->GetNumberOfLevels() ? this->Levels[level - 1] : nullptr;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::AddLevel(vtkCompressedVolume* volume)
{
  volume->SetOffset(this->Offset);
  volume->SetScale(this->Scale);
  volume->SetScalarType(this->ScalarType);
  volume->SetArrayName(this->ArrayName);
  volume->SetComponent(this->Component);
  volume->SetAssociation(this->Association);
  this->Levels.push_back(volume);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetRanges(const vtkBlockRanges& ranges)
{
  this->Ranges = ranges;
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::FindRanges()
{
  const auto stream = BlockStream::Align(this->Stream);
  const BlockStream blocks(this->Dimensions, this->BlockBits, stream->GetPointer(0), 0);
  BlockRangeFinder finder(blocks);
  if (!finder.Allocate())
  {
    return false;
  }
  SampleSummary unused;
  finder.AddAll(blocks, unused, [](double) { return true; });
  this->SetRanges(finder.Finish(blocks, this->GetCellsWithoutSurface()));
  return true;
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::CheckRanges()
{
  const vtkBlockRanges stored = this->Ranges;
  if (stored.IsEmpty())
  {
    return {};
  }
  const bool isFound = this->FindRanges();
  const bool areSame = this->Ranges == stored;
  this->SetRanges(stored);
  if (!isFound)
  {
    return "cannot be checked: there is not enough memory for those that its blocks decode to";
  }
  return areSame ? std::string() : "are wrong: its blocks decode to others";
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::FindDecodedRange(double range[2]) const
{
  const auto stream = BlockStream::Align(this->Stream);
  const BlockStream blocks(this->Dimensions, this->BlockBits, stream->GetPointer(0), 0);
  SampleSummary summary;
  blocks.Summarize(summary, [](double) { return true; });
  range[0] = this->ToSample(summary.Minimum);
  range[1] = this->ToSample(summary.Maximum);
  return summary.IsFinite();
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "BlockBits: " << this->BlockBits << "\n";
  os << indent << "Dimensions: " << this->Dimensions[0] << " " << this->Dimensions[1] << " "
     << this->Dimensions[2] << "\n";
  os << indent << "Extent:";
  for (const int bound : this->Extent)
  {
    os << " " << bound;
  }
  os << "\n";
  os << indent << "Range: " << this->Range[0] << " " << this->Range[1] << "\n";
  os << indent << "Offset: " << this->Offset << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "LargestError: " << this->LargestError << "\n";
  os << indent << "MeanError: " << this->MeanError << "\n";
  os << indent << "MacrocellErrors: "
     << (this->MacrocellErrors ? this->MacrocellErrors->GetNumberOfTuples() : 0) << "\n";
  os << indent << "ScalarType: " << this->ScalarType << "\n";
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "Association: " << (this->Association == CellData ? "cell" : "point")
     << " data\n";
  os << indent << "HiddenSamples: " << this->HiddenSamples.GetRuns().size() << " runs\n";
  os << indent << "HiddenCells: " << this->HiddenCells.GetRuns().size() << " runs\n";
  os << indent << "Ranges: " << this->Ranges.GetBytes() << " bytes\n";
  os << indent << "Stream: ";
  this->Stream ? os << this->Stream->GetNumberOfValues() << " bytes\n" : os << "(none)\n";
  os << indent << "HasChecksums: " << (this->HasChecksums ? "yes\n" : "no\n");
  os << indent << "Levels: " << this->GetNumberOfLevels() << "\n";
  os << indent << "Steps: " << this->Steps[0] << " " << this->Steps[1] << " " << this->Steps[2]
     << "\n";
  os << indent << "LargestDistance: " << this->LargestDistance << "\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}
