// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LevelFormat.h"

#include "Codec/LevelShape.h"
#include "Format/Checksums.h"
#include "Format/FieldArrays.h"
#include "Format/RangeFormat.h"
#include "Format/StreamArray.h"

#include "vtkBlockMask.h"
#include "vtkCompressedVolume.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"
#include "vtkTypeUInt32Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{
using namespace FieldArrays;
using Volume = vtkCompressedVolume;

const std::string LevelsName = "ProgIso.Levels";
const std::string LevelPrefix = "ProgIso.Level";
const std::string BaseChecksumsName = "ProgIso.ZFP.PageChecksums";

//------------------------------------------------------------------------------
// The arrays of one level.
class Names
{
public:
  explicit Names(int level)
    : Prefix(LevelPrefix + std::to_string(level) + ".")
  {
  }

  std::string operator()(const char* name) const { return this->Prefix + name; }

  const std::string Prefix;
};

//------------------------------------------------------------------------------
bool IsOfLevels(const char* name)
{
  return name && std::string(name).rfind(LevelPrefix, 0) == 0;
}

//------------------------------------------------------------------------------
std::vector<std::string> FindNames(vtkFieldData* fields)
{
  std::vector<std::string> names;
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    if (IsOfLevels(fields->GetArrayName(i)))
    {
      names.emplace_back(fields->GetArrayName(i));
    }
  }
  return names;
}

//------------------------------------------------------------------------------
vtkTypeUInt32 ChecksumOf(vtkFieldData* fields, const Names& names)
{
  return Checksums::OfFields(
    fields, names.Prefix.c_str(), names("Stream").c_str(), names("Checksum").c_str());
}

//------------------------------------------------------------------------------
// Reads one level, after the one before it.
class LevelReader
{
public:
  LevelReader(vtkFieldData* fields, int level, const LevelShape& before, Volume* volume)
    : Fields(fields)
    , Array(level)
    , Before(before)
    , Level(volume)
  {
  }

  Status Read()
  {
    for (const auto& read : { &LevelReader::ReadShape, &LevelReader::ReadBlockBits,
           &LevelReader::ReadReals, &LevelReader::ReadHidden, &LevelReader::ReadStream,
           &LevelReader::ReadRanges, &LevelReader::CheckMetadata, &LevelReader::CheckStream })
    {
      if (Status status = (this->*read)(); !status)
      {
        return status;
      }
    }
    return {};
  }

  const LevelShape& GetShape() const { return this->Shape; }

private:
  Status ReadShape()
  {
    vtkTypeInt64 steps[3], dims[3];
    Status status = GetIntegers(this->Fields, this->Array("Steps").c_str(), 3, steps);
    if (status)
    {
      status = GetIntegers(this->Fields, this->Array("Dimensions").c_str(), 3, dims);
    }
    if (!status)
    {
      return status;
    }
    bool halves[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      halves[axis] =
        steps[axis] == 2 * this->Before.Steps[axis] && this->Before.Dimensions[axis] > 2;
      if (!halves[axis] && steps[axis] != this->Before.Steps[axis])
      {
        return Status::Error(this->Array("Steps"), " is ", steps[axis], " along axis ", axis,
          ", after ", this->Before.Steps[axis], " of the level before");
      }
    }
    this->Shape = this->Before.Halve(halves);
    for (int axis = 0; axis < 3; ++axis)
    {
      if (dims[axis] != this->Shape.Dimensions[axis])
      {
        return Status::Error(this->Array("Dimensions"), " is ", dims[axis], " along axis ", axis,
          ", where ", this->Shape.Dimensions[axis], " samples follow from the level before");
      }
    }
    this->Level->SetDimensions(this->Shape.Dimensions);
    this->Level->SetSteps(this->Shape.Steps);
    return {};
  }

  Status ReadBlockBits()
  {
    int blockBits = 0;
    const Status status = GetInteger(this->Fields, this->Array("BlockBits").c_str(),
      Volume::MinimumBlockBits, Volume::MaximumBlockBits, blockBits);
    this->Level->SetBlockBits(blockBits);
    return status;
  }

