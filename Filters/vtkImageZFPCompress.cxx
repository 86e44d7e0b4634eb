// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageZFPCompress.h"

#include "vtkCellData.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkZFPBlocks.h"
#include "vtkZFPMemory.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>

vtkStandardNewMacro(vtkImageZFPCompress);

namespace
{
//------------------------------------------------------------------------------
// The active scalars, else the first array that is not VTK's ghost marker.
vtkDataArray* DefaultArray(vtkDataSetAttributes* attributes)
{
  if (attributes->GetScalars())
  {
    return attributes->GetScalars();
  }
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    const char* name = array ? array->GetName() : nullptr;
    if (array && !(name && !strcmp(name, vtkDataSetAttributes::GhostArrayName())))
    {
      return array;
    }
  }
  return nullptr;
}

//------------------------------------------------------------------------------
// "a, b" for an error message.
std::string ArrayNames(vtkImageData* image)
{
  std::string names;
  for (vtkDataSetAttributes* attributes :
    { static_cast<vtkDataSetAttributes*>(image->GetPointData()),
      static_cast<vtkDataSetAttributes*>(image->GetCellData()) })
  {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      const char* name = attributes->GetArrayName(i);
      names += (names.empty() ? "" : ", ") + std::string(name ? name : "(unnamed)");
    }
  }
  return names.empty() ? "none" : names;
}

//------------------------------------------------------------------------------
std::string NameOf(vtkDataArray* array)
{
  return array->GetName() && *array->GetName() ? array->GetName() : "scalars";
}

//------------------------------------------------------------------------------
// An array's tuples within `part` of `extent`, both in samples.
vtkSmartPointer<vtkDataArray> CutOut(vtkDataArray* array, const int extent[6], const int part[6])
{
  if (std::equal(part, part + 6, extent))
  {
    return array;
  }
  const vtkIdType row = part[1] - part[0] + 1;
  const vtkIdType rows[2] = { extent[1] - extent[0] + 1, extent[3] - extent[2] + 1 };
  auto cut = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  cut->SetName(array->GetName());
  cut->SetNumberOfComponents(array->GetNumberOfComponents());
  cut->SetNumberOfTuples(row * (part[3] - part[2] + 1) * (part[5] - part[4] + 1));
  vtkIdType end = 0;
  for (int z = part[4]; z <= part[5]; ++z)
  {
    for (int y = part[2]; y <= part[3]; ++y)
    {
      const vtkIdType begin =
        part[0] - extent[0] + rows[0] * (y - extent[2] + rows[1] * (z - extent[4]));
      cut->InsertTuples(end, row, begin, array);
      end += row;
    }
  }
  return cut;
}

//------------------------------------------------------------------------------
// Flags that hide, as vtkImageData::IsPointVisible() and IsCellVisible() see them.
constexpr unsigned char HidingPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr unsigned char HidingCell =
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

//------------------------------------------------------------------------------
// An image's ghost array, or null where no tuple has such a flag, or they are not one for each of
// `number` points or cells.
vtkUnsignedCharArray* FindHiding(
  vtkUnsignedCharArray* ghosts, vtkIdType number, unsigned char hiding)
{
  if (!ghosts || ghosts->GetNumberOfComponents() != 1 || ghosts->GetNumberOfTuples() != number)
  {
    return nullptr;
  }
  const unsigned char* begin = ghosts->GetPointer(0);
  const unsigned char* end = begin + ghosts->GetNumberOfValues();
  const bool found =
    std::any_of(begin, end, [=](unsigned char flags) { return (flags & hiding) != 0; });
  return found ? ghosts : nullptr;
}

//------------------------------------------------------------------------------
// Flags for the cells of an image: what their own say, or hidden for that of a corner.
vtkSmartPointer<vtkUnsignedCharArray> HideCells(
  vtkUnsignedCharArray* points, vtkUnsignedCharArray* cells, const int extent[6])
{
  if (!points)
  {
    return cells;
  }
  const vtkIdType dims[3] = { extent[1] - extent[0], extent[3] - extent[2], extent[5] - extent[4] };
  auto hidden = vtkSmartPointer<vtkUnsignedCharArray>::New();
  hidden->SetNumberOfValues(dims[0] * dims[1] * dims[2]);
  const vtkIdType row = dims[0] + 1, slice = row * (dims[1] + 1);
  for (vtkIdType i = 0; i < hidden->GetNumberOfValues(); ++i)
  {
    const vtkIdType first =
      i % dims[0] + row * (i / dims[0] % dims[1]) + slice * (i / dims[0] / dims[1]);
    unsigned char flags = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
      flags |=
        points->GetValue(first + (corner & 1) + row * (corner >> 1 & 1) + slice * (corner >> 2));
    }
    const bool hides = (flags & HidingPoint) || (cells && (cells->GetValue(i) & HidingCell));
    hidden->SetValue(i, hides ? vtkDataSetAttributes::HIDDENCELL : 0);
  }
  return hidden;
}

