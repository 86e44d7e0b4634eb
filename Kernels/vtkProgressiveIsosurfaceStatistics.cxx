// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkProgressiveIsosurfaceStatistics.h"

#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"

vtkStandardNewMacro(vtkProgressiveIsosurfaceStatistics);

vtkProgressiveIsosurfaceStatistics::vtkProgressiveIsosurfaceStatistics()
{
  for (const char* name : { "pass", "active_rays", "speculation", "pairs", "visible_blocks",
         "active_blocks", "decoded_blocks", "cached_blocks", "completed", "elapsed_ms" })
  {
    vtkNew<vtkDoubleArray> column;
    column->SetName(name);
    this->Passes->AddColumn(column);
  }
}

vtkProgressiveIsosurfaceStatistics::~vtkProgressiveIsosurfaceStatistics() = default;

void vtkProgressiveIsosurfaceStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Passes: " << this->GetNumberOfPasses() << "\n";
  os << indent << "TotalMilliseconds: " << this->TotalMilliseconds << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "LeastMemoryBudget: " << this->LeastMemoryBudget << "\n";
  os << indent << "TotalBytes: " << this->GetTotalBytes() << "\n";
  for (const auto& buffer : this->Buffers)
  {
    os << indent.GetNextIndent() << buffer.first << ": " << buffer.second << "\n";
  }
  os << indent << "Converged: " << this->Converged << "\n";
  os << indent << "GLDescription: " << this->GLDescription << "\n";
}

int vtkProgressiveIsosurfaceStatistics::GetNumberOfPasses()
{
  return static_cast<int>(this->Passes->GetNumberOfRows());
}

double vtkProgressiveIsosurfaceStatistics::GetPassValue(int pass, const char* column)
{
  auto* values =
    vtkDoubleArray::SafeDownCast(column ? this->Passes->GetColumnByName(column) : nullptr);
  return values && pass >= 0 && pass < values->GetNumberOfTuples() ? values->GetValue(pass)
                                                                   : vtkMath::Nan();
}

vtkTable* vtkProgressiveIsosurfaceStatistics::GetPassTable()
{
  return this->Passes;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetTotalBytes()
{
  vtkTypeInt64 total = 0;
  for (const auto& buffer : this->Buffers)
  {
    total += buffer.second;
  }
  return total;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetCompressedBytes()
{
  vtkTypeInt64 bytes = 0;
  for (const auto& buffer : this->Buffers)
  {
    bytes +=
      buffer.first == "compressed" || buffer.first == "compressed_colors" ? buffer.second : 0;
  }
  return bytes;
}

const char* vtkProgressiveIsosurfaceStatistics::GetBufferName(int i)
{
  return i >= 0 && i < this->GetNumberOfBuffers() ? this->Buffers[i].first.c_str() : nullptr;
}

vtkTypeInt64 vtkProgressiveIsosurfaceStatistics::GetBufferBytes(int i)
{
  return i >= 0 && i < this->GetNumberOfBuffers() ? this->Buffers[i].second : 0;
}

const char* vtkProgressiveIsosurfaceStatistics::GetStage(int i)
{
  return i >= 0 && i < this->GetNumberOfStages() ? this->Stages[i].first.c_str() : nullptr;
}

double vtkProgressiveIsosurfaceStatistics::GetStageMilliseconds(int i)
{
  return i >= 0 && i < this->GetNumberOfStages() ? this->Stages[i].second : 0.0;
}

const char* vtkProgressiveIsosurfaceStatistics::GetStageLeftOut(int i)
{
  return i >= 0 && i < this->GetNumberOfStagesLeftOut() ? this->StagesLeftOut[i].c_str() : nullptr;
}
