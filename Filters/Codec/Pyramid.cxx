// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Pyramid.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BlockGeometry.h"
#include "Codec/BlockStream.h"
#include "Codec/LevelFilter.h"
#include "Codec/SampleEncoder.h"
#include "Codec/SliceLoop.h"

#include "vtkArrayDispatch.h"
#include "vtkBlockRanges.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <omp.h>

#include <algorithm>
#include <utility>

namespace
{
/// Samples of the volume that go through the levels at a time, and of a level that are encoded at a
/// time: some MiB, or at least a slab of blocks.
constexpr vtkTypeInt64 SamplesPerStep = vtkTypeInt64(1) << 22;
constexpr vtkTypeInt64 SamplesToEncode = vtkTypeInt64(1) << 20;

//------------------------------------------------------------------------------
// Copies slices of one component of an array, in units of the stream.
struct ReadSlicesWorker
{
  template <typename ArrayT>
  void operator()(ArrayT* array, int component, vtkTypeInt64 first, int width,
    const SampleUnits& units, const HiddenSamples& hidden, int threads,
    std::vector<LevelSlice>& slices) const
  {
    const auto values = vtk::DataArrayValueRange(array);
    const vtkTypeInt64 stride = array->GetNumberOfComponents();
    const vtkTypeInt64 size = static_cast<vtkTypeInt64>(slices.front().Values.size());
    const bool isIdentity = units.IsIdentity();
    ForEachRow(threads, slices, width,
      [&](std::size_t slice, int y, float* samples, unsigned char* flags)
      {
        const vtkTypeInt64 begin =
          first + static_cast<vtkTypeInt64>(slice) * size + static_cast<vtkTypeInt64>(y) * width;
        for (int x = 0; x < width; ++x)
        {
          const auto value = values[(begin + x) * stride + component];
          samples[x] = isIdentity
            ? static_cast<float>(value)
            : static_cast<float>((static_cast<double>(value) - units.Offset) / units.Scale);
        }
        for (int x = 0; x < width && flags; ++x)
        {
          flags[x] = hidden.IsHidden(begin + x, samples[x]);
        }
      });
  }
};
}

//------------------------------------------------------------------------------
// One level: how it is made, and its stream.
class Pyramid::Level
{
public:
  Level(const int dims[3], const LevelShape& shape, int blockBits, int threads)
    : Filter(dims, shape, threads)
    , Shape(shape)
    , BlockBits(blockBits)
    , Threads(threads)
  {
  }

  Status Allocate();
  std::vector<LevelSlice> Add(std::vector<LevelSlice> slices);
  vtkSmartPointer<vtkCompressedVolume> MakeVolume(const SampleUnits& units);

  LevelFilter Filter;

private:
  std::size_t SliceSize() const
  {
    return static_cast<std::size_t>(this->Shape.Dimensions[0]) * this->Shape.Dimensions[1];
  }

  BlockStream GetBlocks()
  {
    return { this->Shape.Dimensions, this->BlockBits, this->Stream->GetPointer(0), this->Threads };
  }

  void Encode(const LevelSlice& slice);
  void EncodeSlabs();
  void AppendHiddenCells();

  LevelShape Shape;
  int BlockBits;
  int Threads;
  vtkNew<vtkUnsignedCharArray> Stream;
  SampleEncoder Encoder;
  vtkBlockMask CellMask;
  int Capacity = 0;                  // slices that are encoded at a time
  vtkNew<vtkFloatArray> Kept;        // slices that are not yet encoded
  std::vector<unsigned char> Hidden; // of these; empty if none is
  std::vector<unsigned char> Cells;
  int InKept = 0;  // slices
  int Encoded = 0; // slabs
};

//------------------------------------------------------------------------------
Status Pyramid::Level::Allocate()
{
  const int* const dims = this->Shape.Dimensions;
  const vtkTypeInt64 bytes = vtkCompressedVolume::StreamBytesFor(dims, this->BlockBits);
  const vtkTypeInt64 slices = SamplesToEncode / static_cast<vtkTypeInt64>(this->SliceSize());
  this->Capacity = BlockSide *
    static_cast<int>(std::clamp<vtkTypeInt64>(slices / BlockSide, 1, BlocksAlong(dims[2])));
  Status status = AllocateArray(this->Stream.Get(), bytes, "a level", dims);
  if (status)
  {
    status = this->Encoder.Allocate(this->GetBlocks());
  }
  return status
    ? AllocateArray(this->Kept.Get(), static_cast<vtkTypeInt64>(this->Capacity * this->SliceSize()),
        "slices of a level", dims)
    : status;
}

