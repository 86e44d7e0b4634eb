// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/MemoryPlan.h"

#include "Store/CompressedStream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace
{
constexpr std::int64_t MiB = 1LL << 20;
constexpr std::int64_t GiB = 1LL << 30;

// A volume of samples^3 in an image of 1280x720, lit.
SceneNeeds Scene(int samples)
{
  const int dimensions[3] = { samples, samples, samples };
  const VolumeSize size(dimensions);
  SceneNeeds scene;
  scene.Blocks = size.GetNumberOfBlocks();
  scene.Macrocells = size.GetNumberOfMacrocells();
  scene.Pixels = 1280 * 720;
  scene.Lit = true;
  return scene;
}

DeviceLimits Limits(std::int64_t deviceMemory = 0)
{
  DeviceLimits limits;
  limits.LargestBuffer = 4 * GiB;
  limits.DeviceMemory = deviceMemory;
  return limits;
}

PipelineSettings WithBudget(std::int64_t budget, bool decodeWholeVolume = true)
{
  PipelineSettings settings;
  settings.MemoryBudget = budget;
  settings.DecodeWholeVolume = decodeWholeVolume;
  return settings;
}

std::int64_t BytesWithCache(const SceneNeeds& scene, std::int64_t slots)
{
  return BytesBesideStream(WithCache(scene, slots));
}
}

TEST(MemoryPlan, BudgetThatIsSetIsInForce)
{
  EXPECT_EQ(PlanMemory(Limits(80 * GiB), WithBudget(300 * MiB), Scene(256)).Budget, 300 * MiB);
}

TEST(MemoryPlan, AutomaticBudgetIsAGibibyteOfBlocksOrAQuarterOfTheGPU)
{
  const SceneNeeds scene = Scene(1024);
  const std::int64_t most = BytesWithCache(scene, 0) + GiB;
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(0), scene).Budget, most);
  EXPECT_EQ(PlanMemory(Limits(4 * most), WithBudget(0), scene).Budget, most);
  EXPECT_EQ(PlanMemory(Limits(4 * most - 4), WithBudget(0), scene).Budget, most - 1);
  EXPECT_EQ(PlanMemory(Limits(2 * GiB), WithBudget(0), scene).Budget, GiB / 2);
}

TEST(MemoryPlan, AShareOfTheBudgetIsNeverTooSmall)
{
  const SceneNeeds scene = Scene(1024);
  PipelineSettings settings = WithBudget(GiB);
  settings.MemoryShare = 0.25;
  EXPECT_EQ(PlanMemory(Limits(), settings, scene).Budget, GiB / 4);
  settings.MemoryBudget = 0;
  EXPECT_EQ(PlanMemory(Limits(2 * GiB), settings, scene).Budget, GiB / 8);
  settings.MemoryShare = 1e-9;
  const MemoryPlan plan = PlanMemory(Limits(), settings, scene);
  EXPECT_EQ(plan.Budget, plan.LeastBudget);
  EXPECT_EQ(plan.DescribeExcess(), "");
}

TEST(MemoryPlan, WholeVolumeWhereTheBudgetHasRoom)
{
  const SceneNeeds scene = Scene(256);
  const std::int64_t whole = BytesBesideStream(WithWholeVolume(scene));
  EXPECT_FALSE(PlanMemory(Limits(), WithBudget(whole), scene).Cached);
  EXPECT_TRUE(PlanMemory(Limits(), WithBudget(whole - 1), scene).Cached);
  EXPECT_TRUE(PlanMemory(Limits(), WithBudget(whole, false), scene).Cached);
}

TEST(MemoryPlan, WholeVolumeMustFitOneBuffer)
{
  const SceneNeeds scene = Scene(256);
  DeviceLimits limits = Limits();
  limits.LargestBuffer = 256 * scene.Blocks; // 64 floats a block
  EXPECT_FALSE(PlanMemory(limits, WithBudget(GiB), scene).Cached);
  --limits.LargestBuffer;
  const MemoryPlan plan = PlanMemory(limits, WithBudget(GiB), scene);
  EXPECT_TRUE(plan.Cached);
  EXPECT_EQ(plan.MaximumSlots, scene.Blocks - 1);
}

