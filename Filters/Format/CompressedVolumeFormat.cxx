// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CompressedVolumeFormat.h"

#include "Codec/MacrocellErrors.h"
#include "Format/Checksums.h"
#include "Format/FieldArrays.h"
#include "Format/LevelFormat.h"
#include "Format/RangeFormat.h"
#include "Format/SampleGrid.h"
#include "Format/StreamArray.h"
#include "Pieces/HidingFlags.h"
#include "Pieces/PieceExtents.h"

#include "vtkBlockMask.h"
#include "vtkCompressedVolume.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkTypeUInt32Array.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace
{
using namespace FieldArrays;
using Volume = vtkCompressedVolume;

const char* const Prefix = "ProgIso.ZFP.";
const char* const VersionName = "ProgIso.ZFP.Version";
const char* const StreamName = "ProgIso.ZFP.Stream";
const char* const BlockBitsName = "ProgIso.ZFP.BlockBits";
const char* const DimensionsName = "ProgIso.ZFP.Dimensions";
const char* const RangeName = "ProgIso.ZFP.Range";
const char* const ScalarTypeName = "ProgIso.ZFP.ScalarType";
const char* const ArrayNameName = "ProgIso.ZFP.ArrayName";
const char* const ComponentName = "ProgIso.ZFP.Component";
const char* const AssociationName = "ProgIso.ZFP.Association";
const char* const ExtentName = "ProgIso.ZFP.Extent";
const char* const GridName = "ProgIso.ZFP.Grid";
const char* const OffsetName = "ProgIso.ZFP.Offset";
const char* const ScaleName = "ProgIso.ZFP.Scale";
const char* const ErrorName = "ProgIso.ZFP.Error";
const char* const MacrocellErrorsName = "ProgIso.ZFP.MacrocellErrors";
const char* const HiddenSamplesName = "ProgIso.ZFP.HiddenSamples";
const char* const HiddenCellsName = "ProgIso.ZFP.HiddenCells";
const char* const PageChecksumsName = "ProgIso.ZFP.PageChecksums";
const char* const MetadataChecksumName = "ProgIso.ZFP.MetadataChecksum";

const char* const AllNames[] = { VersionName, StreamName, BlockBitsName, DimensionsName, RangeName,
  ScalarTypeName, ArrayNameName, ComponentName, AssociationName, ExtentName, GridName, OffsetName,
  ScaleName, ErrorName, MacrocellErrorsName, HiddenSamplesName, HiddenCellsName, PageChecksumsName,
  MetadataChecksumName };

// From this version of the format on, checksums are there; before, there were none.
constexpr int FirstVersionWithChecksums = 3;

constexpr int MaximumInt = std::numeric_limits<int>::max();

bool IsCellData(Volume* volume)
{
  return volume->GetAssociation() == Volume::CellData;
}

//------------------------------------------------------------------------------
bool IsNumericType(int type)
{
  switch (type)
  {
    case VTK_BIT:
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
    case VTK_UNSIGNED_CHAR:
    case VTK_SHORT:
    case VTK_UNSIGNED_SHORT:
    case VTK_INT:
    case VTK_UNSIGNED_INT:
    case VTK_LONG:
    case VTK_UNSIGNED_LONG:
    case VTK_LONG_LONG:
    case VTK_UNSIGNED_LONG_LONG:
    case VTK_ID_TYPE:
    case VTK_FLOAT:
    case VTK_DOUBLE:
      return true;
    default:
      return false;
  }
}

//------------------------------------------------------------------------------
Status CheckVersion(vtkFieldData* fields)
{
  int version = 0;
  if (Status status = GetInteger(fields, VersionName, 1, MaximumInt, version); !status)
  {
    return status;
  }
  return version <= Volume::FormatVersion
    ? Status()
    : Status::Error("it has version ", version, " of the format, this ProgIso reads version ",
        +Volume::FormatVersion, " and older (a newer ProgIso wrote it)");
}

//------------------------------------------------------------------------------
vtkTypeUInt32 ChecksumOfMetadata(vtkFieldData* fields)
{
  return Checksums::OfFields(fields, Prefix, StreamName, MetadataChecksumName);
}

//------------------------------------------------------------------------------
Status ReadIntegers(vtkFieldData* fields, Volume* volume)
{
  int blockBits = 0, scalarType = 0, component = 0, association = 0;
  const struct
  {
    const char* Name;
    int Low, High;
    int& Value;
  } integers[] = {
    { BlockBitsName, Volume::MinimumBlockBits, Volume::MaximumBlockBits, blockBits },
    { ScalarTypeName, 0, MaximumInt, scalarType },
    { ComponentName, Volume::Magnitude, MaximumInt, component },
    { AssociationName, Volume::PointData, Volume::CellData, association },
  };
  for (const auto& integer : integers)
  {
    if (Status status = GetInteger(fields, integer.Name, integer.Low, integer.High, integer.Value);
        !status)
    {
      return status;
    }
  }
  volume->SetBlockBits(blockBits);
  volume->SetScalarType(scalarType);
  volume->SetComponent(component);
  volume->SetAssociation(association);
  return IsNumericType(scalarType)
    ? Status()
    : Status::Error(ScalarTypeName, " is ", scalarType, ", not a VTK number type");
}

//------------------------------------------------------------------------------
Status ReadNumbers(vtkImageData* image, Volume* volume)
{
  vtkFieldData* fields = image->GetFieldData();
  if (Status status = CheckVersion(fields); !status)
  {
    return status;
  }
  if (Status status = ReadIntegers(fields, volume); !status)
  {
    return status;
  }
  double range[2];
  if (Status status = GetReals(fields, RangeName, 2, range); !status)
  {
    return status;
  }
  if (!std::isfinite(range[0]) || !std::isfinite(range[1]) || range[0] > range[1])
  {
    return Status::Error(RangeName, " is not a finite range");
  }
  volume->SetRange(range);
  return {};
}

//------------------------------------------------------------------------------
// Whether sums and differences of positions in an extent do not overflow.
bool IsBounded(vtkTypeInt64 low, vtkTypeInt64 high)
{
  const vtkTypeInt64 most = vtkTypeInt64(1) << 30;
  return -most <= low && low <= most && -most <= high && high <= most;
}

//------------------------------------------------------------------------------
// Whether a stream of these dimensions covers an extent.
bool Fits(const vtkTypeInt64 extent[6], const vtkTypeInt64 dims[3], bool cells)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const vtkTypeInt64 low = extent[2 * axis], high = extent[2 * axis + 1];
    if (!IsBounded(low, high) || high - low + (cells ? 0 : 1) != dims[axis])
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
// Finds the extent of the stream by the image's indices, which filters and files may have shifted.
Status FindShiftedExtent(vtkImageData* image, const vtkTypeInt64 named[6], vtkTypeInt64 extent[6])
{
  SampleGrid grid;
  int shift[3];
  Status status = GetReals(image->GetFieldData(), GridName, SampleGrid::Size, grid.Values);
  if (status)
  {
    status = grid.FindShift(image, shift);
  }
  for (int axis = 0; axis < 3 && status; ++axis)
  {
    const int low = 2 * axis, high = low + 1;
    extent[low] = named[low] - shift[axis];
    extent[high] = named[high] - shift[axis];
    if (!IsBounded(extent[low], extent[high]))
    {
      return Status::Error("its indices along axis ", axis, " reach beyond -2^30 or 2^30");
    }
  }
  return status;
}

//------------------------------------------------------------------------------
// Sets the extent of the stream: the one that the field data name, if the image has the stream's
// grid. Where no grid is known: the image's own, or if that has another size, the named one.
Status ReadExtent(vtkImageData* image, const vtkTypeInt64 dims[3], Volume* volume)
{
  vtkFieldData* const fields = image->GetFieldData();
  const bool cells = IsCellData(volume);
  vtkTypeInt64 extent[6], named[6];
  std::copy_n(image->GetExtent(), 6, extent);
  const bool isNamed = GetIntegers(fields, ExtentName, 6, named) && Fits(named, dims, cells);
  if (isNamed && fields->HasArray(GridName))
  {
    if (Status status = FindShiftedExtent(image, named, extent); !status)
    {
      return status;
    }
  }
  else if (isNamed && !Fits(extent, dims, cells))
  {
    std::copy_n(named, 6, extent);
  }
  int bounds[6];
  std::transform(
    extent, extent + 6, bounds, [](vtkTypeInt64 bound) { return static_cast<int>(bound); });
  volume->SetExtent(bounds);
  return {};
}

//------------------------------------------------------------------------------
Status CheckAxis(int axis, vtkTypeInt64 dimension, const int extent[6], bool cells)
{
  const vtkTypeInt64 low = extent[2 * axis], high = extent[2 * axis + 1];
  const vtkTypeInt64 expected = high - low + (cells ? 0 : 1);
  const char* const elements = cells ? " cells" : " points";
  if (dimension != expected)
  {
    return Status::Error(DimensionsName, " is ", dimension, " along axis ", axis,
      ", but the image has ", expected, elements, " there");
  }
  if (expected < 2 || expected > MaximumInt)
  {
    return Status::Error("it has ", expected, elements, " along axis ", axis,
      ", at least 2 and at most 2^31-1 are needed");
  }
  if (!IsBounded(low, high))
  {
    return Status::Error(
      "its extent along axis ", axis, ", ", low, " to ", high, ", reaches beyond -2^30 or 2^30");
  }
  return {};
}

//------------------------------------------------------------------------------
Status CheckImageExtent(const int extent[6], Volume* volume)
{
  const bool cells = IsCellData(volume);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (extent[2 * axis + 1] < extent[2 * axis] + (cells ? 1 : 0))
    {
      return Status::Error("the image has no ", cells ? "cells" : "points", " along axis ", axis);
    }
  }
  return PieceExtents::Contains(volume->GetExtent(), extent)
    ? Status()
    : Status::Error("its stream is that of another piece (one compressed volume cannot be put "
                    "together from several)");
}

