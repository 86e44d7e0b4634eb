// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/InputArrays.h"

#include "Codec/LevelShape.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkPointData.h"

#include <algorithm>

namespace
{
vtkDataArray* FindArray(const ArrayChoice& choice, vtkImageData* image, bool& cellData)
{
  if (choice.ScalarMode == VTK_SCALAR_MODE_DEFAULT)
  {
    int association = vtkCompressedVolume::PointData;
    vtkDataArray* array = vtkImageZFPCompress::FindDefaultArray(image, association);
    cellData = association == vtkCompressedVolume::CellData;
    return array;
  }
  int cellFlag = 0;
  vtkDataArray* array = vtkAbstractMapper::GetScalars(
    image, choice.ScalarMode, choice.ArrayAccessMode, choice.ArrayId, choice.ArrayName, cellFlag);
  cellData = cellFlag == 1;
  return array;
}

bool HasSameShape(vtkCompressedVolume* a, vtkCompressedVolume* b)
{
  return std::equal(a->GetDimensions(), a->GetDimensions() + 3, b->GetDimensions()) &&
    std::equal(a->GetSteps(), a->GetSteps() + 3, b->GetSteps());
}
}

Status InputArrays::UpdateValues(const ArrayChoice& choice, vtkImageData* image)
{
  CompressedInput::Choice values = { image, nullptr, false, choice.Component, choice.Rate,
    choice.MaskNonFinite, choice.KeepLabels, choice.Levels };
  if (!vtkCompressedVolume::IsCompressed(image))
  {
    values.Array = FindArray(choice, image, values.CellData);
    if (!values.Array)
    {
      return Status::Error("the input image has no scalars: select an array that it has");
    }
  }
  return this->Values.Update(values);
}

Status InputArrays::UpdateColorsFromImage(const ArrayChoice& choice, vtkImageData* image)
{
  CompressedInput::Choice colors = { image, nullptr, this->HasCellData(), choice.ColorComponent,
    choice.Rate, choice.MaskNonFinite, choice.KeepLabels, choice.Levels };
  const bool compressed = image && vtkCompressedVolume::IsCompressed(image);
  if (image && !compressed)
  {
    colors.Array = FindArray(choice, image, colors.CellData);
  }
  if (!compressed && !colors.Array)
  {
    return Status::Error("the colours' volume has no scalars");
  }
  return this->UpdateColors(colors);
}

Status InputArrays::UpdateColorsFromArray(const ArrayChoice& choice, vtkImageData* image)
{
  const bool cellData = this->HasCellData();
  vtkDataSetAttributes* attributes =
    cellData ? static_cast<vtkDataSetAttributes*>(image->GetCellData()) : image->GetPointData();
  vtkDataArray* array = attributes->GetArray(choice.ColorArrayName);
  if (!array)
  {
    return Status::Error("the input has no array \"", choice.ColorArrayName,
      "\" beside the one that is rendered: name one that it has, or connect the colours' volume to "
      "port 1");
  }
  return this->UpdateColors({ image, array, cellData, choice.ColorComponent, choice.Rate,
    choice.MaskNonFinite, choice.KeepLabels, choice.Levels });
}

void InputArrays::SetProgress(const std::function<void(double)>& progress)
{
  this->Values.SetProgress(progress);
  this->Colors.SetProgress(progress);
}

Status InputArrays::UpdateColors(const CompressedInput::Choice& choice)
{
  if (Status status = this->Colors.Update(choice); !status)
  {
    return status;
  }
  const int* values = this->Values.GetVolume()->GetDimensions();
  const int* colors = this->Colors.GetVolume()->GetDimensions();
  return std::equal(values, values + 3, colors)
    ? Status()
    : Status::Error("the colours' volume has other dimensions than the one that is rendered: "
                    "resample it to the same");
}

vtkMTimeType InputArrays::GetTime() const
{
  return std::max(this->Values.GetTime(), this->Colors.GetTime());
}

int InputArrays::CountLevels() const
{
  vtkCompressedVolume* const values = this->Values.GetVolume();
  vtkCompressedVolume* const colors = this->Colors.GetImage() ? this->Colors.GetVolume() : nullptr;
  const int number = values->GetNumberOfLevels();
  bool drawn = !colors || colors->GetNumberOfLevels() == number;
  for (int level = 0; level <= number && drawn; ++level)
  {
    drawn = LevelOf(values, level)->HasRanges() &&
      (!colors || HasSameShape(LevelOf(values, level), LevelOf(colors, level)));
  }
  return drawn ? number : 0;
}

std::string InputArrays::DescribeLackOfLevels() const
{
  vtkCompressedVolume* const values = this->Values.GetVolume();
  const int* samples = values->GetDimensions();
  if (this->CountLevels() > 0 || *std::max_element(samples, samples + 3) <= PageSide)
  {
    return "";
  }
  return values->GetNumberOfLevels() == 0
    ? "the compressed volume has no levels of detail: compress it with levels"
    : "its levels of detail lack ranges of values, or the colours' volume has not the same levels: "
      "compress both again, with levels";
}

PipelineVolume InputArrays::Describe(int levels) const
{
  PipelineVolume volume = DescribeVolume(this->Values.GetVolume(), levels);
  if (this->Colors.GetImage())
  {
    vtkCompressedVolume* const colors = this->Colors.GetVolume();
    volume.Colors = DescribeStream(colors);
    for (int level = 1; level <= levels; ++level)
    {
      volume.Coarser[level - 1].Colors = DescribeStream(colors->GetLevel(level));
    }
    volume.HiddenColors = DescribeHiddenSamples(colors, levels);
  }
  return volume;
}

bool InputArrays::HasCellData() const
{
  return this->Values.GetVolume()->GetAssociation() == vtkCompressedVolume::CellData;
}
