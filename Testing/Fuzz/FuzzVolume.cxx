// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Runs vtkCompressedVolume::Read() on field data in any state, and decompresses, contours, crops
// and writes what it accepts, also with levels of detail. What is written must be refused after the
// flip of any bit, and may not crash after worse.
#include "HostileImage.h"

#include <vtkFlyingEdges3D.h>
#include <vtkImageZFPDecompress.h>
#include <vtkPolyData.h>
#include <vtkZFPContour.h>

namespace
{
using namespace fuzz;

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> Decompress(vtkImageData* image)
{
  vtkNew<vtkImageZFPDecompress> decompress;
  decompress->SetInputData(image);
  return Update(decompress) ? decompress->GetOutput() : nullptr;
}

//------------------------------------------------------------------------------
vtkDataArray* SamplesOf(vtkImageData* image)
{
  vtkDataArray* samples = image->GetPointData()->GetScalars();
  return samples ? samples : image->GetCellData()->GetScalars();
}

//------------------------------------------------------------------------------
// Returns the extent of the samples: of points, or of cells.
void SampleExtent(vtkCompressedVolume* volume, int extent[6])
{
  volume->GetExtent(extent);
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis + 1] -= volume->GetAssociation() == vtkCompressedVolume::CellData ? 1 : 0;
  }
}

//------------------------------------------------------------------------------
// Decodes all samples of the stream, as those of an image with its extent.
vtkSmartPointer<vtkImageData> DecompressWhole(vtkCompressedVolume* volume)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(volume->GetExtent());
  volume->Write(image);
  vtkNew<vtkCompressedVolume> again;
  CHECK(again->Read(image), again->GetErrorMessage());
  const auto whole = Decompress(image);
  CHECK(whole, "not decompressed");
  return whole;
}

//------------------------------------------------------------------------------
// Checks that a cropped volume decodes to the same samples as the whole, bit for bit.
void CheckCrop(vtkCompressedVolume* volume, vtkImageData* whole, Bytes& bytes)
{
  int own[6], from[6], to[6];
  volume->GetExtent(own);
  SampleExtent(volume, from);
  for (int axis = 0; axis < 3; ++axis)
  {
    int* const bounds = own + 2 * axis;
    const int cells = bounds[1] - bounds[0];
    bounds[0] += bytes.Below(cells);
    bounds[1] -= bytes.Below(bounds[1] - bounds[0]);
  }
  volume->Crop(own);
  SampleExtent(volume, to);
  const auto part = DecompressWhole(volume);
  vtkDataArray* const all = SamplesOf(whole);
  vtkDataArray* const cut = SamplesOf(part);
  const int bytesOfOne = all->GetDataTypeSize();
  vtkIdType next = 0;
  for (int z = to[4]; z <= to[5]; ++z)
  {
    for (int y = to[2]; y <= to[3]; ++y)
    {
      const vtkIdType row = from[1] - from[0] + 1, rows = from[3] - from[2] + 1;
      const vtkIdType first = to[0] - from[0] + row * (y - from[2] + rows * (z - from[4]));
      const vtkIdType count = to[1] - to[0] + 1;
      CHECK(std::memcmp(cut->GetVoidPointer(next), all->GetVoidPointer(first),
              static_cast<std::size_t>(bytesOfOne) * count) == 0,
        "row " << y << " of slice " << z);
      next += count;
    }
  }
  CHECK(next == cut->GetNumberOfValues(), next);
}

//------------------------------------------------------------------------------
void CheckContour(
  vtkImageData* image, vtkCompressedVolume* volume, vtkImageData* whole, Bytes& bytes)
{
  vtkNew<vtkZFPContour> contour;
  contour->SetInputData(image);
  contour->SetBrickSize(bytes.Below(40));
  contour->SetComputeGradients(bytes.Flag());
  contour->SetComputeNormals(bytes.Flag());
  contour->SetNumberOfThreads(1);
  const int values = bytes.Below(3);
  for (int i = 0; i < values; ++i)
  {
    contour->SetValue(i, bytes.Number());
  }
  // the isovalues include samples, which are rarely between other samples
  auto* const samples = SamplesOf(whole);
  for (int i = 0; i < 1; ++i)
  {
    const vtkIdType at = bytes.Take<std::uint16_t>() % samples->GetNumberOfTuples();
    contour->SetValue(values + i, samples->GetComponent(at, 0));
  }
  int own[6];
  vtkCompressedVolume::GetOwnExtent(image, own); // what other pieces own is not contoured
  if (!Update(contour) || values > 0 || !std::equal(own, own + 6, image->GetExtent()) ||
    volume->GetAssociation() != vtkCompressedVolume::PointData || !volume->Covers(image) ||
    volume->HidesAny() || volume->HasUnits())
  {
    return;
  }
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(whole);
  edges->SetValue(0, contour->GetValue(0));
  edges->ComputeNormalsOff();
  edges->Update();
  CHECK(contour->GetOutput()->GetNumberOfPolys() == edges->GetOutput()->GetNumberOfPolys() &&
      contour->GetOutput()->GetNumberOfPoints() == edges->GetOutput()->GetNumberOfPoints(),
    contour->GetOutput()->GetNumberOfPoints()
      << " points, not " << edges->GetOutput()->GetNumberOfPoints());
}
}

