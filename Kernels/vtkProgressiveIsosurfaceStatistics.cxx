// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "Scene/ImageStatistics.h"

#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

#include <utility>
#include <vector>

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

void vtkProgressiveIsosurfaceStatistics::SetSource(std::function<ImageStatistics()> collect)
{
  this->Source = std::move(collect);
  this->Modified();
}

void vtkProgressiveIsosurfaceStatistics::Collect()
{
  if (const std::function<ImageStatistics()> source = std::exchange(this->Source, nullptr))
  {
    *this->Image = source();
    this->FillPassTable();
  }
}

const ImageStatistics& vtkProgressiveIsosurfaceStatistics::GetImage()
{
  this->Collect();
  return *this->Image;
}

void vtkProgressiveIsosurfaceStatistics::FillPassTable()
{
  const std::vector<PassStatistics>& passes = this->Image->Passes;
  this->PassTable->SetNumberOfRows(static_cast<vtkIdType>(passes.size()));
  for (const PassColumn& column : PassColumns)
  {
    auto* values = vtkDoubleArray::SafeDownCast(this->PassTable->GetColumnByName(column.Name));
    for (std::size_t i = 0; i < passes.size(); ++i)
    {
      values->SetValue(static_cast<vtkIdType>(i), passes[i].*column.Value);
    }
  }
  this->PassTable->Modified();
}

void vtkProgressiveIsosurfaceStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Passes: " << this->GetNumberOfPasses() << "\n";
  os << indent << "TotalMilliseconds: " << this->GetImage().TotalMilliseconds << "\n";
  os << indent << "MemoryBudget: " << this->GetImage().MemoryBudget << "\n";
  os << indent << "LeastMemoryBudget: " << this->GetImage().LeastMemoryBudget << "\n";
  os << indent << "TotalBytes: " << this->GetTotalBytes() << "\n";
  for (const auto& buffer : this->GetImage().Buffers)
  {
    os << indent.GetNextIndent() << buffer.first << ": " << buffer.second << "\n";
  }
  os << indent << "Converged: " << this->GetImage().Converged << "\n";
  os << indent << "GLDescription: " << this->GetImage().GLDescription << "\n";
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfPasses()
{
  return static_cast<int>(this->GetImage().Passes.size());
}

double vtkProgressiveIsosurfaceStatistics::GetPassValue(int pass, const char* column)
{
  auto* values =
    vtkDoubleArray::SafeDownCast(column ? this->GetPassTable()->GetColumnByName(column) : nullptr);
  return values && pass >= 0 && pass < values->GetNumberOfTuples() ? values->GetValue(pass)
                                                                   : vtkMath::Nan();
}

vtkTable* vtkProgressiveIsosurfaceStatistics::GetPassTable()
{
  this->Collect();
  return this->PassTable;
}

double vtkProgressiveIsosurfaceStatistics::GetTotalMilliseconds()
{
  return this->GetImage().TotalMilliseconds;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetTotalBytes()
{
  vtkTypeInt64 total = 0;
  for (const auto& buffer : this->GetImage().Buffers)
  {
    total += buffer.second;
  }
  return total;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetCompressedBytes()
{
  return this->GetImage().StreamBytes;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfBuffers()
{
  return static_cast<int>(this->GetImage().Buffers.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetBufferName(int i)
{
  return HasIndex(this->GetImage().Buffers, i) ? this->GetImage().Buffers[i].first.c_str()
                                               : nullptr;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetBufferBytes(int i)
{
  return HasIndex(this->GetImage().Buffers, i) ? this->GetImage().Buffers[i].second : 0;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetMemoryBudget()
{
  return this->GetImage().MemoryBudget;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetHostBytes()
{
  return this->GetImage().HostBytes;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetLeastMemoryBudget()
{
  return this->GetImage().LeastMemoryBudget;
}

double vtkProgressiveIsosurfaceStatistics::GetInputMilliseconds()
{
  return this->GetImage().InputMilliseconds;
}

double vtkProgressiveIsosurfaceStatistics::GetUploadMilliseconds()
{
  return this->GetImage().UploadMilliseconds;
}

double vtkProgressiveIsosurfaceStatistics::GetPreparationMilliseconds()
{
  return this->GetImage().PreparationMilliseconds;
}

double vtkProgressiveIsosurfaceStatistics::GetBlocksDecodedAtFirst()
{
  return this->GetImage().BlocksDecodedAtFirst;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfPrograms()
{
  return static_cast<int>(this->GetImage().Programs.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetProgram(int i)
{
  const std::vector<ProgramStatistics>& programs = this->GetImage().Programs;
  return HasIndex(programs, i) ? programs[i].Stage.c_str() : nullptr;
}

double vtkProgressiveIsosurfaceStatistics::GetProgramMilliseconds(int i)
{
  const std::vector<ProgramStatistics>& programs = this->GetImage().Programs;
  return HasIndex(programs, i) ? programs[i].Milliseconds : 0.0;
}

double vtkProgressiveIsosurfaceStatistics::GetProgramWaitMilliseconds(int i)
{
  const std::vector<ProgramStatistics>& programs = this->GetImage().Programs;
  return HasIndex(programs, i) ? programs[i].WaitedMilliseconds : 0.0;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfStages()
{
  return static_cast<int>(this->GetImage().Stages.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetStage(int i)
{
  return HasIndex(this->GetImage().Stages, i) ? this->GetImage().Stages[i].first.c_str() : nullptr;
}

double vtkProgressiveIsosurfaceStatistics::GetStageMilliseconds(int i)
{
  return HasIndex(this->GetImage().Stages, i) ? this->GetImage().Stages[i].second : 0.0;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfStagesLeftOut()
{
  return static_cast<int>(this->GetImage().StagesLeftOut.size());
}

const char* vtkProgressiveIsosurfaceStatistics::GetStageLeftOut(int i)
{
  const std::vector<std::string>& stages = this->GetImage().StagesLeftOut;
  return HasIndex(stages, i) ? stages[i].c_str() : nullptr;
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfLevels()
{
  return static_cast<int>(this->GetImage().LevelPixels.size());
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetLevelPixels(int level)
{
  const std::vector<std::int64_t>& pixels = this->GetImage().LevelPixels;
  return HasIndex(pixels, level) ? pixels[level] : 0;
}

double vtkProgressiveIsosurfaceStatistics::GetUncertainFraction()
{
  return this->GetImage().UncertainFraction;
}

bool vtkProgressiveIsosurfaceStatistics::GetConverged()
{
  return this->GetImage().Converged;
}

std::string vtkProgressiveIsosurfaceStatistics::GetGLDescription()
{
  return this->GetImage().GLDescription;
}
