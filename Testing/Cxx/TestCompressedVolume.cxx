// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkCompressedVolume reads what it wrote, and names what is missing, of the wrong type,
// inconsistent, truncated or too large.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkSignedCharArray.h>
#include <vtkTypeInt64Array.h>

#include <limits>

namespace
{
using namespace test;

const Dims Size = { 9, 4, 6 };

//------------------------------------------------------------------------------
TEST(CompressedVolume, Statics)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(8.0) == 512) << "8";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(1.03) == 66) << "rounded";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(1e-9) == 9) << "least";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(32.0) == 2048) << "most";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(32.1) == 0) << "too much";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(0.0) == 0) << "zero";
  EXPECT_TRUE(vtkCompressedVolume::BlockBitsForRate(nan) == 0) << "NaN";

  const int most = std::numeric_limits<int>::max();
  const int small[3] = { 5, 4, 1 };
  const int huge[3] = { most, most, 16 };
  const int impossible[3] = { most, most, most };
  EXPECT_TRUE(vtkCompressedVolume::NumberOfBlocksFor(small) == 2) << "small";
  EXPECT_TRUE(vtkCompressedVolume::StreamBytesFor(small, 33) == 16) << "66 bits";
  EXPECT_TRUE(vtkCompressedVolume::NumberOfBlocksFor(huge) == vtkTypeInt64(1) << 60)
    << "beyond 32 bits";
  EXPECT_TRUE(vtkCompressedVolume::NumberOfBlocksFor(impossible) == -1) << "overflow of blocks";
  EXPECT_TRUE(vtkCompressedVolume::StreamBytesFor(huge, 512) == -1) << "overflow of bits";
}

//------------------------------------------------------------------------------
// Reads a valid volume with one array of its metadata replaced (or, by null, removed).
bool ReadWith(const char* name, vtkAbstractArray* array, const std::string& words)
{
  const auto image = Compress(FloatImage(Size));
  const std::string fullName = std::string("ProgIso.ZFP.") + name;
  image->GetFieldData()->RemoveArray(fullName.c_str());
  if (array)
  {
    array->SetName(fullName.c_str());
    image->GetFieldData()->AddArray(array);
  }
  vtkNew<vtkCompressedVolume> volume;
  const bool read = volume->Read(image);
  if (!read)
  {
    const bool named = volume->GetErrorMessage().find(words) != std::string::npos;
    EXPECT_TRUE(named) << "expected '" << words << "', got: " << volume->GetErrorMessage();
    EXPECT_TRUE(!volume->GetStream() && volume->GetBlockBits() == 0) << "nothing left of it";
  }
  return read;
}

template <typename ArrayT>
vtkSmartPointer<ArrayT> Values(std::initializer_list<typename ArrayT::ValueType> values)
{
  auto array = vtkSmartPointer<ArrayT>::New();
  for (auto value : values)
  {
    array->InsertNextValue(value);
  }
  return array;
}

//------------------------------------------------------------------------------
TEST(CompressedVolume, Rejects)
{
  for (const char* name : { "Version", "BlockBits", "Dimensions", "Range", "ScalarType",
         "ArrayName", "Component", "Association", "Stream" })
  {
    EXPECT_FALSE(ReadWith(name, nullptr, name)) << name << " missing";
    EXPECT_FALSE(ReadWith(name, Values<vtkFloatArray>({ 1.f }), name)) << name << " of wrong type";
  }
  const vtkTypeInt64 beyond = vtkTypeInt64(1) << 62;
  EXPECT_FALSE(ReadWith("Version", Values<vtkIntArray>({ 4 }), "version 4")) << "version";
  EXPECT_FALSE(ReadWith("BlockBits", Values<vtkIntArray>({ 8 }), "BlockBits is 8")) << "too few";
  EXPECT_FALSE(ReadWith("BlockBits", Values<vtkIntArray>({ 2049 }), "BlockBits is 2049"))
    << "too many";
  EXPECT_FALSE(ReadWith("BlockBits", Values<vtkTypeInt64Array>({ beyond + 512 }), "BlockBits"))
    << "64 bits";
  EXPECT_FALSE(ReadWith("BlockBits", Values<vtkIntArray>({ 513 }), "truncated"))
    << "longer than the stream";
  EXPECT_FALSE(ReadWith("Dimensions", Values<vtkIntArray>({ 9, 4 }), "3 integer values")) << "two";
  EXPECT_FALSE(ReadWith("Dimensions", Values<vtkIntArray>({ 9, 4, 7 }), "axis 2"))
    << "not the image's";
  EXPECT_FALSE(ReadWith("Dimensions", Values<vtkTypeInt64Array>({ beyond, 4, 6 }), "axis 0"))
    << "64 bits";
  EXPECT_FALSE(ReadWith("Association", Values<vtkIntArray>({ 1 }), "axis 0")) << "cells are fewer";
  EXPECT_FALSE(ReadWith("Association", Values<vtkIntArray>({ 2 }), "Association is 2"))
    << "association";
  EXPECT_FALSE(ReadWith("Component", Values<vtkIntArray>({ -2 }), "Component is -2"))
    << "component";
  EXPECT_FALSE(ReadWith("ScalarType", Values<vtkIntArray>({ VTK_STRING }), "ScalarType is 13"))
    << "type";
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ReadWith("Range", Values<vtkDoubleArray>({ 0.0, infinity }), "Range")) << "infinite";
  EXPECT_FALSE(ReadWith("Range", Values<vtkDoubleArray>({ 1.0, 0.0 }), "Range")) << "reversed";
  EXPECT_FALSE(ReadWith("Stream", Values<vtkSignedCharArray>({ 0 }), "unsigned char"))
    << "signed stream";
  EXPECT_FALSE(ReadWith("Stream", Values<vtkUnsignedCharArray>({ 0 }), "truncated"))
    << "short stream";
  EXPECT_TRUE(ReadWith("Dimensions", Values<vtkIntArray>({ 9, 4, 6 }), ""))
    << "any integer type will do";
}

