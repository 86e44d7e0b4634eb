// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "BlockRangeFinder.h"

#include "Codec/ArrayMemory.h"
#include "Codec/BlockLoop.h"
#include "Codec/SampleSummary.h"

#include "vtkBlockMask.h"
#include "vtkBlockRanges.h"
#include "vtkTypeUInt32Array.h"

#include <algorithm>

namespace
{
using RangeSteps::KeyOf;
using RangeSteps::KeyRange;

constexpr int Corners = 8;
constexpr int LoadedSide =
  RangeLayout::Side + 1; // blocks on an axis that a macrocell's cells reach
constexpr int MostSamples =
  BlockSide * LoadedSide * BlockSide * LoadedSide * BlockSide * LoadedSide;

//------------------------------------------------------------------------------
// Ranges of samples with the same x, of rows of a whole block: four at a time.
struct RowRange
{
  vtkTypeInt32 Low[BlockSide];
  vtkTypeInt32 High[BlockSide];

  void Set(const vtkTypeInt32 keys[])
  {
    std::copy_n(keys, BlockSide, this->Low);
    std::copy_n(keys, BlockSide, this->High);
  }
  void Add(const vtkTypeInt32 low[], const vtkTypeInt32 high[])
  {
    for (int x = 0; x < BlockSide; ++x)
    {
      this->Low[x] = std::min(this->Low[x], low[x]);
      this->High[x] = std::max(this->High[x], high[x]);
    }
  }
  void AddRows(const vtkTypeInt32 keys[], int first, int step, int last)
  {
    for (int row = first; row < last; row += step)
    {
      this->Add(keys + BlockSide * row, keys + BlockSide * row);
    }
  }
  KeyRange GetFirst() const { return { this->Low[0], this->High[0] }; }
  KeyRange GetAll() const
  {
    return { *std::min_element(this->Low, this->Low + BlockSide),
      *std::max_element(this->High, this->High + BlockSide) };
  }
};

//------------------------------------------------------------------------------
// As FindSides(), of a whole block.
void FindSidesOfWhole(const float decoded[], KeyRange sides[Corners])
{
  vtkTypeInt32 keys[BlockSamples];
  std::transform(decoded, decoded + BlockSamples, keys, KeyOf);
  RowRange ofFirst, ofY, ofZ, ofAll;
  ofFirst.Set(keys);
  ofZ = ofY = ofFirst;
  ofZ.AddRows(keys, 1, 1, BlockSide);
  ofY.AddRows(keys, BlockSide, BlockSide, BlockSlice);
  ofAll = ofZ;
  ofAll.AddRows(keys, BlockSide, 1, BlockSlice);
  const RowRange* const rows[] = { &ofAll, &ofY, &ofZ, &ofFirst };
  for (int side = 0; side < 4; ++side)
  {
    sides[2 * side] = rows[side]->GetAll();
    sides[2 * side + 1] = rows[side]->GetFirst();
  }
}

//------------------------------------------------------------------------------
// What a block adds to the range of the block that lies before it along the axes of each set of
// axes, bit 0 for x: all of its samples, and those that are the first along these axes.
void FindSides(const BlockStream::Block& block, const float decoded[], KeyRange sides[Corners])
{
  if (block.IsWhole())
  {
    FindSidesOfWhole(decoded, sides);
    return;
  }
  for (int z = 0; z < block.Size[2]; ++z)
  {
    for (int y = 0; y < block.Size[1]; ++y)
    {
      const float* const samples = decoded + BlockSide * y + BlockSlice * z;
      const KeyRange first = { KeyOf(samples[0]), KeyOf(samples[0]) };
      KeyRange row = first;
      for (int x = 1; x < block.Size[0]; ++x)
      {
        row.Add(KeyOf(samples[x]));
      }
      const int side = (y == 0 ? 2 : 0) | (z == 0 ? 4 : 0);
      for (int axes = 0; axes < Corners; axes += 2)
      {
        if ((axes & side) == axes)
        {
          sides[axes].Add(row);
          sides[axes | 1].Add(first);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
vtkTypeUInt32 FlagsOf(const KeyRange& page)
{
  return page.IsEmpty()     ? vtkBlockRanges::EmptyPage
    : page.Low == page.High ? vtkBlockRanges::ConstantPage
                            : 0;
}

//------------------------------------------------------------------------------
// A box of decoded blocks, and the volume's last samples in it.
struct DecodedBox
{
  float Samples[MostSamples];
  vtkTypeInt64 First[3]; // sample
  vtkTypeInt64 Last[3];
  vtkTypeInt64 Row, Slice;

  vtkTypeInt32 KeyAt(const vtkTypeInt64 sample[3]) const
  {
    return KeyOf(this->Samples[sample[0] - this->First[0] +
      this->Row * (sample[1] - this->First[1]) + this->Slice * (sample[2] - this->First[2])]);
  }

  void Decode(const BlockStream& blocks, const vtkTypeInt64 macrocell[3])
  {
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      first[axis] = static_cast<int>(RangeLayout::Side * macrocell[axis]);
      last[axis] = static_cast<int>(
        std::min<vtkTypeInt64>(first[axis] + LoadedSide, blocks.GetBlocks()[axis]));
      this->First[axis] = BlockSide * static_cast<vtkTypeInt64>(first[axis]);
      this->Last[axis] = blocks.GetDimensions()[axis] - 1;
    }
    this->Row = BlockSide * static_cast<vtkTypeInt64>(last[0] - first[0]);
    this->Slice = BlockSide * this->Row * (last[1] - first[1]);
    blocks.DecodeBox(first, last, this->Samples);
  }

  void AddCell(const vtkTypeInt64 cell[3], KeyRange& range) const
  {
    for (int corner = 0; corner < Corners; ++corner)
    {
      const vtkTypeInt64 sample[3] = { cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
        cell[2] + (corner >> 2) };
      range.Add(this->KeyAt(sample));
    }
  }

  // The range of the corners of a block's cells that are not hidden.
  KeyRange FindVisible(const vtkTypeInt64 block[3], vtkTypeUInt64 hidden) const
  {
    KeyRange range;
    for (int i = 0; i < BlockSamples; ++i)
    {
      const vtkTypeInt64 cell[3] = { BlockSide * block[0] + i % BlockSide,
        BlockSide * block[1] + i / BlockSide % BlockSide, BlockSide * block[2] + i / BlockSlice };
      const bool isCell =
        cell[0] < this->Last[0] && cell[1] < this->Last[1] && cell[2] < this->Last[2];
      if (isCell && !(hidden >> i & 1))
      {
        this->AddCell(cell, range);
      }
    }
    return range;
  }
};
}

//------------------------------------------------------------------------------
void BlockRangeFinder::Accumulator::Extend(const KeyRange& range)
{
  constexpr auto relaxed = std::memory_order_relaxed;
  vtkTypeInt32 low = this->Low.load(relaxed);
  while (range.Low < low && !this->Low.compare_exchange_weak(low, range.Low, relaxed))
  {
  }
  vtkTypeInt32 high = this->High.load(relaxed);
  while (range.High > high && !this->High.compare_exchange_weak(high, range.High, relaxed))
  {
  }
}

//------------------------------------------------------------------------------
BlockRangeFinder::BlockRangeFinder(const BlockStream& blocks)
  : Threads(blocks.GetNumberOfThreads())
{
  const vtkTypeInt64* const dims = blocks.GetDimensions();
  const int samples[3] = { static_cast<int>(dims[0]), static_cast<int>(dims[1]),
    static_cast<int>(dims[2]) };
  this->Layout = RangeLayout(samples);
}

//------------------------------------------------------------------------------
// Records have room for the steps of all macrocells at first.
Status BlockRangeFinder::Allocate()
{
  const vtkTypeInt64 words = this->Layout.GetNumberOfPages() +
    (1 + RangeRecords::WordsOfSteps) * this->Layout.GetNumberOfMacrocells();
  return AllocateArray(
    this->Records.Get(), words, "the ranges of blocks", this->Layout.GetDimensions());
}

//------------------------------------------------------------------------------
void BlockRangeFinder::OpenSlabs(vtkTypeInt64 last)
{
  const vtkTypeInt64* const blocks = this->Layout.GetBlocks();
  while (this->FirstSlab + static_cast<vtkTypeInt64>(this->Slabs.size()) < last)
  {
    this->Slabs.push_back(std::make_unique<Accumulator[]>(blocks[0] * blocks[1]));
  }
}

//------------------------------------------------------------------------------
BlockRangeFinder::Accumulator& BlockRangeFinder::At(const vtkTypeInt64 block[3])
{
  return this->Slabs[static_cast<std::size_t>(block[2] - this->FirstSlab)]
                    [block[0] + this->Layout.GetBlocks()[0] * block[1]];
}

//------------------------------------------------------------------------------
void BlockRangeFinder::Add(const BlockStream::Block& block, const float decoded[])
{
  KeyRange sides[Corners];
  FindSides(block, decoded, sides);
  for (int axes = 0; axes < Corners; ++axes)
  {
    const vtkTypeInt64 before[3] = { block.Position[0] - (axes & 1),
      block.Position[1] - (axes >> 1 & 1), block.Position[2] - (axes >> 2) };
    if (*std::min_element(before, before + 3) >= 0)
    {
      this->At(before).Extend(sides[axes]);
    }
  }
}

//------------------------------------------------------------------------------
// The last slab of a layer of macrocells waits for the first of the next.
void BlockRangeFinder::CloseSlabs()
{
  const auto open = static_cast<vtkTypeInt64>(this->Slabs.size());
  const vtkTypeInt64 last = this->FirstSlab + open;
  const bool isEnd = last == this->Layout.GetBlocks()[2];
  const vtkTypeInt64 layers = isEnd ? (open + RangeLayout::Side - 1) / RangeLayout::Side
                                    : std::max<vtkTypeInt64>(open - 1, 0) / RangeLayout::Side;
  const vtkTypeInt64 first = this->FirstSlab / RangeLayout::Side;
  this->CloseLayers(first, first + layers);
  const vtkTypeInt64 closed = std::min(RangeLayout::Side * layers, open);
  this->Slabs.erase(this->Slabs.begin(), this->Slabs.begin() + closed);
  this->FirstSlab += closed;
}

//------------------------------------------------------------------------------
void BlockRangeFinder::CloseLayers(vtkTypeInt64 first, vtkTypeInt64 last)
{
  const vtkTypeInt64* const count = this->Layout.GetMacrocells();
#pragma omp parallel for schedule(dynamic) num_threads(this->Threads)
  for (vtkTypeInt64 row = first * count[1]; row < last * count[1]; ++row)
  {
    for (vtkTypeInt64 x = 0; x < count[0]; ++x)
    {
      const vtkTypeInt64 macrocell[3] = { x, row % count[1], row / count[1] };
      this->CloseMacrocell(macrocell);
    }
  }
}

//------------------------------------------------------------------------------
void BlockRangeFinder::CloseMacrocell(const vtkTypeInt64 macrocell[3])
{
  KeyRange ranges[RangeLayout::Count];
  RangeLayout::ForEachBlock(macrocell,
    [&](int i, const vtkTypeInt64 block[3])
    {
      if (this->Layout.HasCells(block))
      {
        const Accumulator& found = this->At(block);
        ranges[i] = { found.Low.load(), found.High.load() };
      }
    });
  this->Store(macrocell, ranges);
}

//------------------------------------------------------------------------------
vtkTypeUInt64* BlockRangeFinder::RecordOf(const RangeLayout::Page& page, vtkTypeInt64 number)
{
  return this->Records->GetPointer(
    number + (1 + RangeRecords::WordsOfSteps) * this->Layout.MacrocellsBefore(page));
}

//------------------------------------------------------------------------------
void BlockRangeFinder::Store(const vtkTypeInt64 place[3], const KeyRange ranges[])
{
  RangeRecords::Macrocell macrocell;
  for (int i = 0; i < RangeLayout::Count; ++i)
  {
    macrocell.Range.Add(ranges[i]);
  }
  std::transform(ranges, ranges + RangeLayout::Count, macrocell.Steps,
    [&](const KeyRange& range) { return RangeSteps::Find(range, macrocell.Range); });
  const vtkTypeInt64 number = this->Layout.PageOf(place);
  const RangeLayout::Page page = this->Layout.GetPage(number);
  RangeRecords::Store(
    page, RangeLayout::PlaceIn(page, place), macrocell, this->RecordOf(page, number));
}

//------------------------------------------------------------------------------
bool BlockRangeFinder::AddAll(
  const BlockStream& blocks, SampleSummary& summary, const ProgressCallback& progress)
{
  const auto add = [this](zfp_stream* stream, const BlockStream::Block& block, SampleSummary& mine)
  {
    float samples[BlockSamples];
    zfp_decode_block_float_3(stream, samples);
    BlockStream::AddTo(mine, block, samples);
    this->Add(block, samples);
  };
  return ForEachPart(blocks, { 0, blocks.GetNumberOfSlabs() }, progress,
    [&](SlabRange part, const ProgressCallback& progressOfPart)
    {
      this->OpenSlabs(part.Last);
      const bool complete =
        ForEachBlock(blocks, part, StreamAccess::Read, summary, progressOfPart, add);
      this->CloseSlabs();
      return complete;
    });
}

//------------------------------------------------------------------------------
// Returns the numbers of the macrocells that have a block with hidden cells.
std::vector<vtkTypeInt64> BlockRangeFinder::FindMacrocellsNear(const vtkBlockMask& hidden) const
{
  const vtkTypeInt64* const blocks = this->Layout.GetBlocks();
  const vtkTypeInt64* const count = this->Layout.GetMacrocells();
  std::vector<char> isNear(static_cast<std::size_t>(this->Layout.GetNumberOfMacrocells()));
  const std::vector<vtkBlockMask::Run>& runs = hidden.GetRuns();
  for (std::size_t run = 0; run < runs.size(); ++run)
  {
    const vtkTypeUInt64 end =
      run + 1 < runs.size() ? runs[run + 1].First : blocks[0] * blocks[1] * blocks[2];
    for (vtkTypeUInt64 block = runs[run].First; runs[run].Bits && block < end; ++block)
    {
      const vtkTypeInt64 row = block / blocks[0];
      isNear[block % blocks[0] / RangeLayout::Side +
        count[0] *
          (row % blocks[1] / RangeLayout::Side +
            count[1] * (row / blocks[1] / RangeLayout::Side))] = 1;
    }
  }
  std::vector<vtkTypeInt64> numbers;
  for (vtkTypeInt64 number = 0; number < this->Layout.GetNumberOfMacrocells(); ++number)
  {
    if (isNear[static_cast<std::size_t>(number)])
    {
      numbers.push_back(number);
    }
  }
  return numbers;
}

//------------------------------------------------------------------------------
void BlockRangeFinder::FindVisible(
  const BlockStream& blocks, const vtkBlockMask& hidden, const vtkTypeInt64 macrocell[3])
{
  const vtkTypeInt64* const count = this->Layout.GetBlocks();
  KeyRange ranges[RangeLayout::Count];
  DecodedBox box;
  bool isDecoded = false;
  RangeLayout::ForEachBlock(macrocell,
    [&](int i, const vtkTypeInt64 block[3])
    {
      if (!this->Layout.HasCells(block))
      {
        return;
      }
      const vtkTypeUInt64 bits = hidden.Get(block[0] + count[0] * (block[1] + count[1] * block[2]));
      if (bits != vtkBlockMask::AllBits)
      {
        if (!isDecoded)
        {
          box.Decode(blocks, macrocell);
          isDecoded = true;
        }
        ranges[i] = box.FindVisible(block, bits);
      }
    });
  this->Store(macrocell, ranges);
}

//------------------------------------------------------------------------------
vtkBlockRanges BlockRangeFinder::Finish(const BlockStream& blocks, const vtkBlockMask& hidden)
{
  const vtkTypeInt64* const count = this->Layout.GetMacrocells();
  const std::vector<vtkTypeInt64> near = this->FindMacrocellsNear(hidden);
#pragma omp parallel for schedule(dynamic) num_threads(this->Threads)
  for (std::size_t i = 0; i < near.size(); ++i)
  {
    const vtkTypeInt64 macrocell[3] = { near[i] % count[0], near[i] / count[0] % count[1],
      near[i] / (count[0] * count[1]) };
    this->FindVisible(blocks, hidden, macrocell);
  }
  return this->Pack();
}

//------------------------------------------------------------------------------
// Leaves out what need not be stored. The records move towards the beginning of their array.
vtkBlockRanges BlockRangeFinder::Pack()
{
  const vtkTypeInt64 pages = this->Layout.GetNumberOfPages();
  vtkNew<vtkTypeUInt32Array> directory;
  directory->SetNumberOfValues(4 * pages); // no tuples: VTK's files do not keep their norms
  vtkTypeUInt32* entry = directory->GetPointer(0);
  vtkTypeUInt64* end = this->Records->GetPointer(0);
  for (vtkTypeInt64 page = 0; page < pages; ++page)
  {
    KeyRange range;
    const vtkTypeUInt64* const record = this->RecordOf(this->Layout.GetPage(page), page);
    const vtkTypeInt64 words = RangeRecords::Pack(this->Layout, page, record, end, range);
    *entry++ = RangeRecords::BitsOf(range.Low);
    *entry++ = RangeRecords::BitsOf(range.High);
    *entry++ = static_cast<vtkTypeUInt32>(words) | FlagsOf(range) << 16;
    *entry++ = RangeRecords::ChecksumOf(end, words);
    end += words;
  }
  this->Records->SetNumberOfValues(end - this->Records->GetPointer(0));
  this->Records->Squeeze();
  vtkBlockRanges ranges;
  ranges.FromArrays(directory, this->Records, this->Layout.GetDimensions());
  return ranges;
}
