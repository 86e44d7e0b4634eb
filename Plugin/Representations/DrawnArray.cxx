// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnArray.h"

#include "DistributedPieces.h"
#include "ImageBlocks.h"

#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkSmartPointer.h"

//------------------------------------------------------------------------------
bool DrawnArray::Choose(const ArrayName& array)
{
  if (array.Association == this->Chosen.Association && array.Name == this->Chosen.Name)
  {
    return false;
  }
  this->Chosen = array;
  return true;
}

//------------------------------------------------------------------------------
bool DrawnArray::Find(vtkImageData* image, std::string& error)
{
  this->Found = ArrayName();
  return vtkCompressedVolume::IsCompressed(image) ? this->FindCompressed(image, error)
                                                  : this->FindPlain(image, error);
}

//------------------------------------------------------------------------------
bool DrawnArray::FindCompressed(vtkImageData* image, std::string& error)
{
  vtkNew<vtkCompressedVolume> volume;
  vtkSmartPointer<vtkImageData> piece = DistributedPieces::WithoutGhosts(image);
  if (piece->GetNumberOfPoints() == 0)
  {
    return false; // other processes have all pieces
  }
  if (!volume->Read(piece))
  {
    error = volume->GetErrorMessage();
    return false;
  }
  this->Found = { volume->GetAssociation(), volume->GetArrayName() };
  return true;
}

//------------------------------------------------------------------------------
ArrayName DrawnArray::ChooseIn(vtkDataSet* grid) const
{
  if (!this->Chosen.Name.empty())
  {
    return this->Chosen;
  }
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* array = ImageBlocks::FindDefaultArray(grid, association);
  return { association, array && array->GetName() ? array->GetName() : "" };
}

//------------------------------------------------------------------------------
bool DrawnArray::FindPlain(vtkImageData* image, std::string& error)
{
  this->Found = this->ChooseIn(image);
  vtkDataSetAttributes* arrays = image->GetAttributes(this->Found.Association);
  if (arrays && arrays->GetArray(this->Found.Name.c_str()))
  {
    return true;
  }
  // a process may hold an empty piece of a distributed image, which has no arrays
  if (image->GetNumberOfPoints() > 0)
  {
    error = this->Found.Name.empty()
      ? "the image has no array of numbers, and is no compressed volume"
      : "the image has no array \"" + this->Found.Name +
        "\" of numbers; choose an Isosurface Array";
  }
  return false;
}

//------------------------------------------------------------------------------
bool DrawnArray::Find(const ImageBlocks::Found& blocks, std::string& error)
{
  this->Found = ArrayName();
  bool found = false;
  for (const ImageBlocks::Block& block : blocks.Blocks)
  {
    this->Found = found ? this->Found : this->ChooseIn(block.Grid);
    vtkImageData* image = vtkImageData::SafeDownCast(block.Grid);
    if (image && vtkCompressedVolume::IsCompressed(image) && !found)
    {
      found = this->FindCompressed(image, error);
    }
    found = found ||
      ImageBlocks::HasArrays(block.Grid, { this->Found.Association, this->Found.Name, "" });
  }
  // other processes may have the blocks that can be drawn
  if (!DistributedPieces::IsTrueAnywhere(found))
  {
    const bool anyGrid = DistributedPieces::IsTrueAnywhere(!blocks.Blocks.empty());
    error = anyGrid
      ? "no block has the array \"" + this->Found.Name + "\"; choose an Isosurface Array"
      : "none of the blocks is an image; use the filter Resample To Image";
  }
  return found;
}

//------------------------------------------------------------------------------
vtkDataArray* DrawnArray::FindBeside(vtkDataObject* drawn, const std::string& name) const
{
  vtkImageData* image = vtkImageData::SafeDownCast(drawn);
  int association = this->Found.Association;
  auto* blocks = vtkPartitionedDataSet::SafeDownCast(drawn);
  if (blocks && blocks->GetNumberOfPartitions() > 0)
  {
    image = vtkImageData::SafeDownCast(blocks->GetPartition(0));
    association = vtkDataObject::FIELD_ASSOCIATION_POINTS; // whatever it was
  }
  return image ? image->GetAttributes(association)->GetArray(name.c_str()) : nullptr;
}

//------------------------------------------------------------------------------
int DrawnArray::GetComponent(vtkDataObject* drawn) const
{
  vtkDataArray* array = this->FindBeside(drawn, this->Found.Name);
  const bool isLast = array && this->Component == array->GetNumberOfComponents();
  return isLast ? Magnitude : this->Component;
}
