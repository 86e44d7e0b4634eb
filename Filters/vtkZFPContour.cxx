// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkZFPContour.h"

#include "Codec/BlockStream.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkImageTransform.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkZFPBrickContour.h"
#include "vtkZFPBricks.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkZFPContour);

namespace
{
// Bricks that a thread has in a batch, after which progress is reported: fewer, and threads wait
// for one another often.
constexpr vtkIdType BricksPerBatch = 16;
// Fraction of the work that is decoding and contouring; the rest is joining.
constexpr double ExtractedFraction = 0.95;

//------------------------------------------------------------------------------
// The image whose points are the stream's samples: for cell data that of the cells' centres.
vtkSmartPointer<vtkImageData> SampleGeometry(vtkImageData* image, vtkCompressedVolume* volume)
{
  auto geometry = vtkSmartPointer<vtkImageData>::New();
  geometry->CopyStructure(image);
  geometry->SetExtent(volume->GetExtent());
  if (volume->GetAssociation() == vtkCompressedVolume::CellData)
  {
    int extent[6];
    double origin[3];
    volume->GetExtent(extent);
    image->TransformContinuousIndexToPhysicalPoint(0.5, 0.5, 0.5, origin);
    geometry->SetExtent(
      extent[0], extent[1] - 1, extent[2], extent[3] - 1, extent[4], extent[5] - 1);
    geometry->SetOrigin(origin);
  }
  return geometry;
}

//------------------------------------------------------------------------------
// Marks those triangles, in the samples' index space, that lie beyond the image's extent: a piece
// of a volume has samples around it, and the triangles there are another piece's.
void MarkGhosts(vtkPolyData* surface, const int extent[6], const int samples[6])
{
  vtkCellArray* triangles = surface->GetPolys();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(triangles->GetNumberOfCells());
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < triangles->GetNumberOfCells(); ++i)
  {
    triangles->GetCellAtId(i, corners);
    bool own = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      double middle = 0.0; // it lies in one cell, hence its middle too
      for (const vtkIdType corner : *corners)
      {
        middle += surface->GetPoint(corner)[axis] / 3.0;
      }
      const int end = extent[2 * axis + 1];
      own = own && middle >= extent[2 * axis] && (middle < end || end == samples[2 * axis + 1]);
    }
    ghosts->SetValue(i, own ? 0 : vtkDataSetAttributes::DUPLICATECELL);
  }
  surface->GetCellData()->AddArray(ghosts);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkFloatArray> NewVectors(const char* name, vtkIdType number)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(number);
  return array;
}

//------------------------------------------------------------------------------
// Moves values to their place in an array, if there is one.
void Hand(std::vector<float>& values, vtkFloatArray* array, vtkIdType firstTuple)
{
  if (array)
  {
    std::copy(values.begin(), values.end(), array->GetPointer(3 * firstTuple));
  }
  std::vector<float>().swap(values);
}
}

//------------------------------------------------------------------------------
// What is remembered between updates: the ranges of bricks that have been decoded once.
struct vtkZFPContour::Ranges
{
  // VTK never gives the same modified time twice: the stream's says which stream it is.
  bool IsOf(vtkCompressedVolume* volume, int brickSize) const
  {
    return this->StreamTime == volume->GetStream()->GetMTime() && this->BrickSize == brickSize &&
      this->BlockBits == volume->GetBlockBits() &&
      std::equal(this->Dimensions, this->Dimensions + 3, volume->GetDimensions());
  }

  void Reset(vtkCompressedVolume* volume, int brickSize, vtkIdType bricks)
  {
    this->StreamTime = volume->GetStream()->GetMTime();
    this->BrickSize = brickSize;
    this->BlockBits = volume->GetBlockBits();
    volume->GetDimensions(this->Dimensions);
    this->Values.assign(bricks, { 0.0f, 0.0f });
    this->Known.assign(bricks, 0);
  }

  vtkMTimeType StreamTime = 0;
  int BrickSize = 0;
  int BlockBits = 0;
  int Dimensions[3] = { 0, 0, 0 };
  std::vector<vtkZFPBricks::Range> Values;
  std::vector<unsigned char> Known; // not vector<bool>: threads write side by side
};

