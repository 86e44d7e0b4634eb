// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCompressedVolume.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
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

const char* const AllNames[] = { VersionName, StreamName, BlockBitsName, DimensionsName, RangeName,
  ScalarTypeName, ArrayNameName, ComponentName, AssociationName };

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
  std::fill_n(this->Range, 2, 0.0);
  this->ScalarType = 0;
  this->ArrayName.clear();
  this->Component = 0;
  this->Association = PointData;
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
  return error.empty() ? this->ReadStreamAndName(image) : error;
}

//------------------------------------------------------------------------------
std::string vtkCompressedVolume::ReadNumbers(vtkImageData* image)
{
  vtkFieldData* fields = image->GetFieldData();
  const int most = std::numeric_limits<int>::max();
  int version = 0;
  std::string error = GetInteger(fields, VersionName, 1, most, version);
  if (error.empty() && version != FormatVersion)
  {
    return "it has version " + std::to_string(version) +
      " of the format, this ProgIso reads version 1 (a newer ProgIso wrote it)";
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
std::string vtkCompressedVolume::CheckGeometry(vtkImageData* image) const
{
  vtkTypeInt64 dims[3];
  std::string error = GetIntegers(image->GetFieldData(), DimensionsName, 3, dims);
  if (!error.empty())
  {
    return error;
  }
  const int* extent = image->GetExtent();
  const bool cells = this->Association == CellData;
  std::ostringstream message;
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 expected =
      static_cast<vtkTypeInt64>(extent[2 * axis + 1]) - extent[2 * axis] + (cells ? 0 : 1);
    if (dims[axis] != expected)
    {
      message << DimensionsName << " is " << dims[axis] << " along axis " << axis
              << ", but the image has " << expected << (cells ? " cells" : " points") << " there";
      break;
    }
    if (expected < 2 || expected > std::numeric_limits<int>::max())
    {
      message << "it has " << expected << (cells ? " cells" : " points") << " along axis " << axis
              << ", at least 2 and at most 2^31-1 are needed";
      break;
    }
  }
  return message.str();
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
void vtkCompressedVolume::Write(vtkImageData* image) const
{
  Remove(image);
  vtkFieldData* fields = image->GetFieldData();
  const int version = FormatVersion;
  StoreNumbers<vtkIntArray>(fields, VersionName, &version, 1);
  StoreNumbers<vtkIntArray>(fields, BlockBitsName, &this->BlockBits, 1);
  StoreNumbers<vtkTypeInt64Array>(fields, DimensionsName, this->Dimensions, 3);
  StoreNumbers<vtkDoubleArray>(fields, RangeName, this->Range, 2);
  StoreNumbers<vtkIntArray>(fields, ScalarTypeName, &this->ScalarType, 1);
  StoreNumbers<vtkIntArray>(fields, ComponentName, &this->Component, 1);
  StoreNumbers<vtkIntArray>(fields, AssociationName, &this->Association, 1);
  StoreNumbers<vtkStringArray>(fields, ArrayNameName, &this->ArrayName, 1);
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
  os << indent << "Range: " << this->Range[0] << " " << this->Range[1] << "\n";
  os << indent << "ScalarType: " << this->ScalarType << "\n";
  os << indent << "ArrayName: " << this->ArrayName << "\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "Association: " << (this->Association == CellData ? "cell" : "point")
     << " data\n";
  os << indent << "Stream: ";
  this->Stream ? os << this->Stream->GetNumberOfValues() << " bytes\n" : os << "(none)\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}
