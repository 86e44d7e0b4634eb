// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVIsosurfaceInformation.h"

#include "vtkClientServerStream.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkProgressiveIsosurfaceRepresentation.h"
#include "vtkProgressiveIsosurfaceStatistics.h"

#include <algorithm>

vtkStandardNewMacro(vtkPVIsosurfaceInformation);

namespace
{
//------------------------------------------------------------------------------
void Send(vtkClientServerStream& stream, const std::vector<double>& values)
{
  stream << vtkClientServerStream::InsertArray(values.data(), static_cast<int>(values.size()));
}

//------------------------------------------------------------------------------
bool Receive(const vtkClientServerStream& stream, int argument, std::vector<double>& values)
{
  vtkTypeUInt32 length = 0;
  if (!stream.GetArgumentLength(0, argument, &length))
  {
    return false;
  }
  values.resize(length);
  return length == 0 || stream.GetArgument(0, argument, values.data(), length);
}

//------------------------------------------------------------------------------
// Finds the value after a pass. A process that needed fewer passes keeps its last value.
double AfterPass(const std::vector<double>& values, std::size_t pass)
{
  return values[std::min(pass, values.size() - 1)];
}
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::Clear()
{
  this->NumberOfProcesses = 0;
  this->CompletedFraction = this->TotalMilliseconds = 0.0;
  this->GPUBytes = this->CompressedBytes = this->MemoryBudget = 0.0;
  this->PassMilliseconds.clear();
  this->PassCompleted.clear();
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyFromObject(vtkObject* object)
{
  this->Clear();
  auto* representation = vtkProgressiveIsosurfaceRepresentation::SafeDownCast(object);
  if (!representation || representation->GetStatistics()->GetNumberOfPasses() == 0)
  {
    return;
  }
  vtkProgressiveIsosurfaceStatistics* statistics = representation->GetStatistics();
  this->NumberOfProcesses = 1;
  this->CompletedFraction = representation->GetIsosurfaceMapper()->GetCompletedFraction();
  this->TotalMilliseconds = statistics->GetTotalMilliseconds();
  this->GPUBytes = static_cast<double>(statistics->GetTotalBytes());
  this->CompressedBytes = static_cast<double>(statistics->GetCompressedBytes());
  this->MemoryBudget = static_cast<double>(statistics->GetMemoryBudget());
  for (int pass = 0; pass < statistics->GetNumberOfPasses(); ++pass)
  {
    this->PassMilliseconds.push_back(statistics->GetPassValue(pass, "elapsed_ms"));
    this->PassCompleted.push_back(statistics->GetPassValue(pass, "completed"));
  }
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::AddInformation(vtkPVInformation* information)
{
  auto* other = vtkPVIsosurfaceInformation::SafeDownCast(information);
  if (!other || other->NumberOfProcesses == 0)
  {
    return;
  }
  const bool first = this->NumberOfProcesses == 0;
  this->NumberOfProcesses += other->NumberOfProcesses;
  this->CompletedFraction =
    first ? other->CompletedFraction : std::min(this->CompletedFraction, other->CompletedFraction);
  this->TotalMilliseconds = std::max(this->TotalMilliseconds, other->TotalMilliseconds);
  this->GPUBytes += other->GPUBytes;
  this->CompressedBytes += other->CompressedBytes;
  this->MemoryBudget += other->MemoryBudget;
  if (first)
  {
    this->PassMilliseconds = other->PassMilliseconds;
    this->PassCompleted = other->PassCompleted;
    return;
  }
  const std::size_t passes = std::max(this->PassCompleted.size(), other->PassCompleted.size());
  std::vector<double> milliseconds(passes), completed(passes);
  for (std::size_t pass = 0; pass < passes; ++pass)
  {
    milliseconds[pass] =
      std::max(AfterPass(this->PassMilliseconds, pass), AfterPass(other->PassMilliseconds, pass));
    completed[pass] =
      std::min(AfterPass(this->PassCompleted, pass), AfterPass(other->PassCompleted, pass));
  }
  this->PassMilliseconds.swap(milliseconds);
  this->PassCompleted.swap(completed);
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->NumberOfProcesses << this->CompletedFraction
          << this->TotalMilliseconds << this->GPUBytes << this->CompressedBytes
          << this->MemoryBudget;
  Send(*stream, this->PassMilliseconds);
  Send(*stream, this->PassCompleted);
  *stream << vtkClientServerStream::End;
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  this->Clear();
  int argument = 0;
  bool good = stream->GetArgument(0, argument++, &this->NumberOfProcesses) != 0;
  for (double* value : { &this->CompletedFraction, &this->TotalMilliseconds, &this->GPUBytes,
         &this->CompressedBytes, &this->MemoryBudget })
  {
    good = good && stream->GetArgument(0, argument++, value);
  }
  good = good && Receive(*stream, argument++, this->PassMilliseconds) &&
    Receive(*stream, argument++, this->PassCompleted);
  if (!good || this->PassMilliseconds.size() != this->PassCompleted.size())
  {
    vtkErrorMacro("The statistics of a progressive isosurface arrived damaged: client and server "
                  "need the same version of the plugin.");
    this->Clear();
  }
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfProcesses: " << this->NumberOfProcesses << "\n";
  os << indent << "NumberOfPasses: " << this->GetNumberOfPasses() << "\n";
  os << indent << "CompletedFraction: " << this->CompletedFraction << "\n";
  os << indent << "TotalMilliseconds: " << this->TotalMilliseconds << "\n";
  os << indent << "GPUBytes: " << this->GPUBytes << "\n";
  os << indent << "CompressedBytes: " << this->CompressedBytes << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
}