//------------------------------------------------------------------------------
// One update.
class vtkZFPContour::Work
{
public:
  Work(vtkZFPContour* self, vtkCompressedVolume* volume, const int extentStart[3])
    : Self(self)
    , Stream(BlockStream::Align(volume->GetStream()))
    , Blocks(volume->GetDimensions(), volume->GetBlockBits(), this->Stream->GetPointer(0), 1)
    , Bricks(volume->GetDimensions(), self->BrickSize)
    , Contour(this->Bricks, extentStart)
    , Hidden(volume->GetCellsWithoutSurface())
    , BrickRanges(*self->BrickRanges)
  {
    for (int i = 0; i < self->GetNumberOfContours(); ++i)
    {
      this->Values.push_back(volume->ToStored(self->GetValue(i)));
    }
    this->Contour.Scale = volume->GetScale();
    this->Contour.ComputeNormals = self->ComputeNormals;
    this->Contour.ComputeGradients = self->ComputeGradients;
    this->Contour.Hidden = this->Hidden.IsEmpty() ? nullptr : &this->Hidden;
    if (!this->BrickRanges.IsOf(volume, self->BrickSize))
    {
      this->BrickRanges.Reset(volume, self->BrickSize, this->Bricks.GetNumberOfBricks());
    }
  }

  bool Extract();
  void Join(vtkPolyData* output, const std::string& scalarName);

private:
  // Decoded samples, whose bytes are counted while they are held.
  struct CountedSamples : vtkZFPBricks::Samples
  {
    explicit CountedSamples(Work& work)
      : Owner(work)
    {
    }
    ~CountedSamples() { this->Owner.SampleBytes -= this->Counted; }
    CountedSamples(const CountedSamples&) = delete;
    void operator=(const CountedSamples&) = delete;
    void Count();

    Work& Owner;
    vtkTypeInt64 Counted = 0;
  };

  bool MayHold(vtkIdType brick) const;
  void ExtractBrick(vtkIdType brick, CountedSamples& samples);
  void CollectParts();
  vtkSmartPointer<vtkFloatArray> MakeScalars(vtkIdType points, const std::string& name) const;

  vtkZFPContour* Self;
  vtkSmartPointer<vtkUnsignedCharArray> Stream;
  BlockStream Blocks;
  vtkZFPBricks Bricks;
  vtkZFPBrickContour Contour;
  vtkBlockMask Hidden;
  Ranges& BrickRanges;
  std::vector<double> Values; // in the stream's units
  // for every isovalue, one after the other, the part of every brick; null where there is none
  std::vector<std::unique_ptr<vtkZFPBrickContour::Part>> Parts;
  std::vector<vtkIdType> Held; // those of Parts that are not null
  std::atomic<vtkIdType> Decoded{ 0 };
  std::atomic<vtkTypeInt64> SampleBytes{ 0 };
  std::atomic<vtkTypeInt64> PeakSampleBytes{ 0 };
};

//------------------------------------------------------------------------------
void vtkZFPContour::Work::CountedSamples::Count()
{
  const vtkTypeInt64 bytes = static_cast<vtkTypeInt64>(sizeof(float) * this->Values.capacity());
  const vtkTypeInt64 now = this->Owner.SampleBytes += bytes - this->Counted;
  this->Counted = bytes;
  vtkTypeInt64 peak = this->Owner.PeakSampleBytes;
  while (now > peak && !this->Owner.PeakSampleBytes.compare_exchange_weak(peak, now))
  {
  }
}

//------------------------------------------------------------------------------
// Whether a brick holds an isovalue, or it is not known yet.
bool vtkZFPContour::Work::MayHold(vtkIdType brick) const
{
  const vtkZFPBricks::Range range = this->BrickRanges.Values[brick];
  return !this->BrickRanges.Known[brick] ||
    std::any_of(
      this->Values.begin(), this->Values.end(), [&](double value) { return range.Holds(value); });
}

//------------------------------------------------------------------------------
// Fills Parts; false when aborted. Batches, since progress comes from this thread alone: observers
// need not expect others.
bool vtkZFPContour::Work::Extract()
{
  const vtkIdType bricks = this->Bricks.GetNumberOfBricks();
  std::vector<vtkIdType> wanted;
  for (vtkIdType brick = 0; brick < bricks; ++brick)
  {
    if (this->MayHold(brick))
    {
      wanted.push_back(brick);
    }
  }
  this->Parts.resize(bricks * this->Values.size());
  const vtkIdType number = static_cast<vtkIdType>(wanted.size());
  const vtkIdType batch = BricksPerBatch * vtkSMPTools::GetEstimatedNumberOfThreads();
  for (vtkIdType first = 0; first < number && !this->Self->GetAbortExecute(); first += batch)
  {
    vtkSMPTools::For(first, std::min(first + batch, number), 1,
      [&](vtkIdType begin, vtkIdType end)
      {
        CountedSamples samples(*this);
        std::for_each(wanted.begin() + begin, wanted.begin() + end,
          [&](vtkIdType brick) { this->ExtractBrick(brick, samples); });
      });
    this->Self->UpdateProgress(
      ExtractedFraction * static_cast<double>(std::min(first + batch, number)) / number);
  }
  this->Self->NumberOfBricks = bricks;
  this->Self->NumberOfDecodedBricks = this->Decoded;
  this->Self->PeakSampleBytes = this->PeakSampleBytes;
  return !this->Self->GetAbortExecute();
}