  Status ReadReals()
  {
    double range[2], errors[2], distance = 0.0;
    for (const Status& status : { GetReals(this->Fields, this->Array("Range").c_str(), 2, range),
           GetReals(this->Fields, this->Array("Error").c_str(), 2, errors),
           GetReals(this->Fields, this->Array("Distance").c_str(), 1, &distance) })
    {
      if (!status)
      {
        return status;
      }
    }
    if (!std::isfinite(range[0]) || !std::isfinite(range[1]) || range[0] > range[1])
    {
      return Status::Error(this->Array("Range"), " is not a finite range");
    }
    if (!(errors[0] >= 0.0 && errors[1] >= 0.0))
    {
      return Status::Error(this->Array("Error"), " is not two numbers from 0");
    }
    if (!(distance >= 0.0))
    {
      return Status::Error(this->Array("Distance"), " is not a number from 0");
    }
    this->Level->SetRange(range);
    this->Level->SetLargestError(errors[0]);
    this->Level->SetMeanError(errors[1]);
    this->Level->SetLargestDistance(distance);
    return {};
  }

  Status ReadHidden()
  {
    const vtkTypeInt64 blocks = Volume::NumberOfBlocksFor(this->Level->GetDimensions());
    vtkBlockMask samples, cells;
    Status status = GetMask(this->Fields, this->Array("HiddenSamples").c_str(), blocks, samples);
    if (status)
    {
      status = GetMask(this->Fields, this->Array("HiddenCells").c_str(), blocks, cells);
    }
    this->Level->SetHiddenSamples(samples);
    this->Level->SetHiddenCells(cells);
    return status;
  }

  vtkTypeInt64 StreamBytes() const
  {
    return Volume::StreamBytesFor(this->Level->GetDimensions(), this->Level->GetBlockBits());
  }

  Status ReadStream()
  {
    const std::string name = this->Array("Stream");
    auto* stream =
      vtkArrayDownCast<vtkUnsignedCharArray>(this->Fields->GetAbstractArray(name.c_str()));
    if (!stream)
    {
      return Status::Error("its field data array ", name, " is not an array of unsigned char");
    }
    if (this->StreamBytes() < 0 || stream->GetNumberOfValues() < this->StreamBytes())
    {
      return Status::Error(name, " is truncated: it has ", stream->GetNumberOfValues(), " bytes, ",
        this->StreamBytes() < 0 ? "its dimensions need more than 2^60"
                                : std::to_string(this->StreamBytes()) + " are needed");
    }
    this->Level->SetStream(stream);
    return {};
  }

  Status ReadRanges() { return RangeFormat::Read(this->Fields, this->Array.Prefix, this->Level); }

  Status CheckMetadata()
  {
    vtkTypeInt64 expected = 0;
    if (Status status = GetIntegers(this->Fields, this->Array("Checksum").c_str(), 1, &expected);
        !status)
    {
      return status;
    }
    if (static_cast<vtkTypeInt64>(ChecksumOf(this->Fields, this->Array)) == expected)
    {
      return {};
    }
    const Status ofRanges = RangeFormat::CheckRecords(this->Array.Prefix, this->Level);
    return !ofRanges
      ? ofRanges
      : Status::Error("its metadata (arrays of field data named ", this->Array.Prefix,
          "*) do not match their checksum: they are damaged, or were changed or rounded by what "
          "wrote them");
  }

  Status CheckStream()
  {
    const vtkTypeInt64 pages = Checksums::NumberOfPages(this->StreamBytes());
    const std::string name = this->Array("PageChecksums");
    auto* const checksums =
      vtkArrayDownCast<vtkTypeUInt32Array>(this->Fields->GetAbstractArray(name.c_str()));
    if (!checksums || checksums->GetNumberOfValues() != pages)
    {
      return Status::Error(
        "its field data array ", name, " does not hold ", pages, " 32-bit integers");
    }
    this->Level->SetHasChecksums(true);
    if (Checksums::IsKnownIntact(this->Level->GetStream(), checksums))
    {
      return {};
    }
    const Status status = Checksums::CheckPages(this->Level, checksums);
    if (status)
    {
      Checksums::SetIntact(this->Level->GetStream(), checksums);
    }
    return status.WithPrefix(this->Array("Stream") + " ");
  }

  vtkFieldData* Fields;
  Names Array;
  LevelShape Before;
  Volume* Level;
  LevelShape Shape = {};
};

