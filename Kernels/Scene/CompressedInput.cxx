// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/CompressedInput.h"

#include "FirstError.h"

#include "vtkBlockRanges.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkPointData.h"
#include "vtkTimerLog.h"
#include "vtkUnsignedCharArray.h"

#include <memory>
#include <string>

namespace
{
// Hands on the progress of a filter.
class ProgressTeller
{
public:
  ProgressTeller(vtkAlgorithm* filter, const std::function<void(double)>& receiver)
    : Receiver(receiver)
  {
    filter->AddObserver(vtkCommand::ProgressEvent, this, &ProgressTeller::OnProgress);
  }

private:
  void OnProgress(vtkObject*, unsigned long, void* fraction)
  {
    if (this->Receiver)
    {
      this->Receiver(*static_cast<double*>(fraction));
    }
  }

  const std::function<void(double)>& Receiver;
};

Status Compress(const CompressedInput::Choice& choice, const std::function<void(double)>& progress,
  vtkSmartPointer<vtkImageData>& compressed)
{
  const vtkTimerLogScope timed("Progressive Isosurface: compress");
  vtkNew<vtkImageData> single;
  single->CopyStructure(choice.Image);
  if (choice.CellData)
  {
    single->GetCellData()->SetScalars(choice.Array);
  }
  else
  {
    single->GetPointData()->SetScalars(choice.Array);
  }
  // ghost arrays mark samples of other pieces, and hidden points and cells
  single->GetPointData()->AddArray(choice.Image->GetPointGhostArray());
  single->GetCellData()->AddArray(choice.Image->GetCellGhostArray());
  vtkNew<vtkImageZFPCompress> compress;
  compress->SetInputData(single);
  compress->SetInputArrayToProcess(0, 0, 0,
    choice.CellData ? vtkDataObject::FIELD_ASSOCIATION_CELLS
                    : vtkDataObject::FIELD_ASSOCIATION_POINTS,
    vtkDataSetAttributes::SCALARS);
  compress->SetRate(choice.Rate);
  compress->SetComponent(choice.Component);
  compress->SetMaskNonFinite(choice.MaskNonFinite);
  compress->SetKeepLabels(choice.KeepLabels);
  compress->SetLevels(choice.Levels);
  const FirstError errors(compress);
  const ProgressTeller teller(compress, progress);
  compress->Update();
  compressed = compress->GetOutput();
  return errors.GetStatus();
}

// Number, the first block of each, then the bits of each: see HiddenCells in Buffers.glsl.
std::vector<std::uint32_t> PackRuns(const std::vector<vtkBlockMask::Run>& runs)
{
  std::vector<std::uint32_t> words;
  words.reserve(1 + 3 * runs.size());
  words.push_back(static_cast<std::uint32_t>(runs.size()));
  for (const vtkBlockMask::Run& run : runs)
  {
    words.push_back(static_cast<std::uint32_t>(run.First));
  }
  for (const vtkBlockMask::Run& run : runs)
  {
    words.push_back(static_cast<std::uint32_t>(run.Bits));
    words.push_back(static_cast<std::uint32_t>(run.Bits >> 32));
  }
  return words;
}

PipelineLevel DescribeLevel(vtkCompressedVolume* volume, int level)
{
  vtkCompressedVolume* const own = LevelOf(volume, level);
  PipelineLevel described;
  described.Values = DescribeStream(own);
  if (own->HasRanges())
  {
    described.Ranges = [ranges = own->GetRanges()](
                         std::int64_t macrocell, std::uint32_t* range, std::uint32_t* blockRanges)
    { ranges.GetMacrocell(macrocell, range, blockRanges); };
  }
  own->GetDimensions(described.Samples);
  for (int axis = 0; axis < 3 && level > 0; ++axis)
  {
    for (int step = own->GetSteps()[axis]; step > 1; step /= 2)
    {
      ++described.Halvings[axis];
    }
  }
  return described;
}
}

CompressedInput::CompressedInput() = default;
CompressedInput::~CompressedInput() = default;

