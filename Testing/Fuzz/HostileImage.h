// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A compressed volume from a fuzzer's bytes: valid, except for some of its arrays.
#ifndef HostileImage_h
#define HostileImage_h

#include "FuzzTools.h"

#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkTypeUInt64Array.h>
#include <vtkVariant.h>

namespace fuzz
{
// The arrays of a compressed volume, and the number of values of each.
struct FieldArray
{
  const char* Name;
  int Size;
};
const FieldArray FieldArrays[] = { { "ProgIso.ZFP.Version", 1 }, { "ProgIso.ZFP.BlockBits", 1 },
  { "ProgIso.ZFP.Dimensions", 3 }, { "ProgIso.ZFP.Range", 2 }, { "ProgIso.ZFP.ScalarType", 1 },
  { "ProgIso.ZFP.ArrayName", 1 }, { "ProgIso.ZFP.Component", 1 }, { "ProgIso.ZFP.Association", 1 },
  { "ProgIso.ZFP.Extent", 6 }, { "ProgIso.ZFP.Grid", 15 }, { "ProgIso.ZFP.Stream", 1 },
  { "ProgIso.ZFP.Offset", 1 }, { "ProgIso.ZFP.Scale", 1 }, { "ProgIso.ZFP.HiddenSamples", 2 },
  { "ProgIso.ZFP.HiddenCells", 2 }, { "ProgIso.ZFP.PageChecksums", 1 },
  { "ProgIso.ZFP.MetadataChecksum", 1 } };
constexpr int NumberOfFieldArrays = sizeof(FieldArrays) / sizeof(*FieldArrays);

const int ArrayTypes[] = { VTK_INT, VTK_DOUBLE, VTK_LONG_LONG, VTK_UNSIGNED_CHAR, VTK_FLOAT,
  VTK_CHAR, VTK_SIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_UNSIGNED_INT,
  VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_BIT, VTK_STRING, VTK_VARIANT };
constexpr int NumberOfArrayTypes = sizeof(ArrayTypes) / sizeof(*ArrayTypes);

// Returns dimensions small enough for thousands of runs a second.
constexpr vtkIdType MostSamples = 6000;

//------------------------------------------------------------------------------
inline void SetValue(vtkAbstractArray* array, vtkIdType index, Bytes& bytes)
{
  const int type = array->GetDataType();
  const vtkVariant value = type == VTK_FLOAT || type == VTK_DOUBLE ? vtkVariant(bytes.Number())
                                                                   : vtkVariant(bytes.Integer());
  array->SetVariantValue(index, value);
}

//------------------------------------------------------------------------------
// Makes an array of another type, or with another number of values, or both.
inline void ReplaceArray(vtkFieldData* fields, const FieldArray& which, Bytes& bytes)
{
  const int type = ArrayTypes[bytes.Below(NumberOfArrayTypes)];
  const auto array = vtkSmartPointer<vtkAbstractArray>::Take(vtkAbstractArray::CreateArray(type));
  const int count = bytes.Flag() ? which.Size : bytes.Below(9);
  array->SetName(which.Name);
  array->SetNumberOfComponents(bytes.Flag() ? 1 : 1 + bytes.Below(4));
  array->SetNumberOfTuples(count / array->GetNumberOfComponents());
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    SetValue(array, i, bytes);
  }
  fields->AddArray(array);
}

//------------------------------------------------------------------------------
inline void DamageStream(vtkUnsignedCharArray* stream, Bytes& bytes)
{
  const vtkIdType size = stream->GetNumberOfValues();
  if (bytes.Flag())
  {
    stream->SetNumberOfValues(std::max<vtkIdType>(size - bytes.Below(64), 0));
    return;
  }
  // at an odd address, as memory of a NumPy array may be
  const int offset = bytes.Below(8);
  auto* const memory = static_cast<unsigned char*>(std::malloc(size + offset));
  std::memcpy(memory + offset, stream->GetPointer(0), size);
  const auto release = [](void* pointer)
  {
    auto* const address = static_cast<unsigned char*>(pointer);
    std::free(address - reinterpret_cast<std::uintptr_t>(address) % 8);
  };
  stream->SetArray(memory + offset, size, 0, vtkUnsignedCharArray::VTK_DATA_ARRAY_USER_DEFINED);
  stream->SetArrayFreeFunction(release);
}