TEST(MemoryPlan, ColorsDoubleASlotAndHiddenCellsAddToIt)
{
  SceneNeeds scene = Scene(256);
  scene.Colored = true;
  scene.HiddenCells = true;
  DeviceLimits limits = Limits();
  limits.LargestBuffer = (2 * 256 + 16) * 100000;
  EXPECT_EQ(PlanMemory(limits, WithBudget(GiB), scene).MaximumSlots, 100000);
}

TEST(MemoryPlan, CacheFillsTheBudget)
{
  const SceneNeeds scene = Scene(1024);
  for (std::int64_t slots : { 2048, 4096, 4097, 100000, 1000000 })
  {
    const std::int64_t budget = BytesWithCache(scene, slots);
    EXPECT_EQ(PlanMemory(Limits(), WithBudget(budget), scene).MaximumSlots, slots);
    EXPECT_EQ(PlanMemory(Limits(), WithBudget(budget + 255), scene).MaximumSlots, slots);
  }
  const std::int64_t budget = BytesWithCache(scene, 100000);
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(budget - 1), scene).MaximumSlots, 99999);
}

TEST(MemoryPlan, CacheNeverHasMoreSlotsThanBlocks)
{
  const SceneNeeds scene = Scene(64);
  const MemoryPlan plan = PlanMemory(Limits(), WithBudget(8 * GiB, false), scene);
  EXPECT_TRUE(plan.Cached);
  EXPECT_EQ(plan.MaximumSlots, 16 * 16 * 16);
}

TEST(MemoryPlan, LeastBudgetIsJustEnough)
{
  const SceneNeeds scene = Scene(1024);
  const std::int64_t least = PlanMemory(Limits(), WithBudget(GiB), scene).LeastBudget;
  EXPECT_EQ(least, BytesWithCache(scene, 2048));
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(least), scene).MaximumSlots, 2048);
  const MemoryPlan tooSmall = PlanMemory(Limits(), WithBudget(least - 1), scene);
  EXPECT_TRUE(tooSmall.Cached);
  EXPECT_EQ(tooSmall.LeastBudget, least);
  EXPECT_EQ(tooSmall.Wanted, least - 1);
  EXPECT_EQ(tooSmall.Budget, least);
  EXPECT_EQ(tooSmall.MaximumSlots, 2048);
}

TEST(MemoryPlan, TellsThatTheLeastIsTaken)
{
  const SceneNeeds scene = Scene(1024);
  const MemoryPlan plan = PlanMemory(Limits(), WithBudget(3 * MiB / 2), scene);
  const std::string words = plan.DescribeExcess();
  EXPECT_NE(words.find("1.5 MiB"), std::string::npos) << words;
  EXPECT_NE(words.find(std::to_string(plan.LeastBudget) + " bytes"), std::string::npos) << words;
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(GiB), scene).DescribeExcess(), "");
  // a byte too little does not look like enough
  const MemoryPlan tight = PlanMemory(Limits(), WithBudget(plan.LeastBudget - 1), scene);
  const std::string close = tight.DescribeExcess();
  const std::size_t wanted = close.find("budget of ") + 10, taken = close.find("takes ") + 6;
  EXPECT_NE(close.substr(wanted, close.find(" MiB") - wanted),
    close.substr(taken, close.find(" MiB", taken) - taken))
    << close;
  // a GPU with hardly any memory
  EXPECT_NE(PlanMemory(Limits(4 * MiB), WithBudget(0), scene).DescribeExcess(), "");
}