//------------------------------------------------------------------------------
Status ReadGeometry(vtkImageData* image, Volume* volume)
{
  vtkTypeInt64 dims[3];
  if (Status status = GetIntegers(image->GetFieldData(), DimensionsName, 3, dims); !status)
  {
    return status;
  }
  if (Status status = ReadExtent(image, dims, volume); !status)
  {
    return status;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (Status status = CheckAxis(axis, dims[axis], volume->GetExtent(), IsCellData(volume));
        !status)
    {
      return status;
    }
  }
  volume->SetDimensions(
    static_cast<int>(dims[0]), static_cast<int>(dims[1]), static_cast<int>(dims[2]));
  return CheckImageExtent(image->GetExtent(), volume);
}

//------------------------------------------------------------------------------
Status ReadArrayName(vtkImageData* image, Volume* volume)
{
  auto* names =
    vtkArrayDownCast<vtkStringArray>(image->GetFieldData()->GetAbstractArray(ArrayNameName));
  if (!names || names->GetNumberOfValues() != 1)
  {
    return Status::Error("its field data array ", ArrayNameName, " does not hold one string");
  }
  volume->SetArrayName(names->GetValue(0));
  return {};
}

//------------------------------------------------------------------------------
Status ReadStream(vtkImageData* image, Volume* volume)
{
  auto* stream =
    vtkArrayDownCast<vtkUnsignedCharArray>(image->GetFieldData()->GetAbstractArray(StreamName));
  const vtkTypeInt64 needed =
    Volume::StreamBytesFor(volume->GetDimensions(), volume->GetBlockBits());
  if (!stream)
  {
    return Status::Error("its field data array ", StreamName, " is not an array of unsigned char");
  }
  if (needed < 0 || stream->GetNumberOfValues() < needed)
  {
    return Status::Error(StreamName, " is truncated: it has ", stream->GetNumberOfValues(),
      " bytes, ",
      needed < 0 ? "its dimensions need more than 2^60" : std::to_string(needed) + " are needed");
  }
  volume->SetStream(stream);
  return {};
}

