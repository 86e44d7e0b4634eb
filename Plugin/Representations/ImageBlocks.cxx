// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageBlocks.h"

#include "RectilinearImage.h"

#include "vtkAMRUtilities.h"
#include "vtkCellData.h"
#include "vtkCellDataToPointData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkImageZFPCompress.h"
#include "vtkNew.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"

namespace
{
using ImageBlocks::Arrays;

constexpr const char* CompositeIndexName = "ProgIso.CompositeIndex"; // in field data

bool IsCompressed(vtkDataSet* block)
{
  vtkImageData* image = vtkImageData::SafeDownCast(block);
  return image && vtkCompressedVolume::IsCompressed(image);
}

// Does any block say which of its cells are refined?
bool IsBlanked(vtkCompositeDataSet* data)
{
  auto blocks = vtk::TakeSmartPointer(data->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    vtkDataSet* block = vtkDataSet::SafeDownCast(blocks->GetCurrentDataObject());
    if (block && block->GetCellGhostArray())
    {
      return true;
    }
  }
  return false;
}

// Readers hide what finer levels refine; other sources of AMR may not.
vtkSmartPointer<vtkCompositeDataSet> HideRefinedCells(vtkCompositeDataSet* data)
{
  auto* grids = vtkOverlappingAMR::SafeDownCast(data);
  if (!grids || IsBlanked(grids))
  {
    return data;
  }
  vtkNew<vtkOverlappingAMR> copy;
  copy->ShallowCopy(grids);
  vtkAMRUtilities::BlankCells(copy);
  return copy;
}

void AddBlock(vtkDataObject* object, unsigned int index, ImageBlocks::Found& found)
{
  vtkDataSet* block = vtkDataSet::SafeDownCast(object);
  if (!vtkImageData::SafeDownCast(block) && !vtkRectilinearGrid::SafeDownCast(block))
  {
    ++found.NumberOfOthers;
  }
  else if (block->GetNumberOfPoints() > 0)
  {
    vtkImageData* image = vtkImageData::SafeDownCast(block);
    vtkSmartPointer<vtkDataSet> grid = block;
    if (image)
    {
      grid = ImageBlocks::WithNamedScalars(image);
    }
    found.Blocks.push_back({ grid, index });
  }
}

std::vector<std::string> NamesOf(const Arrays& arrays)
{
  std::vector<std::string> names = { arrays.Drawn };
  if (!arrays.Color.empty())
  {
    names.push_back(arrays.Color);
  }
  return names;
}

// Copies a grid with the arrays of its points.
vtkSmartPointer<vtkDataSet> WithPointArrays(vtkDataSet* block, const Arrays& arrays)
{
  auto selected = vtk::TakeSmartPointer(block->NewInstance());
  selected->CopyStructure(block);
  selected->GetPointData()->Initialize(); // CopyStructure() copies ghost arrays that hide
  selected->GetCellData()->Initialize();
  selected->GetPointData()->AddArray(block->GetPointGhostArray());
  selected->GetCellData()->AddArray(block->GetCellGhostArray());
  vtkSmartPointer<vtkDataSet> source = block;
  if (arrays.Association == vtkDataObject::FIELD_ASSOCIATION_CELLS)
  {
    vtkNew<vtkCellDataToPointData> toPoints;
    toPoints->SetInputData(block);
    toPoints->ProcessAllArraysOff();
    for (const std::string& name : NamesOf(arrays))
    {
      toPoints->AddCellDataArray(name.c_str());
    }
    toPoints->Update();
    source = vtkDataSet::SafeDownCast(toPoints->GetOutput());
  }
  for (const std::string& name : NamesOf(arrays))
  {
    selected->GetPointData()->AddArray(source->GetPointData()->GetArray(name.c_str()));
  }
  return selected;
}

vtkSmartPointer<vtkImageData> CopyOf(vtkImageData* image)
{
  auto copy = vtk::TakeSmartPointer(image->NewInstance());
  copy->ShallowCopy(image);
  return copy;
}

vtkSmartPointer<vtkImageData> MakePlainImage(
  vtkDataSet* block, const Arrays& arrays, bool resamplesUnevenGrids)
{
  auto* grid = vtkRectilinearGrid::SafeDownCast(block);
  const bool even = !grid || RectilinearImage::IsEven(grid);
  if (!even && !resamplesUnevenGrids)
  {
    return nullptr;
  }
  vtkSmartPointer<vtkDataSet> selected = WithPointArrays(block, arrays);
  if (!grid)
  {
    return vtkImageData::SafeDownCast(selected);
  }
  grid = vtkRectilinearGrid::SafeDownCast(selected);
  return even ? RectilinearImage::Convert(grid) : RectilinearImage::Resample(grid);
}
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> ImageBlocks::WithNamedScalars(vtkImageData* image)
{
  vtkSmartPointer<vtkImageData> named = image;
  for (int association :
    { vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataObject::FIELD_ASSOCIATION_CELLS })
  {
    vtkDataArray* scalars = image->GetAttributes(association)->GetScalars();
    if (scalars && !scalars->GetName())
    {
      auto copy = vtk::TakeSmartPointer(scalars->NewInstance());
      copy->ShallowCopy(scalars);
      copy->SetName("Scalars");
      named = named == image ? CopyOf(image) : named;
      named->GetAttributes(association)->SetScalars(copy);
    }
  }
  return named;
}

//------------------------------------------------------------------------------
ImageBlocks::Found ImageBlocks::Find(vtkDataObject* input)
{
  Found found;
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    AddBlock(input, 0, found);
    return found;
  }
  vtkSmartPointer<vtkCompositeDataSet> data = HideRefinedCells(composite);
  auto blocks = vtk::TakeSmartPointer(data->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    AddBlock(blocks->GetCurrentDataObject(), blocks->GetCurrentFlatIndex(), found);
  }
  return found;
}