TEST(MemoryPlan, LeastBudgetOfASmallVolumeIsThatOfItsBlocks)
{
  const SceneNeeds scene = Scene(32); // 512 blocks
  const std::int64_t whole = BytesBesideStream(WithWholeVolume(scene));
  const std::int64_t cached = BytesWithCache(scene, 512);
  ASSERT_LT(whole, cached); // rays of a decoded volume need no buffer
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(GiB), scene).LeastBudget, whole);
  EXPECT_FALSE(PlanMemory(Limits(), WithBudget(whole), scene).Cached);
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(GiB, false), scene).LeastBudget, cached);
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(cached, false), scene).MaximumSlots, 512);
  EXPECT_EQ(PlanMemory(Limits(), WithBudget(cached - 1, false), scene).MaximumSlots, 512);
}

TEST(MemoryPlan, MapPagesFollowTheSlots)
{
  const SceneNeeds scene = Scene(1024); // 262144 macrocells
  EXPECT_EQ(WithCache(scene, 2048).MapPages, 512);
  EXPECT_EQ(WithCache(scene, 4096).MapPages, 512);
  EXPECT_EQ(WithCache(scene, 8192).MapPages, 1024);
  EXPECT_EQ(WithCache(scene, 8 * 300000).MapPages, scene.Macrocells);
  EXPECT_EQ(WithCache(Scene(64), 4096).MapPages, 64);
  EXPECT_EQ(WithWholeVolume(scene).MapPages, 0);
  EXPECT_EQ(WithWholeVolume(scene).Slots, scene.Blocks);
}

TEST(MemoryPlan, DoesNotDependOnTheCacheAtHand)
{
  const SceneNeeds scene = Scene(512);
  for (const SceneNeeds& now :
    { WithCache(scene, 16384), WithCache(scene, 500000), WithWholeVolume(scene) })
  {
    const MemoryPlan plan = PlanMemory(Limits(), WithBudget(200 * MiB), now);
    const MemoryPlan expected = PlanMemory(Limits(), WithBudget(200 * MiB), scene);
    EXPECT_EQ(plan.Cached, expected.Cached);
    EXPECT_EQ(plan.MaximumSlots, expected.MaximumSlots);
    EXPECT_EQ(plan.LeastBudget, expected.LeastBudget);
  }
}

namespace
{
// A GPU whose buffers hold 2 GiB less a byte, and are committed by pages of 64 KiB.
DeviceLimits SparseLimits()
{
  DeviceLimits limits = Limits();
  limits.LargestBuffer = 2 * GiB - 1;
  limits.SparseBuffers = true;
  limits.SparsePage = 65536;
  return limits;
}

// Scenes of every kind of slot.
std::vector<SceneNeeds> KindsOfSlots()
{
  std::vector<SceneNeeds> scenes;
  for (const bool colored : { false, true })
  {
    for (const bool hidden : { false, true })
    {
      scenes.push_back(Scene(1024));
      scenes.back().Colored = colored;
      scenes.back().HiddenCells = hidden;
      scenes.back().HiddenWords = hidden ? 30 : 0;
    }
  }
  return scenes;
}
}

TEST(MemoryPlan, AddressesAreReservedOnlyWhereThatHelps)
{
  EXPECT_EQ(WithReservation(Limits(), Scene(1024)).SlotCapacity, 0);
  EXPECT_EQ(WithReservation(SparseLimits(), Scene(160)).SlotCapacity, 0);     // 40^3 blocks
  EXPECT_EQ(WithReservation(SparseLimits(), Scene(164)).SlotCapacity, 69120); // 41^3, rounded up
}

TEST(MemoryPlan, ReservedPartsLieSideBySide)
{
  for (const SceneNeeds& scene : KindsOfSlots())
  {
    const SceneNeeds reserved = WithReservation(SparseLimits(), scene);
    const BufferInfo& values = PipelineBuffers()[static_cast<std::size_t>(Buffer::CacheValues)];
    EXPECT_LE(values.ReservedBytes(reserved), SparseLimits().LargestBuffer);
    for (const std::int64_t slots : { std::int64_t(2048), reserved.SlotCapacity })
    {
      std::int64_t end = 0;
      for (const ByteRange& part : values.Parts(WithCache(reserved, slots)))
      {
        EXPECT_GE(part.Begin, end);
        EXPECT_EQ(part.Begin % 65536, 0);
        EXPECT_EQ(part.Bytes % 65536, 0);
        end = part.Begin + part.Bytes;
      }
      EXPECT_LE(end, values.ReservedBytes(reserved));
    }
  }
}