//------------------------------------------------------------------------------
inline void DamageOne(vtkImageData* image, Bytes& bytes)
{
  vtkFieldData* fields = image->GetFieldData();
  const FieldArray& which = FieldArrays[bytes.Below(NumberOfFieldArrays)];
  vtkAbstractArray* array = fields->GetAbstractArray(which.Name);
  auto* const stream = vtkArrayDownCast<vtkUnsignedCharArray>(array);
  const int kind = bytes.Below(8);
  if (kind == 0)
  {
    fields->RemoveArray(which.Name);
  }
  else if (kind == 1 || !array)
  {
    ReplaceArray(fields, which, bytes);
  }
  else if (stream && stream->GetNumberOfValues() > 8)
  {
    DamageStream(stream, bytes);
  }
  else if (array->GetNumberOfValues() > 0)
  {
    SetValue(array, bytes.Below(static_cast<int>(array->GetNumberOfValues())), bytes);
  }
}

//------------------------------------------------------------------------------
// Makes runs of blocks as in vtkBlockMask, sometimes in disorder or beyond the last block.
inline void AddHidden(vtkFieldData* fields, const char* name, vtkTypeInt64 blocks, Bytes& bytes)
{
  vtkNew<vtkTypeUInt64Array> runs;
  runs->SetName(name);
  runs->SetNumberOfComponents(2);
  vtkTypeUInt64 first = 0;
  for (int i = bytes.Below(6); i >= 0 && first < static_cast<vtkTypeUInt64>(blocks); --i)
  {
    const vtkTypeUInt64 kinds[] = { 0, ~vtkTypeUInt64(0), 1, bytes.Take<vtkTypeUInt64>() };
    runs->InsertNextValue(first);
    runs->InsertNextValue(kinds[bytes.Below(4)]);
    first += 1 + bytes.Below(8);
  }
  fields->AddArray(runs);
}

//------------------------------------------------------------------------------
// Makes ghost flags, of which there may be more or fewer than cells.
inline void AddGhosts(vtkDataSetAttributes* attributes, vtkIdType number, Bytes& bytes)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  const vtkIdType cells = std::min<vtkIdType>(std::max<vtkIdType>(number, 0), 8192);
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(std::max<vtkIdType>(cells + bytes.Take<std::int8_t>() % 3, 0));
  ghosts->Fill(bytes.Flag() ? vtkDataSetAttributes::DUPLICATECELL : 0);
  for (int i = bytes.Below(8); i > 0 && ghosts->GetNumberOfValues() > 0; --i)
  {
    const vtkIdType at = bytes.Take<std::uint16_t>() % ghosts->GetNumberOfValues();
    ghosts->SetValue(at, static_cast<unsigned char>(bytes.Byte()));
  }
  attributes->AddArray(ghosts);
}

//------------------------------------------------------------------------------
inline void SetGeometry(vtkImageData* image, Bytes& bytes)
{
  double direction[9], spacing[3], origin[3];
  std::generate_n(direction, 9, [&]() { return bytes.Number(); });
  std::generate_n(spacing, 3, [&]() { return bytes.Number(); });
  std::generate_n(origin, 3, [&]() { return bytes.Number(); });
  image->SetDirectionMatrix(direction);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
}

//------------------------------------------------------------------------------
template <typename ArrayT, typename T>
void AddArray(vtkFieldData* fields, const char* name, const T* values, int count)
{
  vtkNew<ArrayT> array;
  array->SetName(name);
  for (int i = 0; i < count; ++i)
  {
    array->InsertNextValue(values[i]);
  }
  fields->AddArray(array);
}