//------------------------------------------------------------------------------
void vtkZFPContour::Work::ExtractBrick(vtkIdType brick, CountedSamples& samples)
{
  this->Bricks.Decode(this->Blocks, brick, this->Contour.GetHalo(), samples);
  samples.Count();
  ++this->Decoded;
  const vtkZFPBricks::Range range = this->Bricks.FindRange(brick, samples);
  this->BrickRanges.Values[brick] = range;
  this->BrickRanges.Known[brick] = 1;
  for (std::size_t i = 0; i < this->Values.size(); ++i)
  {
    if (range.Holds(this->Values[i]))
    {
      this->Parts[i * this->Bricks.GetNumberOfBricks() + brick] =
        this->Contour.Extract(brick, samples, this->Values[i]);
    }
  }
}

//------------------------------------------------------------------------------
// Lists the parts that there are, and numbers their points and triangles.
void vtkZFPContour::Work::CollectParts()
{
  vtkIdType points = 0;
  vtkIdType triangles = 0;
  for (std::size_t i = 0; i < this->Parts.size(); ++i)
  {
    if (vtkZFPBrickContour::Part* const part = this->Parts[i].get())
    {
      this->Held.push_back(static_cast<vtkIdType>(i));
      part->FirstPoint = points;
      part->FirstTriangle = triangles;
      points += part->GetNumberOfPoints();
      triangles += part->GetNumberOfTriangles();
    }
  }
}

//------------------------------------------------------------------------------
// Puts the parts together, and frees them on the way.
void vtkZFPContour::Work::Join(vtkPolyData* output, const std::string& scalarName)
{
  this->CollectParts();
  const auto* last = this->Held.empty() ? nullptr : this->Parts[this->Held.back()].get();
  const vtkIdType points = last ? last->FirstPoint + last->GetNumberOfPoints() : 0;
  const vtkIdType triangles = last ? last->FirstTriangle + last->GetNumberOfTriangles() : 0;
  const auto coordinates = NewVectors("Points", points);
  const auto normals = this->Contour.ComputeNormals ? NewVectors("Normals", points) : nullptr;
  const auto gradients = this->Contour.ComputeGradients ? NewVectors("Gradients", points) : nullptr;
  const auto scalars = this->Self->ComputeScalars ? this->MakeScalars(points, scalarName) : nullptr;
  vtkNew<vtkTypeInt64Array> corners;
  corners->SetNumberOfValues(3 * triangles);
  vtkSMPTools::For(0, static_cast<vtkIdType>(this->Held.size()), 1,
    [&](vtkIdType begin, vtkIdType end)
    {
      const vtkIdType bricks = this->Bricks.GetNumberOfBricks();
      for (vtkIdType i = begin; i < end; ++i)
      {
        vtkZFPBrickContour::Part& part = *this->Parts[this->Held[i]];
        const auto* const parts = this->Parts.data() + (this->Held[i] - part.Brick);
        this->Contour.Join(part, parts, corners->GetPointer(3 * part.FirstTriangle));
        Hand(part.Points, coordinates, part.FirstPoint);
        Hand(part.Normals, normals, part.FirstPoint);
        Hand(part.Gradients, gradients, part.FirstPoint);
        std::vector<int>().swap(part.Corners);
      }
    });
  vtkNew<vtkPoints> newPoints;
  newPoints->SetData(coordinates);
  output->SetPoints(newPoints);
  vtkNew<vtkCellArray> polys;
  polys->SetData(3, corners);
  output->SetPolys(polys);
  output->GetPointData()->SetScalars(scalars);
  output->GetPointData()->SetNormals(normals);
  output->GetPointData()->SetVectors(gradients);
}