void CompressedInput::Release()
{
  if (this->Image)
  {
    this->Time.Modified();
  }
  this->Image = nullptr;
  this->Source = Key();
}

vtkImageData* CompressedInput::GetImage() const
{
  return this->Image;
}

std::int64_t CompressedInput::GetHostBytes() const
{
  const std::int64_t kibibytes = this->Image && std::get<vtkDataArray*>(this->Source)
    ? static_cast<std::int64_t>(this->Image->GetActualMemorySize())
    : 0;
  return 1024 * kibibytes;
}

Status CompressedInput::Update(const Choice& choice)
{
  // rate, component and mask of a compressed volume are fixed
  vtkDataArray* array = choice.Array;
  const Key key = { choice.Image, choice.Image->GetMTime(), array, array ? array->GetMTime() : 0,
    array ? choice.Rate : 0.0, array ? choice.Component : 0, array && choice.MaskNonFinite,
    array && choice.KeepLabels, array ? choice.Levels : 0 };
  if (key != this->Source)
  {
    this->Release();
    this->Result = this->Read(choice);
    this->Source = key;
    this->Time.Modified();
  }
  return this->Result;
}

Status CompressedInput::Read(const Choice& choice)
{
  vtkSmartPointer<vtkImageData> image = choice.Image;
  if (choice.Array)
  {
    if (Status status = Compress(choice, this->Progress, image); !status)
    {
      return status;
    }
  }
  if (!this->Volume->Read(image))
  {
    return Status::Error(this->Volume->GetErrorMessage());
  }
  this->Image = image;
  return Status();
}

std::vector<std::uint32_t> DescribeHidden(const std::vector<HiddenInLevel>& levels)
{
  std::vector<vtkBlockMask::Run> runs;
  bool any = false;
  vtkTypeUInt64 firstBlock = 0;
  for (const HiddenInLevel& level : levels)
  {
    const std::vector<vtkBlockMask::Run>& own = level.Mask.GetRuns();
    any = any || !own.empty();
    if (own.empty())
    {
      runs.push_back({ firstBlock, 0 });
    }
    for (const vtkBlockMask::Run& run : own)
    {
      runs.push_back({ firstBlock + run.First, run.Bits });
    }
    firstBlock += level.Blocks;
  }
  return any ? PackRuns(runs) : std::vector<std::uint32_t>();
}

// Whole words of 64 bits, as zfp writes them.
CompressedStream DescribeStream(vtkCompressedVolume* volume)
{
  CompressedStream stream;
  const auto array = std::make_shared<vtkSmartPointer<vtkUnsignedCharArray>>(volume->GetStream());
  stream.Data = std::shared_ptr<const unsigned char>(array, (*array)->GetPointer(0));
  stream.Size = (*array)->GetNumberOfValues() / 8 * 8;
  stream.BlockBits = volume->GetBlockBits();
  return stream;
}

PipelineVolume DescribeVolume(vtkCompressedVolume* volume, int levels)
{
  PipelineVolume described;
  static_cast<PipelineLevel&>(described) = DescribeLevel(volume, 0);
  std::vector<HiddenInLevel> hidden;
  for (int level = 0; level <= levels; ++level)
  {
    vtkCompressedVolume* const own = LevelOf(volume, level);
    hidden.push_back({ own->GetCellsWithoutSurface(), own->GetNumberOfBlocks() });
    if (level > 0)
    {
      described.Coarser.push_back(DescribeLevel(volume, level));
    }
  }
  described.Hidden = DescribeHidden(hidden);
  return described;
}

std::vector<std::uint32_t> DescribeHiddenSamples(vtkCompressedVolume* volume, int levels)
{
  std::vector<HiddenInLevel> hidden;
  for (int level = 0; level <= levels; ++level)
  {
    vtkCompressedVolume* const own = LevelOf(volume, level);
    hidden.push_back({ own->GetHiddenSamples(), own->GetNumberOfBlocks() });
  }
  return DescribeHidden(hidden);
}

vtkCompressedVolume* LevelOf(vtkCompressedVolume* volume, int level)
{
  return level == 0 ? volume : volume->GetLevel(level);
}
