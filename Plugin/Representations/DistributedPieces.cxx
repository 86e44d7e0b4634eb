// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedPieces.h"

#include "Pieces/PieceExtents.h"

#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkCompressedVolume.h"
#include "vtkExtractVOI.h"
#include "vtkFieldData.h"
#include "vtkGhostCellsGenerator.h"
#include "vtkImageData.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

namespace
{
// Finds the extent around the pieces of all processes.
void FindWholeExtent(const int piece[6], int whole[6])
{
  int mine[6];
  for (int i = 0; i < 6; ++i)
  {
    const int sign = i % 2 == 0 ? -1 : 1; // so that one reduction to the largest is enough
    mine[i] = PieceExtents::IsEmpty(piece) ? -VTK_INT_MAX : sign * piece[i];
  }
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    mine, whole, 6, vtkCommunicator::MAX_OP);
  for (int i = 0; i < 6; i += 2)
  {
    whole[i] = -whole[i];
  }
}

vtkSmartPointer<vtkImageData> GenerateGhostCells(vtkImageData* image)
{
  vtkNew<vtkGhostCellsGenerator> generator;
  generator->SetInputData(image);
  generator->BuildIfRequiredOff();
  generator->SetNumberOfGhostLayers(vtkCompressedVolume::NumberOfGhostLevels);
  generator->Update();
  return vtkImageData::SafeDownCast(generator->GetOutput());
}
}

int DistributedPieces::GetNumberOfProcesses()
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  return controller ? controller->GetNumberOfProcesses() : 1;
}

bool DistributedPieces::IsTrueAnywhere(bool here)
{
  const int mine = here ? 1 : 0;
  int any = mine;
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    &mine, &any, 1, vtkCommunicator::MAX_OP);
  return any != 0;
}

void DistributedPieces::FindWholeBounds(const double mine[6], double whole[6])
{
  double signedBounds[6]; // so that one reduction to the largest is enough
  for (int i = 0; i < 6; ++i)
  {
    const bool empty = mine[i / 2 * 2] > mine[i / 2 * 2 + 1];
    signedBounds[i] = empty ? -VTK_DOUBLE_MAX : (i % 2 == 0 ? -mine[i] : mine[i]);
  }
  vtkMultiProcessController::GetGlobalController()->AllReduce(
    signedBounds, whole, 6, vtkCommunicator::MAX_OP);
  for (int i = 0; i < 6; i += 2)
  {
    whole[i] = -whole[i];
  }
}

vtkSmartPointer<vtkImageData> DistributedPieces::WithoutGhosts(vtkImageData* image)
{
  int extent[6];
  PieceExtents::GetExtentWithoutGhosts(image, extent);
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->CopyStructure(image);
  copy->GetPointData()->Initialize(); // CopyStructure() copies some ghost arrays
  copy->GetCellData()->Initialize();
  if (PieceExtents::IsEmpty(extent))
  {
    copy->SetExtent(extent);
  }
  else
  {
    // what is blanked stays so
    copy->GetPointData()->AddArray(image->GetPointGhostArray());
    copy->GetCellData()->AddArray(image->GetCellGhostArray());
    copy->Crop(extent);
  }
  copy->GetFieldData()->PassData(image->GetFieldData());
  return copy;
}

vtkSmartPointer<vtkImageData> DistributedPieces::MakeCompressedPiece(
  vtkImageData* image, bool canDraw)
{
  vtkSmartPointer<vtkImageData> piece = WithoutGhosts(image);
  vtkNew<vtkCompressedVolume> volume;
  if (canDraw && piece->GetNumberOfPoints() > 0 && volume->Read(piece))
  {
    volume->Crop(piece->GetExtent());
    volume->Write(piece);
  }
  return piece;
}

vtkSmartPointer<vtkImageData> DistributedPieces::MakePlainPiece(vtkImageData* image, bool cellData)
{
  int extent[6], whole[6], covering[6];
  PieceExtents::GetExtentWithoutGhosts(image, extent);
  FindWholeExtent(extent, whole);
  PieceExtents::GetCoveringExtent(extent, whole, cellData, covering);
  const bool isEmpty = PieceExtents::IsEmpty(extent);
  const bool lacksSamples = !isEmpty && !PieceExtents::Contains(image->GetExtent(), covering);
  vtkSmartPointer<vtkImageData> piece = image;
  if (IsTrueAnywhere(lacksSamples))
  {
    piece = GenerateGhostCells(image);
  }
  if (isEmpty)
  {
    return piece;
  }
  vtkNew<vtkExtractVOI> cut;
  cut->SetInputData(piece);
  cut->SetVOI(covering);
  cut->Update();
  return cut->GetOutput();
}