namespace
{
//------------------------------------------------------------------------------
// Stores a volume with checksums, in memory of its own.
vtkSmartPointer<vtkImageData> WithChecksums(vtkCompressedVolume* volume)
{
  vtkNew<vtkImageData> image;
  image->SetExtent(volume->GetExtent());
  volume->Write(image);
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->DeepCopy(image);
  return copy;
}

//------------------------------------------------------------------------------
// Flips one bit of an array of numbers that checksums cover.
void CheckFlip(vtkCompressedVolume* volume, Bytes& bytes)
{
  const auto image = WithChecksums(volume);
  vtkFieldData* const fields = image->GetFieldData();
  vtkNew<vtkCompressedVolume> again;
  CHECK(again->Read(image) && again->GetHasChecksums(), again->GetErrorMessage());
  auto* const array = vtkArrayDownCast<vtkDataArray>(
    fields->GetAbstractArray(FieldArrays[bytes.Below(NumberOfFieldArrays)].Name));
  if (!array || array->GetNumberOfValues() == 0)
  {
    return;
  }
  const bool isStream = array == fields->GetArray("ProgIso.ZFP.Stream");
  const vtkTypeInt64 size = isStream
    ? vtkCompressedVolume::StreamBytesFor(volume->GetDimensions(), volume->GetBlockBits())
    : array->GetNumberOfValues() * array->GetDataTypeSize();
  const vtkTypeInt64 at = bytes.Take<std::uint32_t>() % size;
  static_cast<unsigned char*>(array->GetVoidPointer(0))[at] ^= 1 << bytes.Below(8);
  array->Modified();
  CHECK(!again->Read(image), array->GetName() << " byte " << at);
}

//------------------------------------------------------------------------------
// Damages arrays of a volume with checksums.
void CheckDamage(vtkCompressedVolume* volume, Bytes& bytes)
{
  const auto image = WithChecksums(volume);
  DamageOne(image, bytes);
  vtkNew<vtkCompressedVolume> again;
  const bool accepted = again->Read(image);
  CHECK(accepted == (Decompress(image) != nullptr), again->GetErrorMessage());
}
}

namespace
{
//------------------------------------------------------------------------------
vtkBlockMask MakeMask(const int dims[3], Bytes& bytes)
{
  vtkBlockMask mask;
  const vtkTypeInt64 blocks = vtkCompressedVolume::NumberOfBlocksFor(dims);
  const bool hides = bytes.Flag();
  for (vtkTypeInt64 block = 0; block < blocks && hides; ++block)
  {
    mask.Append(bytes.Flag() ? bytes.Take<vtkTypeUInt64>() : 0);
  }
  return mask;
}

//------------------------------------------------------------------------------
// Makes a level of the one before, or sometimes of what cannot be one.
vtkSmartPointer<vtkCompressedVolume> MakeLevel(vtkCompressedVolume* before, Bytes& bytes)
{
  int dims[3], steps[3];
  before->GetDimensions(dims);
  before->GetSteps(steps);
  const int halves = bytes.Below(8);
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool isHalved = (halves >> axis & 1) && dims[axis] > 2;
    dims[axis] = isHalved ? dims[axis] / 2 + 1 : dims[axis];
    steps[axis] *= isHalved ? 2 : 1;
  }
  const bool hostile = bytes.Byte() >= 192;
  if (hostile)
  {
    dims[bytes.Below(3)] = 1 + bytes.Below(40);
    steps[bytes.Below(3)] = static_cast<int>(bytes.Integer());
  }
  auto level = vtkSmartPointer<vtkCompressedVolume>::New();
  level->SetDimensions(dims);
  level->SetSteps(steps);
  level->SetBlockBits(9 + bytes.Below(2040));
  level->SetRange(hostile ? bytes.Number() : 0.0, hostile ? bytes.Number() : 1.0);
  level->SetLargestError(hostile ? bytes.Number() : 0.5);
  level->SetMeanError(hostile ? bytes.Number() : 0.5);
  level->SetLargestDistance(hostile ? bytes.Number() : 0.5);
  level->SetHiddenSamples(MakeMask(dims, bytes));
  level->SetHiddenCells(MakeMask(dims, bytes));
  vtkNew<vtkUnsignedCharArray> stream;
  stream->SetNumberOfValues(vtkCompressedVolume::StreamBytesFor(dims, level->GetBlockBits()));
  bytes.Fill(stream->GetPointer(0), stream->GetNumberOfValues());
  level->SetStream(stream);
  return level;
}

