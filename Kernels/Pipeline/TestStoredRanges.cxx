// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The ranges of blocks that come with a volume are those that the GPU finds, bit for bit, whether
// it has the volume decoded or in a cache.
#include "Pipeline/ProgressivePipeline.h"
#include "Pipeline/TestViews.h"
#include "Shaders/TestWindow.h"
#include "Store/StoredRanges.h"

#include "vtkBlockRanges.h"
#include "vtkCompressedVolume.h"
#include "vtkCompressedVolumeBuilder.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include "Scene/CompressedInput.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace
{
using Size = std::array<int, 3>;
using Field = std::function<float(int, int, int)>;

struct Sampled
{
  Size Dimensions;
  Field Value;
  double Rate;
  bool Masked = false;
  double Offset = 0.0, Scale = 1.0;
};

void Compress(const Sampled& field, vtkCompressedVolume* volume)
{
  const Size& size = field.Dimensions;
  vtkNew<vtkFloatArray> samples;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x)
      {
        samples->InsertNextValue(field.Value(x, y, z));
      }
    }
  }
  vtkNew<vtkUnsignedCharArray> hidden;
  for (vtkIdType i = 0; i < samples->GetNumberOfValues(); ++i)
  {
    hidden->InsertNextValue(field.Masked && (i * 2654435761U % 97 == 0 || i % 4096 < 600));
  }
  vtkNew<vtkCompressedVolumeBuilder> builder;
  vtkNew<vtkImageData> image;
  builder->SetOffset(field.Offset);
  builder->SetScale(field.Scale);
  ASSERT_TRUE(builder->Start(size.data(), field.Rate) &&
    builder->AddSlab(samples, 0, field.Masked ? hidden.Get() : nullptr) && builder->Finish(image))
    << builder->GetErrorMessage();
  ASSERT_TRUE(volume->Read(image)) << volume->GetErrorMessage();
  ASSERT_TRUE(volume->HasRanges());
}

class StoredRanges : public TestWithWindow
{
protected:
  void SetUp() override
  {
    TestWithWindow::SetUp();
    ASSERT_TRUE(this->Pipeline.Initialize(1)) << this->Pipeline.GetStatus().GetMessage();
  }
  void TearDown() override { this->Pipeline.Release(); }

  // The words of all macrocells without what they know of a cache.
  std::vector<std::uint32_t> Load(const PipelineVolume& volume, bool cached)
  {
    this->Pipeline.SetVolume(volume);
    PipelineSettings settings;
    settings.DecodeWholeVolume = !cached;
    PipelineScene scene;
    scene.View = MakeParallelView(16, 16);
    scene.View.ImageSize[0] = scene.View.ImageSize[1] = 16;
    scene.View.WindowSize[0] = scene.View.WindowSize[1] = 16;
    scene.View.NumberOfIsovalues = 1;
    EXPECT_TRUE(this->Pipeline.SetScene(scene, settings, true))
      << this->Pipeline.GetStatus().GetMessage();
    EXPECT_TRUE(this->Pipeline.PrepareVolume([](double) { return true; }))
      << this->Pipeline.GetStatus().GetMessage();
    const std::vector<std::uint32_t> all = this->Pipeline.ReadRanges();
    SceneNeeds needs;
    needs.Cached = cached;
    const std::size_t size = static_cast<std::size_t>(WordsOfMacrocell(needs));
    std::vector<std::uint32_t> words;
    for (std::size_t i = 0; i < all.size(); i += size)
    {
      words.insert(words.end(), all.begin() + i, all.begin() + i + 2);
      words.insert(words.end(), all.begin() + i + size - 32, all.begin() + i + size);
    }
    return words;
  }

  ProgressivePipeline Pipeline;
};

