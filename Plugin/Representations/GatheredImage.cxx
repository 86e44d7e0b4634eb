// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "GatheredImage.h"

#include "DistributedPieces.h"

#include "Format/SampleGrid.h"
#include "Pieces/PieceExtents.h"

#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace
{
//------------------------------------------------------------------------------
// A box of points, or of cells: where they lie in an array, x fastest.
struct Box
{
  Box(const int extent[6], int association)
  {
    const int fewer = association == vtkDataObject::CELL ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->First[axis] = extent[2 * axis];
      this->Size[axis] = extent[2 * axis + 1] - extent[2 * axis] + 1 - fewer;
    }
  }

  vtkIdType Count() const { return this->Size[0] * this->Size[1] * this->Size[2]; }
  vtkIdType IndexOf(vtkIdType x, vtkIdType y, vtkIdType z) const
  {
    return x - this->First[0] +
      this->Size[0] * (y - this->First[1] + this->Size[1] * (z - this->First[2]));
  }

  vtkIdType First[3];
  vtkIdType Size[3];
};

//------------------------------------------------------------------------------
// A piece's image, and its extents in the whole: all of it, and what is not ghost cells.
struct Piece
{
  vtkImageData* Image;
  int All[6];
  int Own[6];
};

//------------------------------------------------------------------------------
// Places pieces in the grid of the first.
Status PlacePieces(const GatheredImage::Images& images, std::vector<Piece>& pieces)
{
  const SampleGrid grid = SampleGrid::Of(images.front());
  for (const auto& image : images)
  {
    int shift[3];
    if (!grid.FindShift(image, shift))
    {
      return Status::Error(
        "The pieces of the image are not of one grid: their spacings, origins or "
        "directions do not fit each other.");
    }
    Piece piece = { image, {}, {} };
    PieceExtents::GetExtentWithoutGhosts(image, piece.Own);
    for (int i = 0; i < 6; ++i)
    {
      piece.All[i] = image->GetExtent()[i] + shift[i / 2];
      piece.Own[i] += shift[i / 2];
    }
    if (!PieceExtents::IsEmpty(piece.Own))
    {
      pieces.push_back(piece);
    }
  }
  return {};
}

//------------------------------------------------------------------------------
// Copies a piece's own tuples into the whole, row by row.
void CopyOwn(
  vtkDataArray* from, const Piece& piece, int association, vtkDataArray* to, const Box& whole)
{
  const Box all(piece.All, association), own(piece.Own, association);
  for (vtkIdType z = own.First[2]; z < own.First[2] + own.Size[2]; ++z)
  {
    for (vtkIdType y = own.First[1]; y < own.First[1] + own.Size[1]; ++y)
    {
      to->InsertTuples(
        whole.IndexOf(own.First[0], y, z), own.Size[0], all.IndexOf(own.First[0], y, z), from);
    }
  }
}

//------------------------------------------------------------------------------
// Puts an array of all pieces into the whole.
Status AssembleArray(const std::vector<Piece>& pieces, const std::string& name, int association,
  const Box& whole, vtkDataArray* target)
{
  for (const Piece& piece : pieces)
  {
    vtkDataArray* const array = piece.Image->GetAttributes(association)->GetArray(name.c_str());
    if (!array || array->GetDataType() != target->GetDataType() ||
      array->GetNumberOfComponents() != target->GetNumberOfComponents() ||
      array->GetNumberOfTuples() != Box(piece.All, association).Count())
    {
      return Status::Error("Array '", name, "' is missing on a process, or of another kind there.");
    }
    CopyOwn(array, piece, association, target, whole);
  }
  return {};
}

//------------------------------------------------------------------------------
// Whether pieces fill a box of cells.
bool Fill(const std::vector<Piece>& pieces, const int extent[6])
{
  const Box whole(extent, vtkDataObject::CELL);
  std::vector<bool> filled(whole.Count());
  for (const Piece& piece : pieces)
  {
    const Box own(piece.Own, vtkDataObject::CELL);
    for (vtkIdType z = own.First[2]; z < own.First[2] + own.Size[2]; ++z)
    {
      for (vtkIdType y = own.First[1]; y < own.First[1] + own.Size[1]; ++y)
      {
        std::fill_n(filled.begin() + whole.IndexOf(own.First[0], y, z), own.Size[0], true);
      }
    }
  }
  return std::find(filled.begin(), filled.end(), false) == filled.end();
}