//------------------------------------------------------------------------------
std::vector<LevelSlice> Pyramid::Level::Add(std::vector<LevelSlice> slices)
{
  std::vector<LevelSlice> made = this->Filter.Add(std::move(slices));
  for (const LevelSlice& slice : made)
  {
    this->Encode(slice);
  }
  return made;
}

//------------------------------------------------------------------------------
void Pyramid::Level::Encode(const LevelSlice& slice)
{
  const std::size_t size = this->SliceSize(), begin = size * this->InKept;
  const auto keep = [&](const std::vector<unsigned char>& from, std::vector<unsigned char>& to)
  {
    if (!from.empty())
    {
      to.resize(this->Capacity * size);
      std::copy(from.begin(), from.end(), to.begin() + begin);
    }
  };
  std::copy(slice.Values.begin(), slice.Values.end(), this->Kept->GetPointer(begin));
  keep(slice.Hidden, this->Hidden);
  keep(slice.HiddenCells, this->Cells);
  ++this->InKept;
  if (this->InKept == this->Capacity ||
    BlockSide * this->Encoded + this->InKept == this->Shape.Dimensions[2])
  {
    this->EncodeSlabs();
  }
}

//------------------------------------------------------------------------------
void Pyramid::Level::EncodeSlabs()
{
  const int slabs = BlocksAlong(this->InKept);
  BlockStream blocks = this->GetBlocks();
  this->Encoder.Hidden.Flags = this->Hidden.empty() ? nullptr : this->Hidden.data();
  this->Encoder.Hidden.HidingFlags = 0xff;
  this->Encoder.EncodeSlabs(
    blocks, this->Encoded, this->Encoded + slabs, this->Kept, 0, [](double) { return true; });
  this->AppendHiddenCells();
  this->Hidden.clear();
  this->Cells.clear();
  this->InKept = 0;
  this->Encoded += slabs;
}