//------------------------------------------------------------------------------
// Reads dimensions that agree with an impossible extent, whose sizes must not overflow.
void ExpectRefusedExtent(int low, int high, const std::string& words)
{
  const auto image = Compress(FloatImage(Size));
  const vtkTypeInt64 count = static_cast<vtkTypeInt64>(high) - low + 1;
  const auto dims = Values<vtkTypeInt64Array>({ count, count, count });
  dims->SetName("ProgIso.ZFP.Dimensions");
  image->SetExtent(low, high, low, high, low, high);
  image->GetFieldData()->AddArray(dims);
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_FALSE(volume->Read(image)) << low << " to " << high;
  EXPECT_TRUE(volume->GetErrorMessage().find(words) != std::string::npos)
    << volume->GetErrorMessage();
}

// Reads a stream's extent that has 2 points only if 64-bit integers wrap.
void ExpectRefusedWrapping()
{
  const auto image = Compress(FloatImage(Size));
  const auto dims = Values<vtkTypeInt64Array>({ 2, 2, 2 });
  vtkNew<vtkTypeInt64Array> extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent->InsertNextValue(std::numeric_limits<vtkTypeInt64>::max());
    extent->InsertNextValue(std::numeric_limits<vtkTypeInt64>::min());
  }
  dims->SetName("ProgIso.ZFP.Dimensions");
  extent->SetName("ProgIso.ZFP.Extent");
  image->SetExtent(0, 0, 0, 0, 0, 0);
  image->GetFieldData()->AddArray(dims);
  image->GetFieldData()->AddArray(extent);
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_FALSE(volume->Read(image)) << "wrapping";
  EXPECT_TRUE(volume->GetErrorMessage().find("axis 0") != std::string::npos)
    << volume->GetErrorMessage();
}

// An image without points, or cells, cannot be a part of a stream.
TEST(CompressedVolume, EmptyPieces)
{
  for (const bool cells : { false, true })
  {
    const auto image = Compress(FloatImage(Size, cells));
    const int* extent = image->GetExtent();
    image->SetExtent(
      extent[0], extent[1], extent[2] + 1, extent[2] + (cells ? 1 : 0), extent[4], extent[5]);
    vtkNew<vtkCompressedVolume> volume;
    EXPECT_FALSE(volume->Read(image)) << "empty";
    const char* words = cells ? "no cells along axis 1" : "no points along axis 1";
    EXPECT_TRUE(volume->GetErrorMessage().find(words) != std::string::npos)
      << volume->GetErrorMessage();
  }
}

TEST(CompressedVolume, HugeExtent)
{
  const int most = std::numeric_limits<int>::max(), limit = 1 << 30;
  ExpectRefusedExtent(0, limit, "truncated");
  ExpectRefusedExtent(-limit, limit - 2, "truncated");
  ExpectRefusedExtent(0, most - 1, "beyond");
  ExpectRefusedExtent(most - 8, most, "beyond");
  ExpectRefusedExtent(-most - 1, -most + 8, "beyond");
  ExpectRefusedExtent(-most - 1, most, "2^31-1");
  ExpectRefusedWrapping();
}

//------------------------------------------------------------------------------
TEST(CompressedVolume, ReadAndWrite)
{
  const auto image = Compress(FloatImage(Size), 2.7);
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_TRUE(volume->Read(image)) << volume->GetErrorMessage();
  int blocks[3];
  volume->GetBlocks(blocks);
  EXPECT_TRUE(blocks[0] == 3 && blocks[1] == 1 && blocks[2] == 2) << "blocks";
  EXPECT_TRUE(volume->GetNumberOfBlocks() == 6 && volume->GetBlockBits() == 173) << "bits";

  vtkNew<vtkImageData> other;
  other->CopyStructure(image);
  volume->Write(other);
  vtkNew<vtkCompressedVolume> again;
  EXPECT_TRUE(again->Read(other)) << again->GetErrorMessage();
  EXPECT_TRUE(again->GetStream() == volume->GetStream()) << "the stream is shared";
  vtkCompressedVolume::Remove(other);
  EXPECT_FALSE(vtkCompressedVolume::IsCompressed(other)) << "removed";
  EXPECT_TRUE(vtkCompressedVolume::IsCompressed(image)) << "but not from the original";
  EXPECT_TRUE(!again->Read(nullptr) && !again->GetStream()) << "no image";
  std::ostringstream text;
  volume->Print(text);
  EXPECT_TRUE(text.str().find("BlockBits: 173") != std::string::npos) << text.str();
}