//------------------------------------------------------------------------------
// The mask of cells between samples, `size` of them per axis.
vtkBlockMask MaskCells(vtkUnsignedCharArray* flags, const int size[3])
{
  vtkBlockMask mask;
  const vtkIdType row = size[0] - 1, slice = row * (size[1] - 1);
  for (int z = 0; z < size[2]; z += 4)
  {
    for (int y = 0; y < size[1]; y += 4)
    {
      for (int x = 0; x < size[0]; x += 4)
      {
        vtkTypeUInt64 bits = 0;
        for (int i = 0; i < 64; ++i)
        {
          const int at[3] = { x + i % 4, y + i / 4 % 4, z + i / 16 };
          const bool exists = at[0] + 1 < size[0] && at[1] + 1 < size[1] && at[2] + 1 < size[2];
          if (exists && (flags->GetValue(at[0] + row * at[1] + slice * at[2]) & HidingCell))
          {
            bits |= vtkTypeUInt64(1) << i;
          }
        }
        mask.Append(bits);
      }
    }
  }
  return mask;
}

//------------------------------------------------------------------------------
// By identity: point and cell arrays may have the same name.
bool Contains(vtkDataSetAttributes* attributes, vtkDataArray* array)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    if (attributes->GetAbstractArray(i) == array)
    {
      return true;
    }
  }
  return false;
}
}

//------------------------------------------------------------------------------
vtkDataArray* vtkImageZFPCompress::FindDefaultArray(vtkImageData* image, int& association)
{
  vtkDataArray* array = DefaultArray(image->GetPointData());
  association = vtkCompressedVolume::PointData;
  if (!array)
  {
    array = DefaultArray(image->GetCellData());
    association = vtkCompressedVolume::CellData;
  }
  return array;
}

//------------------------------------------------------------------------------
double vtkImageZFPCompress::GetActualRate() const
{
  return vtkCompressedVolume::BlockBitsForRate(this->Rate) / 64.0;
}

//------------------------------------------------------------------------------
int vtkImageZFPCompress::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  vtkInformation* out = outputVector->GetInformationObject(0);
  out->CopyEntry(in, vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  out->CopyEntry(in, vtkDataObject::SPACING());
  out->CopyEntry(in, vtkDataObject::ORIGIN());
  out->CopyEntry(in, vtkDataObject::DIRECTION());
  // the output has no scalars
  out->Remove(vtkDataObject::POINT_DATA_VECTOR());
  out->Remove(vtkDataObject::CELL_DATA_VECTOR());
  return 1;
}

//------------------------------------------------------------------------------
// A stream is made of the whole image, or of this process' piece of it with ghost cells around.
int vtkImageZFPCompress::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  in->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
    in->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
  vtkInformationIntegerKey* ghosts =
    vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS();
  if (in->Get(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES()) > 1)
  {
    in->Set(ghosts, std::max(in->Get(ghosts), +vtkCompressedVolume::NumberOfGhostLevels));
  }
  return 1;
}

//------------------------------------------------------------------------------
// What of the input is compressed. Extents are the image's.
struct vtkImageZFPCompress::Part
{
  int Association = vtkCompressedVolume::PointData;
  int Whole[6];   // of all processes' pieces
  int Input[6];   // of the input, with ghost cells
  int Own[6];     // without
  int Covered[6]; // by the stream
  int Size[3];    // samples in the stream, per axis

  void Find(vtkImageData* input, vtkInformation* information);
  vtkSmartPointer<vtkDataArray> Cut(vtkDataArray* array, int association) const;
  vtkSmartPointer<vtkUnsignedCharArray> HiddenSamples(vtkImageData* input) const;
  vtkBlockMask HiddenCells(vtkImageData* input) const;
};