//------------------------------------------------------------------------------
// Every point's isovalue.
vtkSmartPointer<vtkFloatArray> vtkZFPContour::Work::MakeScalars(
  vtkIdType points, const std::string& name) const
{
  auto scalars = vtkSmartPointer<vtkFloatArray>::New();
  scalars->SetName(name.c_str());
  scalars->SetNumberOfValues(points);
  for (const vtkIdType held : this->Held)
  {
    const vtkZFPBrickContour::Part& part = *this->Parts[held];
    std::fill_n(scalars->GetPointer(part.FirstPoint), part.GetNumberOfPoints(),
      static_cast<float>(this->Self->GetValue(held / this->Bricks.GetNumberOfBricks())));
  }
  return scalars;
}

//------------------------------------------------------------------------------
vtkZFPContour::vtkZFPContour()
  : BrickRanges(std::make_unique<Ranges>())
{
}

//------------------------------------------------------------------------------
vtkZFPContour::~vtkZFPContour() = default;

//------------------------------------------------------------------------------
vtkMTimeType vtkZFPContour::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->ContourValues->GetMTime());
}

//------------------------------------------------------------------------------
void vtkZFPContour::SetBrickSize(int size)
{
  size = std::min(std::max(size, 4), 256) / 4 * 4;
  if (this->BrickSize != size)
  {
    this->BrickSize = size;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkZFPContour::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

//------------------------------------------------------------------------------
// Blocks lie across any cut through the image: the whole is taken.
int vtkZFPContour::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  in->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
    in->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
  return 1;
}

//------------------------------------------------------------------------------
bool vtkZFPContour::Refuse(const std::string& reason)
{
  vtkErrorMacro(<< reason);
  this->SetErrorCode(vtkErrorCode::UserError);
  return false;
}

//------------------------------------------------------------------------------
bool vtkZFPContour::CheckValues()
{
  for (int i = 0; i < this->GetNumberOfContours(); ++i)
  {
    if (!std::isfinite(this->GetValue(i)))
    {
      std::ostringstream reason;
      reason << "Isovalue " << i << " is " << this->GetValue(i) << ": it must be finite.";
      return this->Refuse(reason.str());
    }
  }
  return true;
}

//------------------------------------------------------------------------------
int vtkZFPContour::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  this->NumberOfBricks = this->NumberOfDecodedBricks = 0;
  this->PeakSampleBytes = 0;
  vtkCompressedVolume::Remove(output); // the executive has passed all field data
  if (vtkCompressedVolume::IsEmptyPiece(inputVector[0]->GetInformationObject(0)))
  {
    return 1;
  }
  vtkNew<vtkCompressedVolume> volume;
  if (!volume->Read(input))
  {
    this->Refuse("The input is " + volume->GetErrorMessage() + ".");
    return 1; // the message is out already: the executive need not add its own
  }
  if (!this->CheckValues())
  {
    return 1;
  }
  const auto geometry = SampleGeometry(input, volume);
  const int* const extent = geometry->GetExtent();
  const int extentStart[3] = { extent[0], extent[2], extent[4] };
  Work work(this, volume, extentStart);
  const std::string backend = vtkSMPTools::GetBackend();
  const vtkSMPTools::Config config(this->NumberOfThreads,
    this->NumberOfThreads != 1 && backend == "Sequential" ? "STDThread" : backend, false);
  vtkSMPTools::LocalScope(config,
    [&]()
    {
      if (work.Extract())
      {
        work.Join(output, volume->GetArrayName());
        if (!volume->Covers(input))
        {
          MarkGhosts(output, input->GetExtent(), extent);
        }
        vtkImageTransform::TransformPointSet(geometry, output);
        this->UpdateProgress(1.0);
      }
    });
  return 1;
}

//------------------------------------------------------------------------------
void vtkZFPContour::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ContourValues:\n";
  this->ContourValues->PrintSelf(os, indent.GetNextIndent());
  os << indent << "ComputeNormals: " << (this->ComputeNormals ? "on\n" : "off\n");
  os << indent << "ComputeGradients: " << (this->ComputeGradients ? "on\n" : "off\n");
  os << indent << "ComputeScalars: " << (this->ComputeScalars ? "on\n" : "off\n");
  os << indent << "BrickSize: " << this->BrickSize << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfBricks: " << this->NumberOfBricks << "\n";
  os << indent << "NumberOfDecodedBricks: " << this->NumberOfDecodedBricks << "\n";
  os << indent << "PeakSampleBytes: " << this->PeakSampleBytes << "\n";
}