//------------------------------------------------------------------------------
vtkDataArray* ImageBlocks::FindDefaultArray(vtkDataSet* block, int& association)
{
  vtkNew<vtkImageData> arrays; // vtkImageZFPCompress looks at nothing else
  arrays->GetPointData()->ShallowCopy(block->GetPointData());
  arrays->GetCellData()->ShallowCopy(block->GetCellData());
  return vtkImageZFPCompress::FindDefaultArray(arrays, association);
}

//------------------------------------------------------------------------------
bool ImageBlocks::HasArrays(vtkDataSet* block, const Arrays& arrays)
{
  if (IsCompressed(block))
  {
    return arrays.Color.empty();
  }
  vtkDataSetAttributes* attributes = block->GetAttributes(arrays.Association);
  return attributes && attributes->GetArray(arrays.Drawn.c_str()) &&
    (arrays.Color.empty() || attributes->GetArray(arrays.Color.c_str()));
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> ImageBlocks::MakeImage(
  const Block& block, const Arrays& arrays, bool resamplesUnevenGrids)
{
  vtkSmartPointer<vtkImageData> image = IsCompressed(block.Grid)
    ? CopyOf(vtkImageData::SafeDownCast(block.Grid))
    : MakePlainImage(block.Grid, arrays, resamplesUnevenGrids);
  if (image)
  {
    vtkNew<vtkUnsignedIntArray> index;
    index->SetName(CompositeIndexName);
    index->InsertNextValue(block.CompositeIndex);
    image->GetFieldData()->AddArray(index);
  }
  return image;
}

//------------------------------------------------------------------------------
unsigned int ImageBlocks::GetCompositeIndex(vtkImageData* image)
{
  auto* index =
    vtkUnsignedIntArray::SafeDownCast(image->GetFieldData()->GetArray(CompositeIndexName));
  return index ? index->GetValue(0) : 0;
}