//------------------------------------------------------------------------------
void Pyramid::Level::AppendHiddenCells()
{
  const int* const dims = this->Shape.Dimensions;
  const vtkTypeInt64 blocks[2] = { BlocksAlong(dims[0]), BlocksAlong(dims[1]) };
  const vtkTypeInt64 number = blocks[0] * blocks[1] * BlocksAlong(this->InKept);
  if (this->Cells.empty())
  {
    this->CellMask.Append(0, number);
    return;
  }
  for (vtkTypeInt64 block = 0; block < number; ++block)
  {
    vtkTypeUInt64 bits = 0;
    for (int i = 0; i < BlockSamples; ++i)
    {
      const vtkTypeInt64 x = BlockSide * (block % blocks[0]) + i % BlockSide;
      const vtkTypeInt64 y =
        BlockSide * (block / blocks[0] % blocks[1]) + i / BlockSide % BlockSide;
      const vtkTypeInt64 z = BlockSide * (block / blocks[0] / blocks[1]) + i / BlockSlice;
      const std::size_t at = this->SliceSize() * z + y * dims[0] + x;
      if (x < dims[0] && y < dims[1] && z < this->InKept && this->Cells[at])
      {
        bits |= vtkTypeUInt64(1) << i;
      }
    }
    this->CellMask.Append(bits);
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkCompressedVolume> Pyramid::Level::MakeVolume(const SampleUnits& units)
{
  const SampleSummary& summary = this->Encoder.GetSummary();
  auto volume = vtkSmartPointer<vtkCompressedVolume>::New();
  volume->SetDimensions(this->Shape.Dimensions);
  volume->SetSteps(this->Shape.Steps);
  volume->SetBlockBits(this->BlockBits);
  volume->SetOffset(units.Offset);
  volume->SetScale(units.Scale);
  volume->SetStoredRange(summary.GetRange()[0], summary.GetRange()[1]);
  volume->SetLargestError(units.Scale * summary.LargestError);
  volume->SetMeanError(units.Scale * summary.GetMeanError());
  volume->SetHiddenSamples(this->Encoder.GetMask());
  volume->SetHiddenCells(this->CellMask);
  volume->SetStream(this->Stream);
  volume->SetRanges(
    this->Encoder.GetRanges().Finish(this->GetBlocks(), volume->GetCellsWithoutSurface()));
  return volume;
}

//------------------------------------------------------------------------------
Pyramid::Pyramid(const int dims[3], int threads)
  : Threads(threads > 0 ? threads : omp_get_max_threads())
{
  std::copy_n(dims, 3, this->Dimensions);
}

//------------------------------------------------------------------------------
Pyramid::~Pyramid() = default;

//------------------------------------------------------------------------------
Status Pyramid::Start(const double spacing[3], int levels, int blockBits)
{
  this->Levels.clear();
  this->Slices = 0;
  const int* dims = this->Dimensions;
  int number = 0;
  const std::vector<LevelShape> shapes = PlanLevels(dims, spacing, levels);
  for (const LevelShape& shape : shapes)
  {
    const int bits = BlockBitsOfLevel(++number, blockBits);
    this->Levels.push_back(std::make_unique<Level>(dims, shape, bits, this->Threads));
    if (Status status = this->Levels.back()->Allocate(); !status)
    {
      return status;
    }
    dims = shape.Dimensions;
  }
  return {};
}

//------------------------------------------------------------------------------
bool Pyramid::AddSlices(vtkDataArray* array, int component, const ProgressCallback& progress)
{
  const vtkTypeInt64 size = static_cast<vtkTypeInt64>(this->Dimensions[0]) * this->Dimensions[1];
  const vtkTypeInt64 count = array->GetNumberOfTuples() / size;
  const vtkTypeInt64 step = std::max<vtkTypeInt64>(BlockSide, SamplesPerStep / size);
  for (vtkTypeInt64 done = 0; done < count && !this->Levels.empty(); done += step)
  {
    const vtkTypeInt64 number = std::min(step, count - done);
    this->Feed(this->ReadSlices(array, component, done * size, static_cast<int>(number)));
    if (!progress(static_cast<double>(done + number) / count))
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
// Copies the next slices, the first of which begins with this tuple of an array.
std::vector<LevelSlice> Pyramid::ReadSlices(
  vtkDataArray* array, int component, vtkTypeInt64 first, int number)
{
  const std::size_t size = static_cast<std::size_t>(this->Dimensions[0]) * this->Dimensions[1];
  std::vector<LevelSlice> slices(number);
  for (LevelSlice& slice : slices)
  {
    slice.Values.resize(size);
    slice.Hidden.resize(this->Hidden.MayHide() ? size : 0);
  }
  ReadSlicesWorker worker;
  const int width = this->Dimensions[0];
  if (!vtkArrayDispatch::Dispatch::Execute(
        array, worker, component, first, width, this->Units, this->Hidden, this->Threads, slices))
  {
    worker(array, component, first, width, this->Units, this->Hidden, this->Threads, slices);
  }
  for (LevelSlice& slice : slices)
  {
    ClearUnlessAny(slice.Hidden);
    this->HideCells(this->Slices++, slice);
  }
  return slices;
}

//------------------------------------------------------------------------------
void Pyramid::Feed(std::vector<LevelSlice> slices)
{
  for (const std::unique_ptr<Level>& level : this->Levels)
  {
    slices = level->Add(std::move(slices));
  }
}

//------------------------------------------------------------------------------
// Flags the volume's hidden cells behind slice z.
void Pyramid::HideCells(int z, LevelSlice& slice) const
{
  if (this->HiddenCells.IsEmpty())
  {
    return;
  }
  const int* const dims = this->Dimensions;
  const vtkTypeInt64 blocks[2] = { BlocksAlong(dims[0]), BlocksAlong(dims[1]) };
  slice.HiddenCells.resize(slice.Values.size());
  bool any = false;
  for (int y = 0; y < dims[1]; ++y)
  {
    for (int x = 0; x < dims[0]; x += BlockSide)
    {
      const vtkTypeUInt64 bits = this->HiddenCells.Get(
        x / BlockSide + blocks[0] * (y / BlockSide + blocks[1] * (z / BlockSide)));
      const int first = BlockSide * (y % BlockSide) + BlockSlice * (z % BlockSide);
      any = any || bits != 0;
      for (int i = 0; i < BlockSide && x + i < dims[0] && bits != 0; ++i)
      {
        slice.HiddenCells[static_cast<std::size_t>(y) * dims[0] + x + i] = bits >> (first + i) & 1;
      }
    }
  }
  if (!any)
  {
    slice.HiddenCells.clear();
  }
}

//------------------------------------------------------------------------------
std::vector<vtkSmartPointer<vtkCompressedVolume>> Pyramid::Finish()
{
  std::vector<vtkSmartPointer<vtkCompressedVolume>> volumes;
  double distance = 0.0;
  for (const std::unique_ptr<Level>& level : this->Levels)
  {
    volumes.push_back(level->MakeVolume(this->Units));
    // A level's interpolant at the samples of the one before, whose own interpolant is off, too.
    distance += this->Units.Scale * level->Filter.GetLargestDistance();
    volumes.back()->SetLargestDistance(distance + volumes.back()->GetLargestError());
  }
  return volumes;
}

//------------------------------------------------------------------------------
int Pyramid::GetMostSlicesKept() const
{
  int most = 0;
  for (const std::unique_ptr<Level>& level : this->Levels)
  {
    most = std::max(most, level->Filter.GetMostSlicesKept());
  }
  return most;
}
