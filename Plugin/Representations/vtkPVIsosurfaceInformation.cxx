// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVIsosurfaceInformation.h"

#include "vtkClientServerStream.h"
#include "vtkIsosurfaceBlocksMapper.h"
#include "vtkObjectFactory.h"
#include "vtkProgressiveIsosurfaceMapper.h"
#include "vtkProgressiveIsosurfaceRepresentation.h"
#include "vtkProgressiveIsosurfaceStatistics.h"

#include <algorithm>
#include <functional>

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
  this->Error.clear();
  this->Warning.clear();
  this->NumberOfErrors = this->NumberOfWarnings = 0;
  this->NumberOfProcesses = 0;
  this->CompletedFraction = this->TotalMilliseconds = 0.0;
  this->GPUBytes = this->CompressedBytes = this->MemoryBudget = 0.0;
  this->PassMilliseconds.clear();
  this->PassCompleted.clear();
  this->LevelPixels.clear();
  this->UncertainFraction = 0.0;
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyFromObject(vtkObject* object)
{
  this->Clear();
  auto* representation = vtkProgressiveIsosurfaceRepresentation::SafeDownCast(object);
  if (!representation)
  {
    return;
  }
  const vtkIsosurfaceBlocksMapper::Message error = representation->GetError();
  const vtkIsosurfaceBlocksMapper::Message warning = representation->GetWarning();
  this->Error = error.Text;
  this->NumberOfErrors = error.Count;
  this->Warning = warning.Text;
  this->NumberOfWarnings = warning.Count;
  for (const auto& mapper : representation->GetBlocksMapper()->GetMappers())
  {
    this->AddBlock(mapper);
  }
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::AddBlock(vtkProgressiveIsosurfaceMapper* mapper)
{
  vtkProgressiveIsosurfaceStatistics* statistics = mapper->GetStatistics();
  if (statistics->GetNumberOfPasses() == 0)
  {
    return;
  }
  const double completed = mapper->GetCompletedFraction();
  this->CompletedFraction =
    this->NumberOfProcesses == 0 ? completed : std::min(this->CompletedFraction, completed);
  this->NumberOfProcesses = 1;
  this->TotalMilliseconds += statistics->GetTotalMilliseconds();
  this->GPUBytes += static_cast<double>(statistics->GetTotalBytes());
  this->CompressedBytes += static_cast<double>(statistics->GetCompressedBytes());
  this->MemoryBudget += static_cast<double>(statistics->GetMemoryBudget());
  std::vector<double> milliseconds, fractions;
  for (int pass = 0; pass < statistics->GetNumberOfPasses(); ++pass)
  {
    milliseconds.push_back(statistics->GetPassValue(pass, "elapsed_ms"));
    fractions.push_back(statistics->GetPassValue(pass, "completed"));
  }
  this->JoinPasses(milliseconds, fractions, [](double a, double b) { return a + b; });
  if (mapper->GetLevelOfDetail() != vtkProgressiveIsosurfaceMapper::LevelOfDetailOff)
  {
    std::vector<double> pixels;
    for (int level = 0; level < statistics->GetNumberOfLevels(); ++level)
    {
      pixels.push_back(static_cast<double>(statistics->GetLevelPixels(level)));
    }
    this->AddLevels(pixels, statistics->GetUncertainFraction());
  }
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::AddInformation(vtkPVInformation* information)
{
  auto* other = vtkPVIsosurfaceInformation::SafeDownCast(information);
  if (!other)
  {
    return;
  }
  this->Error = this->Error.empty() ? other->Error : this->Error;
  this->Warning = this->Warning.empty() ? other->Warning : this->Warning;
  this->NumberOfErrors += other->NumberOfErrors;
  this->NumberOfWarnings += other->NumberOfWarnings;
  if (other->NumberOfProcesses == 0)
  {
    return;
  }
  this->CompletedFraction = this->NumberOfProcesses == 0
    ? other->CompletedFraction
    : std::min(this->CompletedFraction, other->CompletedFraction);
  this->NumberOfProcesses += other->NumberOfProcesses;
  this->TotalMilliseconds = std::max(this->TotalMilliseconds, other->TotalMilliseconds);
  this->GPUBytes += other->GPUBytes;
  this->CompressedBytes += other->CompressedBytes;
  this->MemoryBudget += other->MemoryBudget;
  this->JoinPasses(other->PassMilliseconds, other->PassCompleted,
    [](double a, double b) { return std::max(a, b); });
  this->AddLevels(other->LevelPixels, other->UncertainFraction);
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::JoinPasses(const std::vector<double>& milliseconds,
  const std::vector<double>& completed, double (*join)(double, double))
{
  if (this->PassCompleted.empty())
  {
    this->PassMilliseconds = milliseconds;
    this->PassCompleted = completed;
    return;
  }
  const std::size_t passes = std::max(this->PassCompleted.size(), completed.size());
  std::vector<double> joined(passes), least(passes);
  for (std::size_t pass = 0; pass < passes; ++pass)
  {
    joined[pass] = join(AfterPass(this->PassMilliseconds, pass), AfterPass(milliseconds, pass));
    least[pass] = std::min(AfterPass(this->PassCompleted, pass), AfterPass(completed, pass));
  }
  this->PassMilliseconds.swap(joined);
  this->PassCompleted.swap(least);
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::AddLevels(const std::vector<double>& pixels, double uncertain)
{
  this->LevelPixels.resize(std::max(this->LevelPixels.size(), pixels.size()));
  std::transform(pixels.begin(), pixels.end(), this->LevelPixels.begin(), this->LevelPixels.begin(),
    std::plus<double>());
  this->UncertainFraction = std::max(this->UncertainFraction, uncertain);
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->NumberOfProcesses << this->CompletedFraction
          << this->TotalMilliseconds << this->GPUBytes << this->CompressedBytes
          << this->MemoryBudget << this->UncertainFraction << this->NumberOfErrors
          << this->NumberOfWarnings << this->Error.c_str() << this->Warning.c_str();
  Send(*stream, this->PassMilliseconds);
  Send(*stream, this->PassCompleted);
  Send(*stream, this->LevelPixels);
  *stream << vtkClientServerStream::End;
}

//------------------------------------------------------------------------------
void vtkPVIsosurfaceInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  this->Clear();
  int argument = 0;
  bool good = stream->GetArgument(0, argument++, &this->NumberOfProcesses) != 0;
  for (double* value : { &this->CompletedFraction, &this->TotalMilliseconds, &this->GPUBytes,
         &this->CompressedBytes, &this->MemoryBudget, &this->UncertainFraction })
  {
    good = good && stream->GetArgument(0, argument++, value);
  }
  for (int* value : { &this->NumberOfErrors, &this->NumberOfWarnings })
  {
    good = good && stream->GetArgument(0, argument++, value);
  }
  for (std::string* text : { &this->Error, &this->Warning })
  {
    const char* received = nullptr;
    good = good && stream->GetArgument(0, argument++, &received);
    *text = good && received ? received : "";
  }
  good = good && Receive(*stream, argument++, this->PassMilliseconds) &&
    Receive(*stream, argument++, this->PassCompleted) &&
    Receive(*stream, argument++, this->LevelPixels);
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
  os << indent << "NumberOfErrors: " << this->NumberOfErrors << "\n";
  os << indent << "Error: " << this->Error << "\n";
  os << indent << "NumberOfWarnings: " << this->NumberOfWarnings << "\n";
  os << indent << "Warning: " << this->Warning << "\n";
  os << indent << "NumberOfProcesses: " << this->NumberOfProcesses << "\n";
  os << indent << "NumberOfPasses: " << this->GetNumberOfPasses() << "\n";
  os << indent << "CompletedFraction: " << this->CompletedFraction << "\n";
  os << indent << "TotalMilliseconds: " << this->TotalMilliseconds << "\n";
  os << indent << "GPUBytes: " << this->GPUBytes << "\n";
  os << indent << "CompressedBytes: " << this->CompressedBytes << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "UncertainFraction: " << this->UncertainFraction << "\n";
}