//------------------------------------------------------------------------------
// Whether an image is refused, with some words.
void ExpectRefused(vtkImageData* image, const std::string& words)
{
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_FALSE(volume->Read(image)) << words;
  EXPECT_TRUE(volume->GetErrorMessage().find(words) != std::string::npos)
    << volume->GetErrorMessage();
}

// Field data come along with whatever becomes of an image: another grid is noticed.
TEST(CompressedVolume, RefusesAnotherGrid)
{
  const auto shrunk = Compress(FloatImage({ 9, 9, 9 }));
  shrunk->SetExtent(0, 4, 0, 4, 0, 4);
  shrunk->SetSpacing(1.0, 4.0, 6.0);
  ExpectRefused(shrunk, "moved or resampled");
  const auto resampled = Compress(FloatImage(Size));
  resampled->SetSpacing(0.4, 2.0, 3.0);
  ExpectRefused(resampled, "spacing 0.5 2 3");
  EXPECT_TRUE(vtkCompressedVolume::Place(resampled));
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_TRUE(volume->Read(resampled)) << volume->GetErrorMessage();
  EXPECT_TRUE(volume->Covers(resampled));
}

TEST(CompressedVolume, Place)
{
  EXPECT_FALSE(vtkCompressedVolume::Place(FloatImage(Size))) << "no stream";
  const auto part = Compress(FloatImage({ 9, 9, 9 }));
  part->SetExtent(4, 7, 0, 2, 6, 8);
  EXPECT_FALSE(vtkCompressedVolume::Place(part)) << "a part";
  // other indices at the same places, as files have them that count from 0
  const auto moved = Compress(FloatImage({ 9, 9, 9 }));
  double first[3];
  moved->TransformIndexToPhysicalPoint(5, 0, 7, first);
  moved->SetOrigin(first);
  moved->SetExtent(0, 4, 0, 4, 0, 3);
  vtkNew<vtkCompressedVolume> volume;
  EXPECT_TRUE(volume->Read(moved)) << volume->GetErrorMessage();
  const int expected[6] = { -2, 6, -2, 6, -2, 6 };
  EXPECT_TRUE(std::equal(expected, expected + 6, volume->GetExtent()));
}

//------------------------------------------------------------------------------
// Filters that merge the arrays of two volumes make a third that is neither.
TEST(CompressedVolume, RefusesTwoInOne)
{
  const auto image = Compress(FloatImage(Size));
  const auto other = Values<vtkUnsignedCharArray>({ 1, 2, 3 });
  other->SetName("ProgIso.ZFP.Stream_input_1");
  image->GetFieldData()->AddArray(other);
  ExpectRefused(image, "stream of another volume");
}

//------------------------------------------------------------------------------
TEST(CompressedVolume, BlankingOfTheImageCounts)
{
  for (const bool cells : { false, true })
  {
    const auto image = Compress(FloatImage({ 9, 6, 7 }, cells));
    image->SetExtent(5, 9, -1, 3, 6, 10); // a part, whose indices differ from the stream's
    int cell[3] = { 6, 1, 8 }, point[3] = { 8, 2, 7 };
    image->AllocateCellGhostArray()->SetValue(
      image->ComputeCellId(cell), vtkDataSetAttributes::HIDDENCELL);
    image->AllocatePointGhostArray()->SetValue(
      image->ComputePointId(point), vtkDataSetAttributes::HIDDENPOINT);
    vtkNew<vtkCompressedVolume> volume;
    ASSERT_TRUE(volume->Read(image)) << volume->GetErrorMessage();
    int blocks[3];
    volume->GetBlocks(blocks);
    const vtkBlockMask hidden = volume->GetCellsWithoutSurface();
    const auto hides = [&](int x, int y, int z)
    {
      const int position[3] = { x - 3, y + 2, z - 5 }; // the stream's extent begins at 3, -2, 5
      return hidden.Hides(position, blocks);
    };
    EXPECT_TRUE(hides(6, 1, 8)) << "the cell";
    EXPECT_TRUE(hides(8, 2, 7) && hides(7, 1, 6)) << "cells around the point";
    EXPECT_FALSE(hides(4, 1, 8) || hides(6, 3, 8) || hides(9, 2, 7)) << "others";
  }
}
}