//------------------------------------------------------------------------------
// Returns an array that only looks like metadata, as filters make of two volumes' arrays when they
// put both into one image; empty if there is none.
std::string FindForeignArray(vtkFieldData* fields)
{
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    const char* const given = fields->GetArrayName(i);
    const std::string name = given ? given : "";
    const bool isKnown =
      std::find(std::begin(AllNames), std::end(AllNames), name) != std::end(AllNames);
    if (name.rfind(StreamName, 0) == 0 && !isKnown)
    {
      return name;
    }
  }
  return {};
}

//------------------------------------------------------------------------------
// Checks that nothing of the metadata has changed. Comes after all that each array is checked for,
// which says more on what is wrong.
Status CheckMetadata(vtkImageData* image, Volume* volume)
{
  vtkFieldData* const fields = image->GetFieldData();
  int version = 0;
  const Status isOld = GetInteger(fields, VersionName, 1, FirstVersionWithChecksums - 1, version);
  if (isOld && !fields->HasArray(MetadataChecksumName) && !fields->HasArray(PageChecksumsName))
  {
    return {};
  }
  vtkTypeInt64 expected = 0;
  if (Status status = GetIntegers(fields, MetadataChecksumName, 1, &expected); !status)
  {
    return status;
  }
  volume->SetHasChecksums(true);
  const std::string foreign = FindForeignArray(fields);
  if (!foreign.empty())
  {
    return Status::Error("it has the stream of another volume, too (", foreign,
      "): put volumes into one image before they are compressed, or decompress them first");
  }
  if (static_cast<vtkTypeInt64>(ChecksumOfMetadata(fields)) == expected)
  {
    return {};
  }
  const Status ofRanges = RangeFormat::CheckRecords(Prefix, volume); // which say more
  return ofRanges ? Status::Error("its metadata (arrays of field data named ", Prefix,
                      "*) do not match their "
                      "checksum: they are damaged, or were changed or rounded by what wrote them")
                  : ofRanges;
}