TEST(MemoryPlan, ReservedMemoryCountsAsItIsCommitted)
{
  const SceneNeeds reserved = WithReservation(SparseLimits(), Scene(1024));
  const std::int64_t few = BytesOf(Lifetime::Cache, WithCache(reserved, 2048));
  EXPECT_GE(few, BytesOf(Lifetime::Cache, WithCache(Scene(1024), 2048)));
  EXPECT_LE(few, BytesOf(Lifetime::Cache, WithCache(Scene(1024), 2048)) + 4 * 65536);
  for (const std::int64_t slots : { 2048, 4097, 100000, 1000000 })
  {
    const std::int64_t budget = BytesBesideStream(WithCache(reserved, slots));
    const MemoryPlan plan = PlanMemory(SparseLimits(), WithBudget(budget), reserved);
    EXPECT_GE(plan.MaximumSlots, slots);
    EXPECT_LE(BytesBesideStream(WithCache(reserved, plan.MaximumSlots)), budget);
  }
}

TEST(MemoryPlan, ReservedCacheGrowsInPlaceToTheMaximum)
{
  const SceneNeeds reserved = WithReservation(SparseLimits(), Scene(1024));
  const MemoryPlan plan = PlanMemory(SparseLimits(), WithBudget(GiB), reserved);
  const CacheGrowth some = PlanGrowth(plan, WithCache(reserved, 2048), 5000);
  EXPECT_TRUE(some.Keeps);
  EXPECT_EQ(some.Slots, 5000);
  const CacheGrowth all = PlanGrowth(plan, WithCache(reserved, 1000000), 100000000);
  EXPECT_TRUE(all.Keeps);
  EXPECT_EQ(all.Slots, plan.MaximumSlots);
}

TEST(MemoryPlan, OtherCacheGrowsWhileTheBudgetHasRoomForACopy)
{
  for (const SceneNeeds& scene : KindsOfSlots())
  {
    const MemoryPlan plan = PlanMemory(Limits(), WithBudget(GiB), scene);
    const std::int64_t half = plan.MaximumSlots / 2;
    const CacheGrowth free = PlanGrowth(plan, WithCache(scene, 16384), 65536);
    EXPECT_TRUE(free.Keeps);
    EXPECT_EQ(free.Slots, 65536);
    // the copied samples stay for a moment: the cache grows less than it is to
    const CacheGrowth less = PlanGrowth(plan, WithCache(scene, half / 2), plan.MaximumSlots);
    EXPECT_TRUE(less.Keeps);
    EXPECT_GT(less.Slots, half);
    EXPECT_LE(
      BytesBesideStream(WithCache(scene, less.Slots)) + BytesPerSlot(scene) * (half / 2), GiB);
    // no room for both: anew, as large as can be
    const CacheGrowth anew = PlanGrowth(plan, WithCache(scene, half), plan.MaximumSlots);
    EXPECT_FALSE(anew.Keeps);
    EXPECT_EQ(anew.Slots, plan.MaximumSlots);
  }
}

TEST(MemoryPlan, NumbersOfBlocksHaveAnEnd)
{
  DeviceLimits limits = Limits();
  limits.LargestBuffer = 1LL << 50;
  SceneNeeds scene = Scene(1024);
  scene.Blocks = 4294967294;
  EXPECT_TRUE(CheckSizes(limits, scene));
  ++scene.Blocks;
  const Status status = CheckSizes(limits, scene);
  EXPECT_FALSE(status);
  EXPECT_EQ(status.GetMessage(),
    "the volume has 4294967295 blocks of 4x4x4 samples, but only 4294967294 can be told apart: "
    "show "
    "a part of it, or fewer samples");
}