//------------------------------------------------------------------------------
void vtkImageZFPCompress::Part::Find(vtkImageData* input, vtkInformation* information)
{
  input->GetExtent(this->Input);
  information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), this->Whole);
  vtkCompressedVolume::GetOwnExtent(input, this->Own);
  std::copy_n(this->Input, 6, this->Covered);
  if (!std::equal(this->Own, this->Own + 6, this->Input))
  {
    vtkCompressedVolume::GetCoveringExtent(
      this->Own, this->Whole, this->Association, this->Covered);
  }
  const int cells = this->Association == vtkCompressedVolume::CellData ? 1 : 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    int* covered = this->Covered + 2 * axis;
    covered[0] = std::max(covered[0], this->Input[2 * axis]);
    covered[1] = std::min(covered[1], this->Input[2 * axis + 1]);
    this->Size[axis] = covered[1] - covered[0] + 1 - cells;
  }
}

//------------------------------------------------------------------------------
// What of an array of points, or of cells, the stream covers.
vtkSmartPointer<vtkDataArray> vtkImageZFPCompress::Part::Cut(
  vtkDataArray* array, int association) const
{
  int given[6], covered[6];
  for (int i = 0; i < 6; ++i)
  {
    const int fewer = association == vtkCompressedVolume::CellData ? i % 2 : 0;
    given[i] = this->Input[i] - fewer;
    covered[i] = this->Covered[i] - fewer;
  }
  return CutOut(array, given, covered);
}

//------------------------------------------------------------------------------
// Flags of the samples that are compressed; null where none is hidden.
vtkSmartPointer<vtkUnsignedCharArray> vtkImageZFPCompress::Part::HiddenSamples(
  vtkImageData* input) const
{
  vtkSmartPointer<vtkUnsignedCharArray> flags =
    FindHiding(input->GetPointGhostArray(), input->GetNumberOfPoints(), HidingPoint);
  if (this->Association == vtkCompressedVolume::CellData)
  {
    flags = HideCells(flags,
      FindHiding(input->GetCellGhostArray(), input->GetNumberOfCells(), HidingCell), this->Input);
  }
  return flags ? vtkUnsignedCharArray::SafeDownCast(this->Cut(flags, this->Association)) : nullptr;
}

//------------------------------------------------------------------------------
vtkBlockMask vtkImageZFPCompress::Part::HiddenCells(vtkImageData* input) const
{
  vtkUnsignedCharArray* flags =
    FindHiding(input->GetCellGhostArray(), input->GetNumberOfCells(), HidingCell);
  if (!flags || this->Association == vtkCompressedVolume::CellData)
  {
    return vtkBlockMask();
  }
  return MaskCells(
    vtkUnsignedCharArray::SafeDownCast(this->Cut(flags, vtkCompressedVolume::CellData)),
    this->Size);
}

//------------------------------------------------------------------------------
int vtkImageZFPCompress::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkImageData* input = vtkImageData::GetData(inputVector[0]);
  vtkImageData* output = vtkImageData::GetData(outputVector);
  this->SetErrorCode(vtkErrorCode::NoError);
  output->Initialize();
  output->CopyStructure(input);
  output->GetPointData()->Initialize(); // of ghost arrays that hide
  output->GetCellData()->Initialize();
  output->GetFieldData()->PassData(input->GetFieldData());
  vtkCompressedVolume::Remove(output);

  vtkInformation* in = inputVector[0]->GetInformationObject(0);
  if (vtkCompressedVolume::IsEmptyPiece(in))
  {
    return 1;
  }
  Part part;
  vtkDataArray* array = this->FindArray(inputVector, input, part.Association);
  if (!array)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    return 1;
  }
  part.Find(input, in);
  output->SetExtent(part.Own);
  if (output->GetNumberOfPoints() == 0)
  {
    return 1; // nothing but ghost cells
  }
  const std::string error = this->Check(input, array, part);
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
  }
  if (!error.empty() || !this->Compress(input, array, part, output))
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
  return 1; // the message is out already: the executive need not add its own
}

//------------------------------------------------------------------------------
vtkDataArray* vtkImageZFPCompress::FindArray(
  vtkInformationVector** inputVector, vtkImageData* input, int& association)
{
  vtkInformation* choice = this->GetInputArrayInformation(0);
  const char* name =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  const bool chosen = name && *name; // ParaView sends an empty name for "none chosen yet"
  vtkDataArray* array = this->GetInputArrayToProcess(0, inputVector);
  association = array && Contains(input->GetCellData(), array) ? vtkCompressedVolume::CellData
                                                               : vtkCompressedVolume::PointData;
  if (!array && !chosen)
  {
    array = FindDefaultArray(input, association);
  }
  if (!array && !chosen && vtkCompressedVolume::IsCompressed(input))
  {
    vtkErrorMacro("The input is a compressed volume already: decompress it first.");
  }
  else if (!array)
  {
    vtkErrorMacro(
      "There is no " << (chosen ? "point or cell array '" + std::string(name) + "'" : "array")
                     << " to compress; the input's arrays: " << ArrayNames(input) << ".");
  }
  return array;
}