//------------------------------------------------------------------------------
inline vtkSmartPointer<vtkImageData> HostileImage(Bytes& bytes)
{
  // first the properties of the image and its parts, then sizes
  const int kinds = bytes.Byte();
  const int association = kinds & 1;
  int dims[3], extent[6];
  std::generate_n(dims, 3, [&]() { return 2 + bytes.Below(bytes.Byte() < 240 ? 20 : 2048); });
  while (static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2] > MostSamples)
  {
    int& longest = *std::max_element(dims, dims + 3);
    longest = std::max(longest / 2, 2);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto start = static_cast<int>(kinds & 2 ? bytes.Integer() : 0);
    const vtkTypeInt64 end = static_cast<vtkTypeInt64>(start) + dims[axis] - 1 + association;
    extent[2 * axis] = start;
    extent[2 * axis + 1] =
      static_cast<int>(std::min<vtkTypeInt64>(end, std::numeric_limits<int>::max()));
  }
  // version 1 has neither masks nor units
  const int hidden = bytes.Below(8), version = 1 + (hidden != 0), blockBits = 9 + bytes.Below(2040),
            type = VTK_FLOAT, component = 0;
  const double range[2] = { -1.0, 1.0 };
  const vtkStdString name = "density";
  auto image = vtkSmartPointer<vtkImageData>::New();
  vtkFieldData* fields = image->GetFieldData();
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.Version", &version, 1);
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.BlockBits", &blockBits, 1);
  AddArray<vtkTypeInt64Array>(fields, "ProgIso.ZFP.Dimensions", dims, 3);
  AddArray<vtkDoubleArray>(fields, "ProgIso.ZFP.Range", range, 2);
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.ScalarType", &type, 1);
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.Component", &component, 1);
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.Association", &association, 1);
  AddArray<vtkIntArray>(fields, "ProgIso.ZFP.Extent", extent, 6);
  AddArray<vtkStringArray>(fields, "ProgIso.ZFP.ArrayName", &name, 1);
  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetName("ProgIso.ZFP.Stream");
  stream->SetNumberOfValues(vtkCompressedVolume::StreamBytesFor(dims, blockBits));
  fields->AddArray(stream);
  const vtkTypeInt64 blocks = vtkCompressedVolume::NumberOfBlocksFor(dims);
  if (hidden & 1)
  {
    AddHidden(fields, "ProgIso.ZFP.HiddenSamples", blocks, bytes);
  }
  if (hidden & 2)
  {
    AddHidden(fields, "ProgIso.ZFP.HiddenCells", blocks, bytes);
  }
  if (hidden & 4)
  {
    const double offset = bytes.Number(), scale = std::abs(bytes.Number());
    AddArray<vtkDoubleArray>(fields, "ProgIso.ZFP.Offset", &offset, 1);
    AddArray<vtkDoubleArray>(fields, "ProgIso.ZFP.Scale", &scale, 1);
  }
  if (kinds & 4) // a piece: the stream covers more than the image
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const vtkTypeInt64 start =
        static_cast<vtkTypeInt64>(extent[2 * axis]) + bytes.Below(dims[axis]);
      const vtkTypeInt64 end =
        static_cast<vtkTypeInt64>(extent[2 * axis + 1]) - bytes.Below(dims[axis]);
      const vtkTypeInt64 most = std::numeric_limits<int>::max();
      extent[2 * axis] = static_cast<int>(std::min(start, most));
      extent[2 * axis + 1] =
        static_cast<int>(std::max(end, start - 1)); // the least that VTK allows
    }
  }
  image->SetExtent(extent);
  if (kinds & 8)
  {
    SetGeometry(image, bytes);
  }
  if (kinds & 16)
  {
    AddGhosts(image->GetCellData(), image->GetNumberOfCells(), bytes);
  }
  const int damages = kinds / 32;
  for (int i = 0; i < damages; ++i)
  {
    DamageOne(image, bytes);
  }
  if (auto* left =
        vtkArrayDownCast<vtkUnsignedCharArray>(fields->GetAbstractArray("ProgIso.ZFP.Stream")))
  {
    bytes.Fill(left->GetPointer(0), left->GetNumberOfValues());
  }
  return image;
}
}

#endif