//------------------------------------------------------------------------------
// Decodes all levels that are accepted.
void CheckDecoding(vtkImageData* image, vtkCompressedVolume* volume)
{
  for (int i = 1; i <= volume->GetNumberOfLevels(); ++i)
  {
    vtkNew<vtkImageZFPDecompress> decompress;
    decompress->SetInputData(image);
    decompress->SetLevel(i);
    CHECK(Update(decompress), "level " << i << " not decompressed");
    const int* const dims = volume->GetLevel(i)->GetDimensions();
    CHECK(SamplesOf(decompress->GetOutput())->GetNumberOfTuples() ==
        static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2],
      "level " << i);
  }
}

//------------------------------------------------------------------------------
// Damages one array of a level: a bit flips, or it is cut short, or goes.
void DamageLevel(vtkFieldData* fields, Bytes& bytes)
{
  const char* const names[] = { "Stream", "BlockBits", "Dimensions", "Steps", "Range", "Error",
    "Distance", "HiddenSamples", "HiddenCells", "PageChecksums", "Checksum" };
  const std::string name = "ProgIso.Level1." + std::string(names[bytes.Below(11)]);
  auto* const array = vtkArrayDownCast<vtkDataArray>(fields->GetAbstractArray(name.c_str()));
  const int kind = bytes.Below(4);
  if (!array || kind == 0)
  {
    fields->RemoveArray(array ? name.c_str() : "ProgIso.Level1.Steps");
  }
  else if (kind == 1)
  {
    array->SetNumberOfTuples(array->GetNumberOfTuples() - 1);
  }
  else
  {
    const vtkTypeInt64 size = array->GetNumberOfValues() * array->GetDataTypeSize();
    const vtkTypeInt64 at = bytes.Take<std::uint32_t>() % size;
    static_cast<unsigned char*>(array->GetVoidPointer(0))[at] ^= 1 << bytes.Below(8);
    array->Modified();
  }
}

//------------------------------------------------------------------------------
void CheckLevels(vtkImageData* source, Bytes& bytes)
{
  vtkNew<vtkCompressedVolume> volume, again;
  CHECK(volume->Read(source), volume->GetErrorMessage());
  const int number = 1 + bytes.Below(3);
  vtkCompressedVolume* before = volume;
  for (int i = 0; i < number; ++i)
  {
    const auto level = MakeLevel(before, bytes);
    volume->AddLevel(level);
    before = level;
  }
  const auto image = WithChecksums(volume);
  const bool accepted = again->Read(image);
  CHECK(accepted == (again->GetNumberOfLevels() == number), again->GetErrorMessage());
  CHECK(accepted || again->GetErrorMessage().find("level") != std::string::npos,
    again->GetErrorMessage());
  if (accepted)
  {
    CheckDecoding(image, again);
    DamageLevel(image->GetFieldData(), bytes);
    CHECK(!again->Read(image) && again->GetNumberOfLevels() == 0, "a damaged level");
  }
}
}

//------------------------------------------------------------------------------
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  Bytes bytes(data, size);
  const vtkSmartPointer<vtkImageData> image = HostileImage(bytes);
  int own[6];
  vtkCompressedVolume::GetOwnExtent(image, own);
  vtkNew<vtkCompressedVolume> volume;
  const bool accepted = volume->Read(image);
  CHECK(accepted == volume->GetErrorMessage().empty(), volume->GetErrorMessage());
  CHECK(accepted == (volume->GetStream() != nullptr), "stream");
  const auto decompressed = Decompress(image);
  CHECK(accepted == (decompressed != nullptr), volume->GetErrorMessage());
  if (!accepted)
  {
    vtkNew<vtkZFPContour> contour;
    contour->SetInputData(image);
    CHECK(!Update(contour), "contoured");
    return 0;
  }
  const auto whole = DecompressWhole(volume);
  CheckContour(image, volume, whole, bytes);
  CheckFlip(volume, bytes);
  CheckDamage(volume, bytes);
  CheckCrop(volume, whole, bytes);
  CheckLevels(image, bytes);
  return 0;
}
