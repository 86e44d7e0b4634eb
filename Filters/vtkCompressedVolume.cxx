// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedVolume.h"

#include "Pieces/PieceExtents.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkTypeUInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

vtkStandardNewMacro(vtkCompressedVolume);

namespace
{
const char* const VersionName = "ProgIso.ZFP.Version";
const char* const StreamName = "ProgIso.ZFP.Stream";
const char* const BlockBitsName = "ProgIso.ZFP.BlockBits";
const char* const DimensionsName = "ProgIso.ZFP.Dimensions";
const char* const RangeName = "ProgIso.ZFP.Range";
const char* const ScalarTypeName = "ProgIso.ZFP.ScalarType";
const char* const ArrayNameName = "ProgIso.ZFP.ArrayName";
const char* const ComponentName = "ProgIso.ZFP.Component";
const char* const AssociationName = "ProgIso.ZFP.Association";
const char* const ExtentName = "ProgIso.ZFP.Extent";
const char* const OffsetName = "ProgIso.ZFP.Offset";
const char* const ScaleName = "ProgIso.ZFP.Scale";
const char* const HiddenSamplesName = "ProgIso.ZFP.HiddenSamples";
const char* const HiddenCellsName = "ProgIso.ZFP.HiddenCells";

const char* const AllNames[] = { VersionName, StreamName, BlockBitsName, DimensionsName, RangeName,
  ScalarTypeName, ArrayNameName, ComponentName, AssociationName, ExtentName, OffsetName, ScaleName,
  HiddenSamplesName, HiddenCellsName };

//------------------------------------------------------------------------------
// Values of a field data array; an error sentence when it is not `count` integers (or numbers).
std::string GetNumericArray(
  vtkFieldData* fields, const char* name, int count, bool integers, vtkDataArray*& array)
{
  array = vtkArrayDownCast<vtkDataArray>(fields->GetAbstractArray(name));
  const int type = array ? array->GetDataType() : VTK_VOID;
  const bool floating = type == VTK_FLOAT || type == VTK_DOUBLE;
  if (!array || floating == integers || array->GetNumberOfValues() != count)
  {
    std::ostringstream message;
    message << "its field data array " << name
            << (array ? " does not hold " : " is missing: expected ") << count
            << (integers ? " integer" : " floating point") << (count > 1 ? " values" : " value");
    return message.str();
  }
  return {};
}

//------------------------------------------------------------------------------
std::string GetIntegers(vtkFieldData* fields, const char* name, int count, vtkTypeInt64* values)
{
  vtkDataArray* array = nullptr;
  std::string error = GetNumericArray(fields, name, count, true, array);
  for (int i = 0; i < count && error.empty(); ++i)
  {
    values[i] = array->GetVariantValue(i).ToTypeInt64(); // exact, where GetComponent() is a double
  }
  return error;
}

//------------------------------------------------------------------------------
// One integer in [low, high].
std::string GetInteger(vtkFieldData* fields, const char* name, int low, int high, int& value)
{
  vtkTypeInt64 number = 0;
  std::string error = GetIntegers(fields, name, 1, &number);
  if (error.empty() && (number < low || number > high))
  {
    std::ostringstream message;
    message << name << " is " << number << ", not in " << low << ".." << high;
    return message.str();
  }
  value = static_cast<int>(number);
  return error;
}

//------------------------------------------------------------------------------
template <typename ArrayT, typename T>
void StoreNumbers(vtkFieldData* fields, const char* name, const T* values, int count)
{
  vtkNew<ArrayT> array;
  array->SetName(name);
  array->SetNumberOfValues(count);
  for (int i = 0; i < count; ++i)
  {
    array->SetValue(i, values[i]);
  }
  fields->AddArray(array);
}

//------------------------------------------------------------------------------
bool IsNumericType(int type)
{
  switch (type)
  {
    case VTK_BIT:
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
    case VTK_UNSIGNED_CHAR:
    case VTK_SHORT:
    case VTK_UNSIGNED_SHORT:
    case VTK_INT:
    case VTK_UNSIGNED_INT:
    case VTK_LONG:
    case VTK_UNSIGNED_LONG:
    case VTK_LONG_LONG:
    case VTK_UNSIGNED_LONG_LONG:
    case VTK_ID_TYPE:
    case VTK_FLOAT:
    case VTK_DOUBLE:
      return true;
    default:
      return false;
  }
}

//------------------------------------------------------------------------------
// Whether sums and differences of positions in an extent do not overflow.
bool IsBounded(vtkTypeInt64 low, vtkTypeInt64 high)
{
  const vtkTypeInt64 most = vtkTypeInt64(1) << 30;
  return -most <= low && low <= most && -most <= high && high <= most;
}

//------------------------------------------------------------------------------
vtkTypeUInt64 LoadWord(const unsigned char* stream, vtkTypeInt64 index)
{
  vtkTypeUInt64 word;
  std::memcpy(&word, stream + 8 * index, 8);
  return word;
}

//------------------------------------------------------------------------------
// Appends bits [first, first + count) of a stream to one that is zero from bit `end` on.
void AppendBits(const unsigned char* from, vtkTypeInt64 first, vtkTypeInt64 count,
  unsigned char* to, vtkTypeInt64& end)
{
  while (count > 0)
  {
    const int shift = first % 64, offset = end % 64;
    const int taken = static_cast<int>(std::min<vtkTypeInt64>(64 - offset, count));
    vtkTypeUInt64 bits = LoadWord(from, first / 64) >> shift;
    if (shift + taken > 64)
    {
      bits |= LoadWord(from, first / 64 + 1) << (64 - shift);
    }
    if (taken < 64)
    {
      bits &= (vtkTypeUInt64(1) << taken) - 1;
    }
    const vtkTypeUInt64 word = LoadWord(to, end / 64) | bits << offset;
    std::memcpy(to + end / 64 * 8, &word, 8);
    first += taken;
    end += taken;
    count -= taken;
  }
}
}

