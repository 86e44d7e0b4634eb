// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkZFPReader on files from libzfp, in every mode, with and without header, whole, cut and
// damaged.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkZFPReader.h>

#include <fstream>
#include <functional>

namespace
{
using namespace test;

const std::string Path = testing::TempDir() + "TestZFPReader.zfp";
const char* const FileName = Path.c_str();
const Dims Size = { 33, 9, 6 };

void WriteFile(const std::string& bytes)
{
  std::ofstream(FileName, std::ios::binary) << bytes;
}

//------------------------------------------------------------------------------
// Makes a file of the test samples by libzfp, in the mode that `setMode` sets.
std::string MakeFile(bool header, zfp_type type, int dimensions,
  const std::function<void(zfp_stream*)>& setMode, const Dims& dims = Size)
{
  std::vector<float> values = Samples(dims);
  values.resize(2 * values.size()); // enough for as many doubles
  std::vector<vtkTypeUInt64> words(values.size() + 4096);
  bitstream* bits = stream_open(words.data(), 8 * words.size());
  zfp_stream* zfp = zfp_stream_open(bits);
  zfp_field* field = dimensions == 3 ? zfp_field_3d(values.data(), type, dims[0], dims[1], dims[2])
                                     : zfp_field_2d(values.data(), type, dims[0], dims[1]);
  setMode(zfp);
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

std::string MakeFixedRateFile(bool header, double rate)
{
  return MakeFile(header, zfp_type_float, 3,
    [=](zfp_stream* zfp) { zfp_stream_set_rate(zfp, rate, zfp_type_float, 3, zfp_false); });
}

//------------------------------------------------------------------------------
TEST(ZFPReader, Streams)
{
  for (double rate : { 0.01, 1.03, 2.5, 8.0, 31.99, 32.0 })
  {
    for (bool header : { true, false })
    {
      WriteFile(MakeFixedRateFile(header, rate));
      vtkNew<vtkZFPReader> reader;
      const Errors errors(reader);
      reader->SetFileName(FileName);
      reader->SetRate(rate);
      reader->SetDataSpacing(1.0, 2.0, 0.5);
      reader->SetDataOrigin(-1.0, 0.0, 7.0);
      if (!header)
      {
        reader->SetDataDimensions(Size.data());
      }
      reader->UpdateInformation();
      const int* extent =
        reader->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
      EXPECT_TRUE(extent[1] == 32 && extent[3] == 8 && extent[5] == 5)
        << "whole extent before reading";
      reader->Update();
      EXPECT_TRUE(errors.Texts.empty()) << errors.Describe();

      const Reference reference(Size, Samples(Size), rate);
      vtkNew<vtkCompressedVolume> volume;
      EXPECT_TRUE(volume->Read(reader->GetOutput())) << volume->GetErrorMessage();
      EXPECT_TRUE(reference.Equals(volume->GetStream()))
        << "rate " << rate << ", header " << header;
      const auto range = std::minmax_element(reference.Decoded.begin(), reference.Decoded.end());
      EXPECT_TRUE(volume->GetRange()[0] == *range.first) << volume->GetRange()[0];
      EXPECT_TRUE(volume->GetRange()[1] == *range.second) << volume->GetRange()[1];
      EXPECT_TRUE(reader->GetOutput()->GetSpacing()[2] == 0.5) << "spacing";
      EXPECT_TRUE(reader->GetOutput()->GetOrigin()[2] == 7.0) << "origin";
      EXPECT_EQ(reader->HasReadableHeader(FileName), header);
      EXPECT_EQ(reader->CanReadFile(FileName), 1) << "by its name";
    }
  }
}

//------------------------------------------------------------------------------
void ExpectError(const std::string& bytes, const std::string& words, const Dims& dims = { 0, 0, 0 })
{
  WriteFile(bytes);
  vtkNew<vtkZFPReader> reader;
  const Errors errors(reader);
  reader->SetFileName(FileName);
  reader->SetDataDimensions(dims.data());
  reader->Update();
  reader->Update();
  EXPECT_TRUE(errors.IsOne(words)) << "expected '" << words << "', got " << errors.Describe();
  EXPECT_TRUE(reader->GetOutput()->GetNumberOfPoints() == 0) << words;
}

TEST(ZFPReader, Errors)
{
  const auto rate8 = [](zfp_stream* zfp) { zfp_stream_set_rate(zfp, 8, zfp_type_float, 3, 0); };
  const auto expert = [](zfp_stream* zfp) { zfp_stream_set_params(zfp, 100, 600, 32, -1074); };
  ExpectError(MakeFile(true, zfp_type_float, 3, expert), "expert mode");
  ExpectError(MakeFile(true, zfp_type_float, 3, zfp_stream_set_reversible), "reversible mode");
  ExpectError(
    MakeFile(true, zfp_type_float, 3, [](zfp_stream* zfp) { zfp_stream_set_accuracy(zfp, 0.1); }),
    "fixed accuracy mode");
  ExpectError(
    MakeFile(true, zfp_type_float, 3, [](zfp_stream* zfp) { zfp_stream_set_precision(zfp, 12); }),
    "fixed precision mode");
  ExpectError(MakeFile(true, zfp_type_double, 3, rate8), "3-D double");
  ExpectError(MakeFile(true, zfp_type_float, 2, rate8), "2-D float");
  ExpectError(MakeFile(true, zfp_type_float, 3, rate8, { 9, 1, 6 }), "9 x 1 x 6 samples");
  ExpectError(MakeFixedRateFile(true, 40.0), "rate of 40");

  const std::string whole = MakeFixedRateFile(true, 8.0);
  ExpectError(whole.substr(0, whole.size() - 8), "truncated");
  ExpectError(whole.substr(0, 11), "header");
  ExpectError("", "header");
  ExpectError(whole.substr(0, 12) + std::string(whole.size() - 12, '\xff'), "not finite");

  const std::string bare = MakeFixedRateFile(false, 8.0);
  ExpectError(bare, "does not start with zfp's header");
  ExpectError(bare, "check DataDimensions and Rate", { 33, 9, 9 });
  ExpectError(bare, "check DataDimensions and Rate", { 33, 9, 4 });
  ExpectError(bare, "at least 2 along each axis", { 33, 9, -6 });

  vtkNew<vtkZFPReader> reader;
  const Errors errors(reader);
  reader->SetFileName("no such file.zfp");
  reader->Update();
  EXPECT_TRUE(errors.IsOne("cannot be opened")) << errors.Describe();
}
}