//------------------------------------------------------------------------------
// Reads how many levels there are, and whether they are of the volume's stream.
Status ReadNumber(vtkFieldData* fields, int& number)
{
  vtkTypeInt64 values[2];
  if (Status status = GetIntegers(fields, LevelsName.c_str(), 2, values); !status)
  {
    return status;
  }
  if (values[0] < 1 || values[0] > Volume::MaximumLevels)
  {
    return Status::Error(
      LevelsName, " is ", values[0], " levels, not in 1..", +Volume::MaximumLevels);
  }
  auto* const checksums =
    vtkArrayDownCast<vtkTypeUInt32Array>(fields->GetAbstractArray(BaseChecksumsName.c_str()));
  number = static_cast<int>(values[0]);
  return checksums && Checksums::OfChecksums(checksums) == values[1]
    ? Status()
    : Status::Error("its levels of detail (arrays of field data named ", LevelPrefix,
        "*) are those of another stream: compress it again, or remove them");
}

//------------------------------------------------------------------------------
void WriteLevel(Volume* level, const Names& names, vtkFieldData* fields)
{
  const double errors[] = { level->GetLargestError(), level->GetMeanError() };
  StoreValue<vtkIntArray>(fields, names("BlockBits").c_str(), level->GetBlockBits());
  StoreValues<vtkTypeInt64Array>(fields, names("Dimensions").c_str(), level->GetDimensions(), 3);
  StoreValues<vtkIntArray>(fields, names("Steps").c_str(), level->GetSteps(), 3);
  StoreValues<vtkDoubleArray>(fields, names("Range").c_str(), level->GetRange(), 2);
  StoreValues<vtkDoubleArray>(fields, names("Error").c_str(), errors, 2);
  StoreValue<vtkDoubleArray>(fields, names("Distance").c_str(), level->GetLargestDistance());
  StoreMask(fields, names("HiddenSamples").c_str(), level->GetHiddenSamples());
  StoreMask(fields, names("HiddenCells").c_str(), level->GetHiddenCells());
  vtkUnsignedCharArray* const given = level->GetStream();
  given->SetName(names("Stream").c_str());
  fields->AddArray(given);
  StreamArray::Replace(fields, names("Stream").c_str());
  auto* const stream =
    vtkArrayDownCast<vtkUnsignedCharArray>(fields->GetAbstractArray(names("Stream").c_str()));
  const auto checksums = Checksums::OfPages(
    stream, Volume::StreamBytesFor(level->GetDimensions(), level->GetBlockBits()));
  checksums->SetName(names("PageChecksums").c_str());
  fields->AddArray(checksums);
  RangeFormat::Write(level, names.Prefix, fields);
  StoreValue<vtkTypeUInt32Array>(fields, names("Checksum").c_str(), ChecksumOf(fields, names));
  Checksums::SetIntact(stream, checksums);
}
}

//------------------------------------------------------------------------------
Status LevelFormat::Read(vtkImageData* image, vtkCompressedVolume* volume)
{
  vtkFieldData* const fields = image->GetFieldData();
  if (FindNames(fields).empty())
  {
    return {};
  }
  int number = 0;
  if (Status status = ReadNumber(fields, number); !status)
  {
    return status;
  }
  LevelShape shape = LevelShape::OfVolume(volume->GetDimensions());
  for (int i = 1; i <= number; ++i)
  {
    vtkNew<vtkCompressedVolume> level;
    volume->AddLevel(level);
    LevelReader reader(fields, i, shape, level);
    if (Status status = reader.Read(); !status)
    {
      return status.WithPrefix("level " + std::to_string(i) + " of it: ");
    }
    shape = reader.GetShape();
  }
  return {};
}

//------------------------------------------------------------------------------
void LevelFormat::Write(
  vtkCompressedVolume* volume, vtkTypeUInt32Array* checksums, vtkFieldData* fields)
{
  const int number = volume->GetNumberOfLevels();
  if (number == 0)
  {
    return;
  }
  const vtkTypeInt64 values[] = { number, Checksums::OfChecksums(checksums) };
  StoreValues<vtkTypeInt64Array>(fields, LevelsName.c_str(), values, 2);
  for (int i = 1; i <= number; ++i)
  {
    WriteLevel(volume->GetLevel(i), Names(i), fields);
  }
}

//------------------------------------------------------------------------------
void LevelFormat::Remove(vtkFieldData* fields)
{
  for (const std::string& name : FindNames(fields))
  {
    fields->RemoveArray(name.c_str());
  }
}

//------------------------------------------------------------------------------
void LevelFormat::SpeedUpRanges(vtkFieldData* fields)
{
  for (int i = 1; i <= Volume::MaximumLevels; ++i)
  {
    StreamArray::Replace(fields, Names(i)("Stream").c_str());
    ReplaceMask(fields, Names(i)("HiddenSamples").c_str());
    ReplaceMask(fields, Names(i)("HiddenCells").c_str());
  }
}