//------------------------------------------------------------------------------
vtkCompressedVolume::vtkCompressedVolume() = default;
vtkCompressedVolume::~vtkCompressedVolume() = default;

//------------------------------------------------------------------------------
bool vtkCompressedVolume::IsCompressed(vtkDataObject* object)
{
  return object && object->GetFieldData() && object->GetFieldData()->HasArray(StreamName);
}

//------------------------------------------------------------------------------
int vtkCompressedVolume::BlockBitsForRate(double rate)
{
  if (!(rate > 0.0 && rate <= MaximumBlockBits / 64))
  {
    return 0;
  }
  // as zfp_stream_set_rate() does
  return std::max(static_cast<int>(std::floor(64.0 * rate + 0.5)), +MinimumBlockBits);
}

//------------------------------------------------------------------------------
vtkTypeInt64 vtkCompressedVolume::NumberOfBlocksFor(const int dims[3])
{
  vtkTypeInt64 blocks = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 along = (static_cast<vtkTypeInt64>(dims[axis]) + 3) / 4;
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
  this->Stream = nullptr;
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkCompressedVolume::Read(vtkImageData* image)
{
  this->Clear();
  const std::string error = this->Check(image);
  if (!error.empty())
  {
    this->Clear();
  }
  this->ErrorMessage = error.empty() ? error : "not a valid compressed volume: " + error;
  return error.empty();
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::Check(vtkImageData* image)
{
  if (!IsCompressed(image))
  {
    return image ? "it has no field data array ProgIso.ZFP.Stream (compress it first)"
                 : "there is no image";
  }
  std::string error = this->ReadNumbers(image);
  if (error.empty())
  {
    error = this->CheckGeometry(image);
  }
  if (error.empty())
  {
    error = this->ReadStreamAndName(image);
  }
  if (error.empty())
  {
    error = this->ReadUnits(image);
  }
  return error.empty() ? this->ReadHidden(image) : error;
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::ReadNumbers(vtkImageData* image)
{
  vtkFieldData* fields = image->GetFieldData();
  const int most = std::numeric_limits<int>::max();
  int version = 0;
  std::string error = GetInteger(fields, VersionName, 1, most, version);
  if (error.empty() && version > FormatVersion)
  {
    return "it has version " + std::to_string(version) +
      " of the format, this ProgIso reads version " + std::to_string(FormatVersion) +
      " and older (a newer ProgIso wrote it)";
  }
  const auto get = [&](const char* name, int low, int high, int& value)
  {
    if (error.empty())
    {
      error = GetInteger(fields, name, low, high, value);
    }
  };
  get(BlockBitsName, MinimumBlockBits, MaximumBlockBits, this->BlockBits);
  get(ScalarTypeName, 0, most, this->ScalarType);
  get(ComponentName, 0, most, this->Component);
  get(AssociationName, PointData, CellData, this->Association);
  if (error.empty() && !IsNumericType(this->ScalarType))
  {
    return std::string(ScalarTypeName) + " is " + std::to_string(this->ScalarType) +
      ", not a VTK number type";
  }
  vtkDataArray* range = nullptr;
  if (error.empty())
  {
    error = GetNumericArray(fields, RangeName, 2, false, range);
  }
  if (!error.empty())
  {
    return error;
  }
  for (int i = 0; i < 2; ++i)
  {
    this->Range[i] = range->GetVariantValue(i).ToDouble();
  }
  const bool finite = std::isfinite(this->Range[0]) && std::isfinite(this->Range[1]);
  return finite && this->Range[0] <= this->Range[1]
    ? std::string()
    : std::string(RangeName) + " is not a finite range";
}

//------------------------------------------------------------------------------
// Sets Extent to that of the stream: the image's own, or where that is of another size, the one
// that the stream names.
void vtkCompressedVolume::FindExtent(vtkImageData* image, const vtkTypeInt64 dims[3])
{
  image->GetExtent(this->Extent);
  const int cells = this->Association == CellData ? 1 : 0;
  const auto fits = [&](const vtkTypeInt64* extent)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const vtkTypeInt64 low = extent[2 * axis], high = extent[2 * axis + 1];
      if (!IsBounded(low, high) || high - low + 1 - cells != dims[axis])
      {
        return false;
      }
    }
    return true;
  };
  vtkTypeInt64 extent[6];
  std::copy_n(this->Extent, 6, extent);
  if (!fits(extent) && GetIntegers(image->GetFieldData(), ExtentName, 6, extent).empty() &&
    fits(extent))
  {
    std::copy_n(extent, 6, this->Extent);
  }
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::CheckGeometry(vtkImageData* image)
{
  vtkTypeInt64 dims[3];
  std::string error = GetIntegers(image->GetFieldData(), DimensionsName, 3, dims);
  if (!error.empty())
  {
    return error;
  }
  this->FindExtent(image, dims);
  const bool cells = this->Association == CellData;
  std::ostringstream message;
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 low = this->Extent[2 * axis], high = this->Extent[2 * axis + 1];
    const vtkTypeInt64 expected = high - low + (cells ? 0 : 1);
    if (dims[axis] != expected)
    {
      message << DimensionsName << " is " << dims[axis] << " along axis " << axis
              << ", but the image has " << expected << (cells ? " cells" : " points") << " there";
      return message.str();
    }
    if (expected < 2 || expected > std::numeric_limits<int>::max())
    {
      message << "it has " << expected << (cells ? " cells" : " points") << " along axis " << axis
              << ", at least 2 and at most 2^31-1 are needed";
      return message.str();
    }
    if (!IsBounded(low, high))
    {
      message << "its extent along axis " << axis << ", " << low << " to " << high
              << ", reaches beyond -2^30 or 2^30";
      return message.str();
    }
  }
  const int* own = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (own[2 * axis + 1] < own[2 * axis] + (cells ? 1 : 0))
    {
      message << "the image has no " << (cells ? "cells" : "points") << " along axis " << axis;
      return message.str();
    }
  }
  return PieceExtents::Contains(this->Extent, own)
    ? std::string()
    : "its stream is that of another piece (one compressed volume cannot be put together from "
      "several)";
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::ReadStreamAndName(vtkImageData* image)
{
  vtkFieldData* fields = image->GetFieldData();
  vtkTypeInt64 dims[3];
  GetIntegers(fields, DimensionsName, 3, dims); // checked against the image before
  std::copy_n(dims, 3, this->Dimensions);

  auto* names = vtkArrayDownCast<vtkStringArray>(fields->GetAbstractArray(ArrayNameName));
  if (!names || names->GetNumberOfValues() != 1)
  {
    return std::string("its field data array ") + ArrayNameName + " does not hold one string";
  }
  this->ArrayName = names->GetValue(0);

  auto* stream = vtkArrayDownCast<vtkUnsignedCharArray>(fields->GetAbstractArray(StreamName));
  const vtkTypeInt64 needed = StreamBytesFor(this->Dimensions, this->BlockBits);
  if (!stream)
  {
    return std::string("its field data array ") + StreamName + " is not an array of unsigned char";
  }
  if (needed < 0 || stream->GetNumberOfValues() < needed)
  {
    std::ostringstream message;
    message << StreamName << " is truncated: it has " << stream->GetNumberOfValues() << " bytes, ";
    needed < 0 ? message << "its dimensions need more than 2^60"
               : message << needed << " are needed";
    return message.str();
  }
  this->Stream = stream;
  return {};
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::ReadUnits(vtkImageData* image)
{
  vtkFieldData* fields = image->GetFieldData();
  const auto read = [fields](const char* name, double& value)
  {
    vtkDataArray* array = nullptr;
    std::string error;
    if (fields->HasArray(name))
    {
      error = GetNumericArray(fields, name, 1, false, array);
      value = error.empty() ? array->GetVariantValue(0).ToDouble() : value;
    }
    return error;
  };
  std::string error = read(OffsetName, this->Offset);
  error = error.empty() ? read(ScaleName, this->Scale) : error;
  if (error.empty() && !std::isfinite(this->Offset))
  {
    return std::string(OffsetName) + " is not finite";
  }
  if (error.empty() && !(this->Scale > 0.0 && std::isfinite(this->Scale)))
  {
    return std::string(ScaleName) + " is not a finite number above 0";
  }
  return error;
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::ReadHidden(vtkImageData* image)
{
  const auto read = [&](const char* name, vtkBlockMask& mask)
  {
    vtkAbstractArray* array = image->GetFieldData()->GetAbstractArray(name);
    if (!array)
    {
      return std::string();
    }
    vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(array);
    const std::string error = numbers ? mask.FromArray(numbers, NumberOfBlocksFor(this->Dimensions))
                                      : std::string("does not hold numbers");
    return error.empty() ? error : std::string("its field data array ") + name + " " + error;
  };
  std::string error = read(HiddenSamplesName, this->HiddenSamples);
  error = error.empty() ? read(HiddenCellsName, this->HiddenCells) : error;
  return error.empty() && this->Association == CellData && !this->HiddenCells.IsEmpty()
    ? std::string(HiddenCellsName) + " is there, but of cell data samples are hidden, not cells"
    : error;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Write(vtkImageData* image) const
{
  Remove(image);
  vtkFieldData* fields = image->GetFieldData();
  const int version = this->HidesAny() || this->HasUnits() ? FormatVersion : 1;
  StoreNumbers<vtkIntArray>(fields, VersionName, &version, 1);
  StoreNumbers<vtkIntArray>(fields, BlockBitsName, &this->BlockBits, 1);
  StoreNumbers<vtkTypeInt64Array>(fields, DimensionsName, this->Dimensions, 3);
  StoreNumbers<vtkDoubleArray>(fields, RangeName, this->Range, 2);
  StoreNumbers<vtkIntArray>(fields, ScalarTypeName, &this->ScalarType, 1);
  StoreNumbers<vtkIntArray>(fields, ComponentName, &this->Component, 1);
  StoreNumbers<vtkIntArray>(fields, AssociationName, &this->Association, 1);
  StoreNumbers<vtkIntArray>(
    fields, ExtentName, this->Extent[0] > this->Extent[1] ? image->GetExtent() : this->Extent, 6);
  StoreNumbers<vtkStringArray>(fields, ArrayNameName, &this->ArrayName, 1);
  if (this->HasUnits())
  {
    StoreNumbers<vtkDoubleArray>(fields, OffsetName, &this->Offset, 1);
    StoreNumbers<vtkDoubleArray>(fields, ScaleName, &this->Scale, 1);
  }
  const auto store = [fields](const char* name, const vtkBlockMask& mask)
  {
    if (!mask.IsEmpty())
    {
      const auto array = mask.ToArray();
      array->SetName(name);
      fields->AddArray(array);
    }
  };
  store(HiddenSamplesName, this->HiddenSamples);
  store(HiddenCellsName, this->HiddenCells);
  this->Stream->SetName(StreamName);
  fields->AddArray(this->Stream);
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::Remove(vtkDataObject* object)
{
  for (const char* name : AllNames)
  {
    object->GetFieldData()->RemoveArray(name);
  }
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
    first[axis] = (kept[2 * axis] - this->Extent[2 * axis]) / 4;
    count[axis] = (dims[axis] + 3) / 4;
  }
  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetNumberOfValues(StreamBytesFor(dims, this->BlockBits));
  this->CopyBlocks(first, count, stream);
  int blocks[3];
  this->GetBlocks(blocks);
  this->HiddenSamples = this->HiddenSamples.Crop(first, count, blocks);
  this->HiddenCells = this->HiddenCells.Crop(first, count, blocks);
  this->SetStream(stream);
  this->SetDimensions(dims);
  this->SetExtent(kept);
}

//------------------------------------------------------------------------------
// A box of blocks, row by row: the blocks of a row lie side by side.
void vtkCompressedVolume::CopyBlocks(
  const int first[3], const int count[3], vtkUnsignedCharArray* target) const
{
  int blocks[3];
  this->GetBlocks(blocks);
  target->Fill(0);
  vtkTypeInt64 end = 0;
  for (vtkTypeInt64 z = first[2]; z < first[2] + count[2]; ++z)
  {
    for (vtkTypeInt64 y = first[1]; y < first[1] + count[1]; ++y)
    {
      const vtkTypeInt64 block = first[0] + blocks[0] * (y + blocks[1] * z);
      AppendBits(this->Stream->GetPointer(0), block * this->BlockBits,
        static_cast<vtkTypeInt64>(count[0]) * this->BlockBits, target->GetPointer(0), end);
    }
  }
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::GetBlocks(int blocks[3]) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    blocks[axis] = this->Dimensions[axis] / 4 + (this->Dimensions[axis] % 4 != 0);
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
// The largest doubles, rounded to float32 in the stream's units, may lie beyond what doubles hold.
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
    this->HiddenSamples = mask;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetHiddenCells(const vtkBlockMask& mask)
{
  if (!(this->HiddenCells == mask))
  {
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
vtkUnsignedCharArray* vtkCompressedVolume::GetStream() const
{
  return this->Stream;
}

//------------------------------------------------------------------------------
void vtkCompressedVolume::SetStream(vtkUnsignedCharArray* stream)
{
  if (this->Stream != stream)
  {
    this->Stream = stream;
    this->Modified();
  }
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
  os << indent << "ScalarType: " << this->ScalarType << "\n";
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "Association: " << (this->Association == CellData ? "cell" : "point")
     << " data\n";
  os << indent << "HiddenSamples: " << this->HiddenSamples.GetRuns().size() << " runs\n";
  os << indent << "HiddenCells: " << this->HiddenCells.GetRuns().size() << " runs\n";
  os << indent << "Stream: ";
  this->Stream ? os << this->Stream->GetNumberOfValues() << " bytes\n" : os << "(none)\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}