//------------------------------------------------------------------------------
// Compares the stream with its checksums, if it has any, once: what is known to be intact is not
// looked at again until it is modified.
Status CheckStream(vtkImageData* image, Volume* volume)
{
  if (!volume->GetHasChecksums())
  {
    return {};
  }
  const vtkTypeInt64 pages = Checksums::NumberOfPages(
    Volume::StreamBytesFor(volume->GetDimensions(), volume->GetBlockBits()));
  auto* const checksums = vtkArrayDownCast<vtkTypeUInt32Array>(
    image->GetFieldData()->GetAbstractArray(PageChecksumsName));
  if (!checksums || checksums->GetNumberOfValues() != pages)
  {
    return Status::Error(
      "its field data array ", PageChecksumsName, " does not hold ", pages, " 32-bit integers");
  }
  if (Checksums::IsKnownIntact(volume->GetStream(), checksums))
  {
    return {};
  }
  const Status status = Checksums::CheckPages(volume, checksums);
  if (status)
  {
    Checksums::SetIntact(volume->GetStream(), checksums);
  }
  return status.WithPrefix(std::string(StreamName) + " ");
}

//------------------------------------------------------------------------------
Status ReadUnits(vtkImageData* image, Volume* volume)
{
  vtkFieldData* fields = image->GetFieldData();
  double offset = 0.0, scale = 1.0;
  for (const auto& [name, value] : { std::pair<const char*, double*>(OffsetName, &offset),
         std::pair<const char*, double*>(ScaleName, &scale) })
  {
    Status status = fields->HasArray(name) ? GetReals(fields, name, 1, value) : Status();
    if (!status)
    {
      return status;
    }
  }
  if (!std::isfinite(offset))
  {
    return Status::Error(OffsetName, " is not finite");
  }
  if (!(scale > 0.0 && std::isfinite(scale)))
  {
    return Status::Error(ScaleName, " is not a finite number above 0");
  }
  volume->SetOffset(offset);
  volume->SetScale(scale);
  return {};
}

//------------------------------------------------------------------------------
Status ReadErrors(vtkImageData* image, Volume* volume)
{
  vtkFieldData* fields = image->GetFieldData();
  if (fields->HasArray(ErrorName))
  {
    double errors[2];
    if (Status status = GetReals(fields, ErrorName, 2, errors); !status)
    {
      return status;
    }
    if (!(errors[0] >= 0.0 && errors[1] >= 0.0))
    {
      return Status::Error(ErrorName, " is not two numbers from 0");
    }
    volume->SetLargestError(errors[0]);
    volume->SetMeanError(errors[1]);
  }
  if (fields->HasArray(MacrocellErrorsName))
  {
    auto* macrocells =
      vtkArrayDownCast<vtkFloatArray>(fields->GetAbstractArray(MacrocellErrorsName));
    const vtkTypeInt64 number = MacrocellErrors::NumberFor(volume->GetDimensions());
    if (!macrocells || macrocells->GetNumberOfComponents() != 3 ||
      macrocells->GetNumberOfTuples() != number)
    {
      return Status::Error(MacrocellErrorsName, " is not ", number, " triples of floats");
    }
    volume->SetMacrocellErrors(macrocells);
  }
  return {};
}

