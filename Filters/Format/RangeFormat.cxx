// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RangeFormat.h"

#include "Format/Checksums.h"
#include "Format/FieldArrays.h"

#include "vtkBlockRanges.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkTypeUInt32Array.h"

namespace
{
const char* const RecordsName = "Ranges";
const char* const DirectoryName = "RangesDirectory";
const char* const StreamChecksumName = "RangesOf";

//------------------------------------------------------------------------------
vtkDataArray* FindArray(vtkFieldData* fields, const std::string& name)
{
  return vtkArrayDownCast<vtkDataArray>(fields->GetAbstractArray(name.c_str()));
}

//------------------------------------------------------------------------------
// Tells the stream, and what is hidden in it, from others.
vtkTypeUInt32 ChecksumOfStream(vtkFieldData* fields, const std::string& prefix)
{
  return Checksums::OfArrays(fields,
    { prefix + "BlockBits", prefix + "Dimensions", prefix + "HiddenCells", prefix + "HiddenSamples",
      prefix + "PageChecksums" });
}

//------------------------------------------------------------------------------
bool AreOfThisStream(vtkFieldData* fields, const std::string& prefix)
{
  vtkTypeInt64 expected = -1;
  return fields->HasArray((prefix + "PageChecksums").c_str()) &&
    FieldArrays::GetIntegers(fields, (prefix + StreamChecksumName).c_str(), 1, &expected) &&
    expected == static_cast<vtkTypeInt64>(ChecksumOfStream(fields, prefix));
}

//------------------------------------------------------------------------------
Status Damaged(const std::string& prefix, const std::string& error)
{
  return error.empty() ? Status() : Status::Error(prefix, RecordsName, " is damaged: ", error);
}
}

//------------------------------------------------------------------------------
Status RangeFormat::Read(
  vtkFieldData* fields, const std::string& prefix, vtkCompressedVolume* volume)
{
  if (!AreOfThisStream(fields, prefix))
  {
    return {};
  }
  vtkBlockRanges ranges;
  const std::string error = ranges.FromArrays(FindArray(fields, prefix + DirectoryName),
    FindArray(fields, prefix + RecordsName), volume->GetDimensions());
  if (error.empty())
  {
    volume->SetRanges(ranges);
  }
  return Damaged(prefix, error);
}

//------------------------------------------------------------------------------
Status RangeFormat::CheckRecords(const std::string& prefix, vtkCompressedVolume* volume)
{
  return Damaged(prefix, volume->GetRanges().CheckRecords());
}

//------------------------------------------------------------------------------
void RangeFormat::Write(
  vtkCompressedVolume* volume, const std::string& prefix, vtkFieldData* fields)
{
  const vtkBlockRanges& ranges = volume->GetRanges();
  if (ranges.Fit(volume->GetDimensions()))
  {
    ranges.GetDirectory()->SetName((prefix + DirectoryName).c_str());
    fields->AddArray(ranges.GetDirectory());
    ranges.GetRecords()->SetName((prefix + RecordsName).c_str());
    fields->AddArray(ranges.GetRecords());
    FieldArrays::StoreValue<vtkTypeUInt32Array>(
      fields, (prefix + StreamChecksumName).c_str(), ChecksumOfStream(fields, prefix));
  }
}

//------------------------------------------------------------------------------
void RangeFormat::Remove(const std::string& prefix, vtkFieldData* fields)
{
  for (const char* const name : { RecordsName, DirectoryName, StreamChecksumName })
  {
    fields->RemoveArray((prefix + name).c_str());
  }
}
