// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "Scene/ImageStatistics.h"

#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

namespace
{
template <typename List>
bool HasIndex(const List& list, int i)
{
  return i >= 0 && i < static_cast<int>(list.size());
}
}

vtkStandardNewMacro(vtkProgressiveIsosurfaceStatistics);

vtkProgressiveIsosurfaceStatistics::vtkProgressiveIsosurfaceStatistics()
  : Image(new ImageStatistics)
{
  for (const PassColumn& column : PassColumns)
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName(column.Name);
    this->PassTable->AddColumn(values);
  }
}

vtkProgressiveIsosurfaceStatistics::~vtkProgressiveIsosurfaceStatistics() = default;

void vtkProgressiveIsosurfaceStatistics::SetImage(const ImageStatistics& image)
{
  *this->Image = image;
  this->PassTable->SetNumberOfRows(static_cast<vtkIdType>(image.Passes.size()));
  for (const PassColumn& column : PassColumns)
  {
    auto* values = vtkDoubleArray::SafeDownCast(this->PassTable->GetColumnByName(column.Name));
    for (std::size_t i = 0; i < image.Passes.size(); ++i)
    {
      values->SetValue(static_cast<vtkIdType>(i), image.Passes[i].*column.Value);
    }
  }
  this->Modified();
}

void vtkProgressiveIsosurfaceStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Passes: " << this->GetNumberOfPasses() << "\n";
  os << indent << "TotalMilliseconds: " << this->Image->TotalMilliseconds << "\n";
  os << indent << "MemoryBudget: " << this->Image->MemoryBudget << "\n";
  os << indent << "LeastMemoryBudget: " << this->Image->LeastMemoryBudget << "\n";
  os << indent << "TotalBytes: " << this->GetTotalBytes() << "\n";
  for (const auto& buffer : this->Image->Buffers)
  {
    os << indent.GetNextIndent() << buffer.first << ": " << buffer.second << "\n";
  }
  os << indent << "Converged: " << this->Image->Converged << "\n";
  os << indent << "GLDescription: " << this->Image->GLDescription << "\n";
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfPasses()
{
  return static_cast<int>(this->PassTable->GetNumberOfRows());
}

double vtkProgressiveIsosurfaceStatistics::GetPassValue(int pass, const char* column)
{
  auto* values =
    vtkDoubleArray::SafeDownCast(column ? this->PassTable->GetColumnByName(column) : nullptr);
  return values && pass >= 0 && pass < values->GetNumberOfTuples() ? values->GetValue(pass)
                                                                   : vtkMath::Nan();
}

vtkTable* vtkProgressiveIsosurfaceStatistics::GetPassTable()
{
  return this->PassTable;
}

double vtkProgressiveIsosurfaceStatistics::GetTotalMilliseconds()
{
  return this->Image->TotalMilliseconds;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetTotalBytes()
{
  vtkTypeInt64 total = 0;
  for (const auto& buffer : this->Image->Buffers)
  {
    total += buffer.second;
  }
  return total;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetCompressedBytes()
{
  return this->Image->StreamBytes;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfBuffers()
{
  return static_cast<int>(this->Image->Buffers.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetBufferName(int i)
{
  return HasIndex(this->Image->Buffers, i) ? this->Image->Buffers[i].first.c_str() : nullptr;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetBufferBytes(int i)
{
  return HasIndex(this->Image->Buffers, i) ? this->Image->Buffers[i].second : 0;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetMemoryBudget()
{
  return this->Image->MemoryBudget;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetLeastMemoryBudget()
{
  return this->Image->LeastMemoryBudget;
}

double vtkProgressiveIsosurfaceStatistics::GetInputMilliseconds()
{
  return this->Image->InputMilliseconds;
}

double vtkProgressiveIsosurfaceStatistics::GetUploadMilliseconds()
{
  return this->Image->UploadMilliseconds;
}

double vtkProgressiveIsosurfaceStatistics::GetPreparationMilliseconds()
{
  return this->Image->PreparationMilliseconds;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfPrograms()
{
  return static_cast<int>(this->Image->Programs.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetProgram(int i)
{
  const std::vector<ProgramStatistics>& programs = this->Image->Programs;
  return HasIndex(programs, i) ? programs[i].Stage.c_str() : nullptr;
}

double vtkProgressiveIsosurfaceStatistics::GetProgramMilliseconds(int i)
{
  const std::vector<ProgramStatistics>& programs = this->Image->Programs;
  return HasIndex(programs, i) ? programs[i].Milliseconds : 0.0;
}

double vtkProgressiveIsosurfaceStatistics::GetProgramWaitMilliseconds(int i)
{
  const std::vector<ProgramStatistics>& programs = this->Image->Programs;
  return HasIndex(programs, i) ? programs[i].WaitedMilliseconds : 0.0;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfStages()
{
  return static_cast<int>(this->Image->Stages.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetStage(int i)
{
  return HasIndex(this->Image->Stages, i) ? this->Image->Stages[i].first.c_str() : nullptr;
}

double vtkProgressiveIsosurfaceStatistics::GetStageMilliseconds(int i)
{
  return HasIndex(this->Image->Stages, i) ? this->Image->Stages[i].second : 0.0;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfStagesLeftOut()
{
  return static_cast<int>(this->Image->StagesLeftOut.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetStageLeftOut(int i)
{
  const std::vector<std::string>& stages = this->Image->StagesLeftOut;
  return HasIndex(stages, i) ? stages[i].c_str() : nullptr;
}

bool vtkProgressiveIsosurfaceStatistics::GetConverged()
{
  return this->Image->Converged;
}

std::string vtkProgressiveIsosurfaceStatistics::GetGLDescription()
{
  return this->Image->GLDescription;
}