//------------------------------------------------------------------------------
// Adds what the image's own ghost arrays hide to the masks: filters may have blanked it since.
void AddBlanking(vtkImageData* image, Volume* volume, vtkBlockMask& samples, vtkBlockMask& cells)
{
  vtkSmartPointer<vtkUnsignedCharArray> ofPoints = HidingFlags::FindForPoints(image);
  vtkSmartPointer<vtkUnsignedCharArray> ofCells = HidingFlags::FindForCells(image);
  int blocks[3];
  volume->GetBlocks(blocks);
  const int* const extent = volume->GetExtent();
  const int* const imageExtent = image->GetExtent();
  const auto add = [&](vtkBlockMask& mask, vtkUnsignedCharArray* flags, bool areOfCells)
  {
    if (flags)
    {
      mask = HidingFlags::AddToMask(mask, blocks, extent, flags, imageExtent, areOfCells);
    }
  };
  if (IsCellData(volume))
  {
    add(samples, HidingFlags::MergeIntoCells(ofPoints, ofCells, imageExtent), true);
    return;
  }
  add(samples, ofPoints, false);
  add(cells, ofCells, true);
}

//------------------------------------------------------------------------------
Status ReadHidden(vtkImageData* image, Volume* volume)
{
  vtkFieldData* fields = image->GetFieldData();
  const vtkTypeInt64 blocks = Volume::NumberOfBlocksFor(volume->GetDimensions());
  vtkBlockMask samples, cells;
  if (Status status = GetMask(fields, HiddenSamplesName, blocks, samples); !status)
  {
    return status;
  }
  if (Status status = GetMask(fields, HiddenCellsName, blocks, cells); !status)
  {
    return status;
  }
  if (IsCellData(volume) && !cells.IsEmpty())
  {
    return Status::Error(
      HiddenCellsName, " is there, but of cell data samples are hidden, not cells");
  }
  AddBlanking(image, volume, samples, cells);
  volume->SetHiddenSamples(samples);
  volume->SetHiddenCells(cells);
  return {};
}

//------------------------------------------------------------------------------
// Where the image's own ghost arrays hide more, its blocks have other ranges.
Status ReadRanges(vtkImageData* image, Volume* volume)
{
  const bool isBlanked = HidingFlags::FindForPoints(image) || HidingFlags::FindForCells(image);
  return isBlanked ? Status() : RangeFormat::Read(image->GetFieldData(), Prefix, volume);
}

//------------------------------------------------------------------------------
void StoreStream(Volume* volume, vtkFieldData* fields)
{
  vtkUnsignedCharArray* const stream = volume->GetStream();
  const auto checksums = Checksums::OfPages(
    stream, Volume::StreamBytesFor(volume->GetDimensions(), volume->GetBlockBits()));
  stream->SetName(StreamName);
  fields->AddArray(stream);
  checksums->SetName(PageChecksumsName);
  fields->AddArray(checksums);
  Checksums::SetIntact(stream, checksums);
}
}

//------------------------------------------------------------------------------
bool CompressedVolumeFormat::HasStream(vtkDataObject* object)
{
  return object && object->GetFieldData() && object->GetFieldData()->HasArray(StreamName);
}

//------------------------------------------------------------------------------
Status CompressedVolumeFormat::Read(vtkImageData* image, vtkCompressedVolume* volume)
{
  if (!HasStream(image))
  {
    return Status::Error(image ? "it has no field data array ProgIso.ZFP.Stream (compress it first)"
                               : "there is no image");
  }
  for (const auto& read : { ReadNumbers, ReadGeometry, ReadArrayName, ReadStream, ReadUnits,
         ReadErrors, ReadHidden, ReadRanges, CheckMetadata, CheckStream, LevelFormat::Read })
  {
    if (Status status = read(image, volume); !status)
    {
      return status;
    }
  }
  return {};
}