//------------------------------------------------------------------------------
// Copies what pieces hide, if any does.
void AssembleFlags(
  const std::vector<Piece>& pieces, int association, const Box& box, vtkImageData* whole)
{
  const char* const name = vtkDataSetAttributes::GhostArrayName();
  const bool isAny = std::any_of(pieces.begin(), pieces.end(),
    [&](const Piece& piece)
    { return piece.Image->GetAttributes(association)->GetArray(name) != nullptr; });
  if (!isAny)
  {
    return;
  }
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(name);
  flags->SetNumberOfValues(box.Count());
  flags->Fill(0);
  for (const Piece& piece : pieces)
  {
    vtkDataArray* const from = piece.Image->GetAttributes(association)->GetArray(name);
    if (from && from->GetNumberOfTuples() == Box(piece.All, association).Count())
    {
      CopyOwn(from, piece, association, flags, box);
    }
  }
  // points at faces are a neighbour's, too, and marked as such
  constexpr unsigned char duplicate = vtkDataSetAttributes::DUPLICATEPOINT;
  static_assert(duplicate == static_cast<int>(vtkDataSetAttributes::DUPLICATECELL), "one flag");
  std::for_each(flags->GetPointer(0), flags->GetPointer(0) + flags->GetNumberOfValues(),
    [](unsigned char& value) { value &= static_cast<unsigned char>(~duplicate); });
  whole->GetAttributes(association)->AddArray(flags);
}
}

//------------------------------------------------------------------------------
GatheredImage::Images GatheredImage::Gather(const Images& here)
{
  if (DistributedPieces::GetNumberOfProcesses() == 1)
  {
    return here;
  }
  vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
  const int count = static_cast<int>(here.size());
  int most = 0;
  controller->AllReduce(&count, &most, 1, vtkCommunicator::MAX_OP);
  Images all;
  for (int i = 0; i < most; ++i)
  {
    const auto sent = i < count ? here[i] : vtkSmartPointer<vtkImageData>::New();
    std::vector<vtkSmartPointer<vtkDataObject>> received;
    controller->Gather(sent, received, 0);
    for (const auto& object : received)
    {
      vtkImageData* const image = vtkImageData::SafeDownCast(object);
      if (image && image->GetNumberOfPoints() > 0)
      {
        all.emplace_back(image);
      }
    }
  }
  return all;
}

//------------------------------------------------------------------------------
Status GatheredImage::Assemble(
  const Images& images, const std::string& name, int association, vtkImageData* whole)
{
  whole->Initialize();
  std::vector<Piece> pieces;
  Status status = images.empty() ? Status() : PlacePieces(images, pieces);
  if (!status || pieces.empty())
  {
    return status;
  }
  int extent[6];
  std::copy_n(pieces.front().Own, 6, extent);
  for (const Piece& piece : pieces)
  {
    for (int i = 0; i < 6; i += 2)
    {
      extent[i] = std::min(extent[i], piece.Own[i]);
      extent[i + 1] = std::max(extent[i + 1], piece.Own[i + 1]);
    }
  }
  if (!Fill(pieces, extent))
  {
    return Status::Error("The processes' pieces of the image do not fill a box.");
  }
  whole->CopyStructure(pieces.front().Image);
  whole->GetPointData()->Initialize();
  whole->GetCellData()->Initialize();
  whole->SetExtent(extent);
  vtkDataArray* const first =
    pieces.front().Image->GetAttributes(association)->GetArray(name.c_str());
  if (!first)
  {
    return Status::Error("Array '", name, "' is missing on a process.");
  }
  const Box box(extent, association);
  const auto array = vtkSmartPointer<vtkDataArray>::Take(first->NewInstance());
  array->SetName(name.c_str());
  array->SetNumberOfComponents(first->GetNumberOfComponents());
  array->SetNumberOfTuples(box.Count());
  status = AssembleArray(pieces, name, association, box, array);
  whole->GetAttributes(association)->SetScalars(array);
  for (const int flagged : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    AssembleFlags(pieces, flagged, Box(extent, flagged), whole);
  }
  return status;
}