//------------------------------------------------------------------------------
// What is wrong with the settings or the array's shape.
std::string vtkImageZFPCompress::Check(vtkImageData* input, vtkDataArray* array, Part& part)
{
  std::ostringstream error;
  const int* dims = part.Size;
  const vtkIdType samples = part.Association == vtkCompressedVolume::CellData
    ? input->GetNumberOfCells()
    : input->GetNumberOfPoints();
  if (vtkCompressedVolume::BlockBitsForRate(this->Rate) == 0)
  {
    error << "Rate is " << this->Rate << " bits per sample: it must be in (0, 32].";
  }
  else if (this->Component < 0 || this->Component >= array->GetNumberOfComponents())
  {
    error << "Component is " << this->Component << ", but array '" << NameOf(array) << "' has "
          << array->GetNumberOfComponents() << " component(s).";
  }
  else if (*std::min_element(dims, dims + 3) < 2)
  {
    error << "Only volumes can be compressed: array '" << NameOf(array) << "' has " << dims[0]
          << " x " << dims[1] << " x " << dims[2]
          << " samples, at least 2 along each axis are needed.";
  }
  else if (array->GetNumberOfTuples() != samples)
  {
    error << "Array '" << NameOf(array) << "' has " << array->GetNumberOfTuples()
          << " tuples, the image needs " << samples << ".";
  }
  return error.str();
}

//------------------------------------------------------------------------------
bool vtkImageZFPCompress::Compress(
  vtkImageData* input, vtkDataArray* array, const Part& part, vtkImageData* output)
{
  const int* dims = part.Size;
  const vtkSmartPointer<vtkDataArray> samples = part.Cut(array, part.Association);
  const vtkSmartPointer<vtkUnsignedCharArray> flags = part.HiddenSamples(input);
  vtkZFPBlocks::Hidden hidden;
  hidden.Flags = flags ? flags->GetPointer(0) : nullptr;
  hidden.Hiding = part.Association == vtkCompressedVolume::CellData ? HidingCell : HidingPoint;
  hidden.NotFinite = this->MaskNonFinite;
  vtkZFPBlocks::Units units = vtkZFPBlocks::Units::Find(samples, this->Component, hidden);
  const int blockBits = vtkCompressedVolume::BlockBitsForRate(this->Rate);
  vtkNew<vtkUnsignedCharArray> stream;
  const vtkTypeInt64 bytes = vtkCompressedVolume::StreamBytesFor(dims, blockBits);
  if (!vtkZFPMemory::Allocate(stream.Get(), bytes))
  {
    vtkErrorMacro("There is " << vtkZFPMemory::Objection("the stream", dims, bytes) << ".");
    return false;
  }
  vtkZFPBlocks blocks(dims, blockBits, stream->GetPointer(0), this->NumberOfThreads);
  vtkZFPBlocks::Summary summary;
  const auto encode = [&]()
  {
    summary = vtkZFPBlocks::Summary();
    hidden.Mask = vtkBlockMask();
    return blocks.Encode(samples, this->Component, 0, blocks.GetNumberOfLayers(), units, hidden,
      summary, vtkZFPBlocks::ReportOf(this));
  };
  if (!encode())
  {
    return false;
  }
  if (summary.IsTiny())
  {
    units.Enlarge(summary.Magnitude());
    if (!encode())
    {
      return false;
    }
  }
  const std::string error = summary.GetObjection();
  if (!error.empty())
  {
    vtkErrorMacro("Array '" << NameOf(array) << "' has " << error);
    return false;
  }

  vtkNew<vtkCompressedVolume> volume;
  volume->SetBlockBits(blockBits);
  volume->SetDimensions(dims);
  volume->SetOffset(units.Offset);
  volume->SetScale(units.Scale);
  volume->SetStoredRange(summary.GetRange()[0], summary.GetRange()[1]);
  volume->SetHiddenSamples(hidden.Mask);
  volume->SetHiddenCells(part.HiddenCells(input));
  volume->SetScalarType(array->GetDataType());
  volume->SetArrayName(NameOf(array));
  volume->SetComponent(this->Component);
  volume->SetAssociation(part.Association);
  volume->SetExtent(part.Covered);
  volume->SetStream(stream);
  volume->Write(output);
  return true;
}

//------------------------------------------------------------------------------
void vtkImageZFPCompress::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rate: " << this->Rate << " (actually " << this->GetActualRate() << ")\n";
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