const std::vector<std::pair<std::string, Sampled>>& Volumes()
{
  static std::mt19937 random(11);
  static std::uniform_real_distribution<float> noise(-1.0f, 1.0f);
  const Field any = [](int, int, int) { return noise(random); };
  const Field wave = [](int x, int y, int z)
  { return std::sin(0.2f * x) * std::cos(0.3f * y) + 0.1f * z; };
  const Field steps = [](int x, int y, int z) {
    return x < 40 ? 0.0f : y < 20 ? -3.0f : static_cast<float>(z / 9);
  };
  const Field tiny = [](int x, int y, int z) { return 1e-29f * std::sin(0.4f * (x + y - z)); };
  const Field huge = [](int x, int y, int z) { return 1e38f * std::sin(0.4f * (x + y - z)); };
  static const std::vector<std::pair<std::string, Sampled>> volumes = {
    { "noise at 1", { { 67, 33, 70 }, any, 1.0 } },
    { "noise at 8", { { 64, 64, 16 }, any, 8.0 } },
    { "small", { { 2, 3, 2 }, any, 6.0 } },
    { "a wave at 2", { { 81, 65, 49 }, wave, 2.0 } },
    { "a wave at 13.7", { { 30, 66, 18 }, wave, 13.7 } },
    { "plateaus", { { 130, 40, 70 }, steps, 4.0 } },
    { "nothing", { { 70, 33, 20 }, [](int, int, int) { return 0.0f; }, 1.0 } },
    { "masked noise", { { 66, 50, 40 }, any, 4.0, true } },
    { "masked plateaus", { { 81, 65, 49 }, steps, 2.0, true } },
    { "units", { { 40, 40, 40 }, wave, 8.0, false, 1e5, 1e-3 } },
    { "tiny values", { { 40, 24, 20 }, tiny, 5.0 } },
    { "huge values", { { 40, 24, 20 }, huge, 5.0 } },
  };
  return volumes;
}
}

TEST_F(StoredRanges, AreThoseThatTheGpuFinds)
{
  for (const auto& [name, field] : Volumes())
  {
    vtkNew<vtkCompressedVolume> volume;
    ASSERT_NO_FATAL_FAILURE(Compress(field, volume)) << name;
    const PipelineVolume known = DescribeVolume(volume);
    PipelineVolume unknown = known;
    unknown.Ranges = nullptr;
    for (const bool cached : { false, true })
    {
      const std::vector<std::uint32_t> found = this->Load(unknown, cached);
      EXPECT_GE(this->Pipeline.GetBlocksDecodedAtFirst(), volume->GetNumberOfBlocks());
      const std::vector<std::uint32_t> stored = this->Load(known, cached);
      EXPECT_EQ(this->Pipeline.GetBlocksDecodedAtFirst(), cached ? 0 : volume->GetNumberOfBlocks());
      EXPECT_EQ(found, stored) << name << (cached ? ", cached" : ", whole");
    }
  }
}

// Any bits at all: blocks decode to infinite and subnormal values, too.
TEST_F(StoredRanges, OfDamagedStreamsAreTheSame)
{
  vtkNew<vtkCompressedVolume> volume;
  const Field zero = [](int, int, int) { return 0.0f; };
  Compress({ { 37, 35, 38 }, zero, 3.0 }, volume);
  std::mt19937 random(12);
  for (vtkIdType i = 0; i < volume->GetStream()->GetNumberOfValues(); ++i)
  {
    volume->GetStream()->SetValue(i, static_cast<unsigned char>(random()));
  }
  EXPECT_NE(volume->CheckRanges(), "");
  volume->FindRanges();
  EXPECT_EQ(volume->CheckRanges(), "");
  const PipelineVolume known = DescribeVolume(volume);
  PipelineVolume unknown = known;
  unknown.Ranges = nullptr;
  EXPECT_EQ(this->Load(unknown, true), this->Load(known, true));
}

TEST_F(StoredRanges, TakeNoStageThatFindsThem)
{
  SceneNeeds needs;
  needs.StoredRanges = true;
  EXPECT_FALSE(InfoOf(Stage::BlockRanges).IsNeeded(needs));
  EXPECT_FALSE(InfoOf(Stage::DecodeBlocks).IsNeeded(Moment::Volume, needs));
  EXPECT_TRUE(InfoOf(Stage::DecodeBlocks).IsNeeded(Moment::Pass, needs));
  needs.Cached = false;
  EXPECT_FALSE(InfoOf(Stage::BlockRanges).IsNeeded(needs));
  EXPECT_TRUE(InfoOf(Stage::DecodeBlocks).IsNeeded(Moment::Volume, needs));
}