TEST(MemoryPlan, MacrocellsMustFitOneBuffer)
{
  const SceneNeeds scene = Scene(1024);
  DeviceLimits limits = Limits();
  limits.LargestBuffer =
    PipelineBuffers()[static_cast<std::size_t>(Buffer::Macrocells)].Bytes(scene);
  EXPECT_TRUE(CheckSizes(limits, scene));
  --limits.LargestBuffer;
  const Status status = CheckSizes(limits, scene);
  EXPECT_FALSE(status);
  EXPECT_NE(
    status.GetMessage().find("262144 cells of 16x16x16 samples, but one GPU buffer can hold "
                             "no more than 262143 here"),
    std::string::npos)
    << status.GetMessage();
}

TEST(MemoryPlan, ABufferTooSmallForTheCacheIsNoSmallBudget)
{
  SceneNeeds scene = Scene(64);
  DeviceLimits limits = Limits();
  limits.LargestBuffer = 2048 * 256;
  EXPECT_TRUE(CheckSizes(limits, scene));
  EXPECT_EQ(PlanMemory(limits, WithBudget(GiB, false), scene).MaximumSlots, 2048);
  --limits.LargestBuffer;
  const Status status = CheckSizes(limits, scene);
  EXPECT_FALSE(status);
  EXPECT_EQ(status.GetMessage(),
    "the smallest cache has 524288 bytes, but one GPU buffer can hold no more than 524287 here: "
    "raise LargestBuffer, or use another GPU");
}

TEST(MemoryPlan, TheSmallestBudgetsAreRaised)
{
  const SceneNeeds scene = Scene(1024);
  for (const std::int64_t budget : { std::int64_t(1), BytesWithCache(scene, 0) - 1 })
  {
    const MemoryPlan plan = PlanMemory(Limits(), WithBudget(budget), scene);
    EXPECT_EQ(plan.MaximumSlots, 2048);
    EXPECT_TRUE(plan.Cached);
  }
}

TEST(MemoryPlan, ImagesHaveJustTheRoomThatTheyNeed)
{
  EXPECT_EQ(RoomForImage(0, 100, 1000, 0.0), 100);
  EXPECT_EQ(RoomForImage(100, 100, 1000, 0.0), 100);
  EXPECT_EQ(RoomForImage(500, 500, 400, 0.0), 400); // of a smaller window
}

TEST(MemoryPlan, LargeImagesHaveRoomForTheirViewport)
{
  EXPECT_EQ(RoomForImage(0, 250, 1000, 0.0), 250);
  EXPECT_EQ(RoomForImage(0, 251, 1000, 0.0), 1000);
  EXPECT_EQ(RoomForImage(1000, 251, 1000, 5000.0), 1000);
}

TEST(MemoryPlan, RoomForImagesGrowsInFewSteps)
{
  std::int64_t room = 10000;
  int steps = 0;
  for (std::int64_t needed = 10000; needed <= 1000000; needed += needed / 50)
  {
    const std::int64_t next = RoomForImage(room, needed, 1000000, 0.0);
    EXPECT_GE(next, needed);
    EXPECT_LE(next, 4 * needed);
    steps += next != room;
    room = next;
  }
  EXPECT_LE(steps, 7);
}

TEST(MemoryPlan, RoomForImagesShrinksAfterAPause)
{
  EXPECT_EQ(RoomForImage(1000, 10, 1000, 0.0), 1000);
  EXPECT_EQ(RoomForImage(1000, 10, 1000, 5000.0), 10);
  EXPECT_EQ(RoomForImage(1000, 500, 1000, 5000.0), 1000); // not twice too large
  EXPECT_EQ(RoomForImage(1000, 0, 1000, 5000.0), 0);
}
