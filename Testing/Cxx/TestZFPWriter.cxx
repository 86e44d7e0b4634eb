// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkZFPWriter against files from libzfp: header, then the field, in one bit stream.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkZFPWriter.h>

#include <fstream>
#include <iterator>

namespace
{
using namespace test;

std::string Contents(const char* fileName)
{
  std::ifstream file(fileName, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

//------------------------------------------------------------------------------
std::string Expected(const Dims& dims, std::vector<float> values, double rate, bool header)
{
  std::vector<vtkTypeUInt64> words(Product(dims) + 4096);
  bitstream* bits = stream_open(words.data(), 8 * words.size());
  zfp_stream* zfp = zfp_stream_open(bits);
  zfp_field* field = zfp_field_3d(values.data(), zfp_type_float, dims[0], dims[1], dims[2]);
  zfp_stream_set_rate(zfp, rate, zfp_type_float, 3, zfp_false);
  if (header)
  {
    zfp_write_header(zfp, field, ZFP_HEADER_FULL);
  }
  const size_t size = zfp_compress(zfp, field);
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(bits);
  return std::string(reinterpret_cast<const char*>(words.data()), size);
}

//------------------------------------------------------------------------------
std::string InTemporaryFolder(const char* name)
{
  return testing::TempDir() + name;
}

TEST(ZFPWriter, Files)
{
  const std::string path = InTemporaryFolder("TestZFPWriter.zfp");
  const char* const fileName = path.c_str();
  const Dims shapes[] = { { 2, 2, 2 }, { 9, 4, 6 }, { 33, 65, 31 } };
  for (const Dims& dims : shapes)
  {
    for (double rate : { 0.01, 1.03, 8.0, 32.0 })
    {
      for (bool header : { true, false })
      {
        vtkNew<vtkZFPWriter> writer;
        writer->SetFileName(fileName);
        writer->SetInputData(Compress(FloatImage(dims), rate));
        writer->SetWriteHeader(header);
        EXPECT_TRUE(writer->Write() == 1) << "written";
        EXPECT_TRUE(Contents(fileName) == Expected(dims, Samples(dims), rate, header))
          << dims[0] << " wide at rate " << rate << (header ? " with" : " without") << " header";
      }
    }
  }
}

//------------------------------------------------------------------------------
void ExpectError(vtkImageData* image, const char* fileName, const std::string& words)
{
  vtkNew<vtkZFPWriter> writer;
  const Errors errors(writer);
  writer->SetInputData(image);
  writer->SetFileName(fileName);
  EXPECT_TRUE(writer->Write() == 0) << words;
  EXPECT_TRUE(errors.IsOne(words)) << "expected '" << words << "', got " << errors.Describe();
}

TEST(ZFPWriter, Errors)
{
  const auto plain = FloatImage({ 4, 4, 4 });
  const std::string none = InTemporaryFolder("TestZFPWriterPlain.zfp");
  ExpectError(plain, none.c_str(), "not a valid compressed volume");
  EXPECT_FALSE(std::ifstream(none)) << "no file is made";
  const auto compressed = Compress(plain);
  ExpectError(compressed, nullptr, "FileName");
  ExpectError(compressed, "no such folder/a.zfp", "Cannot open");
  const std::string tooLong = InTemporaryFolder("TestZFPWriterLong.zfp");
  ExpectError(Compress(FloatImage({ 2, 65537, 2 })), tooLong.c_str(), "65536");
}
}
