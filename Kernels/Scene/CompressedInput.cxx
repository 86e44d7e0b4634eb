// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/CompressedInput.h"

#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

namespace
{
vtkSmartPointer<vtkImageData> Compress(const CompressedInput::Choice& choice)
{
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
  // of a piece of a volume, or of what is hidden
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
  compress->Update();
  return compress->GetOutput();
}

// The runs of a mask as Buffers.glsl has them.
std::vector<std::uint32_t> DescribeHidden(const vtkBlockMask& mask)
{
  const std::vector<vtkBlockMask::Run>& runs = mask.GetRuns();
  std::vector<std::uint32_t> words;
  if (!runs.empty())
  {
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
  }
  return words;
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

bool CompressedInput::Take(const Choice& choice)
{
  // a compressed volume has its own rate, component and mask
  vtkDataArray* array = choice.Array;
  const Key key = { choice.Image, choice.Image->GetMTime(), array, array ? array->GetMTime() : 0,
    array ? choice.Rate : 0.0, array ? choice.Component : 0, array && choice.MaskNonFinite };
  this->Error.clear();
  if (this->Image && key == this->Source)
  {
    return true;
  }
  this->Release();
  vtkSmartPointer<vtkImageData> image = choice.Image;
  if (array)
  {
    image = Compress(choice);
  }
  if (!this->Volume->Read(image))
  {
    this->Error = array ? std::string() : this->Volume->GetErrorMessage();
    return false;
  }
  this->Image = image;
  this->Source = key;
  this->Time.Modified();
  return true;
}

// Words of 64 bits, as zfp writes them.
CompressedStream DescribeStream(vtkCompressedVolume* volume)
{
  CompressedStream stream;
  const auto array = std::make_shared<vtkSmartPointer<vtkUnsignedCharArray>>(volume->GetStream());
  stream.Data = std::shared_ptr<const unsigned char>(array, (*array)->GetPointer(0));
  stream.Size = (*array)->GetNumberOfValues() / 8 * 8;
  stream.BlockBits = volume->GetBlockBits();
  return stream;
}

PipelineVolume DescribeVolume(vtkCompressedVolume* volume)
{
  PipelineVolume described;
  described.Values = DescribeStream(volume);
  described.Hidden = DescribeHidden(volume->GetCellsWithoutSurface());
  volume->GetDimensions(described.Samples);
  return described;
}