//------------------------------------------------------------------------------
void CompressedVolumeFormat::Write(vtkCompressedVolume* volume, vtkImageData* image)
{
  Remove(image);
  vtkFieldData* fields = image->GetFieldData();
  const int* extent = volume->GetExtent();
  extent = extent[0] > extent[1] ? image->GetExtent() : extent;
  StoreValue<vtkIntArray>(fields, VersionName, +Volume::FormatVersion);
  StoreValue<vtkIntArray>(fields, BlockBitsName, volume->GetBlockBits());
  StoreValues<vtkTypeInt64Array>(fields, DimensionsName, volume->GetDimensions(), 3);
  StoreValues<vtkDoubleArray>(fields, RangeName, volume->GetRange(), 2);
  StoreValue<vtkIntArray>(fields, ScalarTypeName, volume->GetScalarType());
  StoreValue<vtkIntArray>(fields, ComponentName, volume->GetComponent());
  StoreValue<vtkIntArray>(fields, AssociationName, volume->GetAssociation());
  StoreValues<vtkIntArray>(fields, ExtentName, extent, 6);
  StoreValues<vtkDoubleArray>(fields, GridName, SampleGrid::Of(image).Values, SampleGrid::Size);
  StoreValue<vtkStringArray>(fields, ArrayNameName, volume->GetArrayName());
  if (volume->HasUnits())
  {
    StoreValue<vtkDoubleArray>(fields, OffsetName, volume->GetOffset());
    StoreValue<vtkDoubleArray>(fields, ScaleName, volume->GetScale());
  }
  if (volume->GetLargestError() >= 0.0)
  {
    const double errors[] = { volume->GetLargestError(), volume->GetMeanError() };
    StoreValues<vtkDoubleArray>(fields, ErrorName, errors, 2);
  }
  if (vtkFloatArray* macrocells = volume->GetMacrocellErrors())
  {
    macrocells->SetName(MacrocellErrorsName);
    fields->AddArray(macrocells);
  }
  StoreMask(fields, HiddenSamplesName, volume->GetHiddenSamples());
  StoreMask(fields, HiddenCellsName, volume->GetHiddenCells());
  StoreStream(volume, fields);
  RangeFormat::Write(volume, Prefix, fields);
  // last: of what is there then
  StoreValue<vtkTypeUInt32Array>(fields, MetadataChecksumName, ChecksumOfMetadata(fields));
  LevelFormat::Write(volume,
    vtkArrayDownCast<vtkTypeUInt32Array>(fields->GetAbstractArray(PageChecksumsName)), fields);
}

//------------------------------------------------------------------------------
Status CompressedVolumeFormat::Place(vtkImageData* image)
{
  vtkTypeInt64 dims[3], extent[6];
  int association = 0;
  vtkFieldData* const fields = HasStream(image) ? image->GetFieldData() : nullptr;
  if (!fields)
  {
    return Status::Error("it has no field data array ", StreamName);
  }
  for (const Status& status : { GetIntegers(fields, DimensionsName, 3, dims),
         GetInteger(fields, AssociationName, Volume::PointData, Volume::CellData, association) })
  {
    if (!status)
    {
      return status;
    }
  }
  std::copy_n(image->GetExtent(), 6, extent);
  if (!Fits(extent, dims, association == Volume::CellData))
  {
    return Status::Error("it is a part of what its stream covers");
  }
  StoreValues<vtkIntArray>(fields, ExtentName, extent, 6);
  StoreValues<vtkDoubleArray>(fields, GridName, SampleGrid::Of(image).Values, SampleGrid::Size);
  if (fields->HasArray(MetadataChecksumName))
  {
    StoreValue<vtkTypeUInt32Array>(fields, MetadataChecksumName, ChecksumOfMetadata(fields));
  }
  image->Modified();
  return {};
}

//------------------------------------------------------------------------------
void CompressedVolumeFormat::SpeedUpRanges(vtkDataObject* object)
{
  vtkFieldData* const fields = HasStream(object) ? object->GetFieldData() : nullptr;
  if (fields)
  {
    StreamArray::Replace(fields, StreamName);
    ReplaceMask(fields, HiddenSamplesName);
    ReplaceMask(fields, HiddenCellsName);
    LevelFormat::SpeedUpRanges(fields);
  }
}

//------------------------------------------------------------------------------
void CompressedVolumeFormat::Remove(vtkDataObject* object)
{
  for (const char* name : AllNames)
  {
    object->GetFieldData()->RemoveArray(name);
  }
  RangeFormat::Remove(Prefix, object->GetFieldData());
  LevelFormat::Remove(object->GetFieldData());
}
