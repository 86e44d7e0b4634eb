// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "StreamArray.h"

#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <algorithm>

//------------------------------------------------------------------------------
StreamArray* StreamArray::New()
{
  VTK_STANDARD_NEW_BODY(StreamArray);
}

//------------------------------------------------------------------------------
void StreamArray::Replace(vtkFieldData* fields, const char* name)
{
  auto* const usual = vtkArrayDownCast<vtkUnsignedCharArray>(fields->GetAbstractArray(name));
  if (usual && !dynamic_cast<StreamArray*>(usual))
  {
    vtkNew<StreamArray> stream;
    stream->ShallowCopy(usual);
    fields->AddArray(stream);
  }
}

//------------------------------------------------------------------------------
bool StreamArray::FindRange(const unsigned char* bytes, vtkTypeInt64 count, double range[2])
{
  constexpr vtkTypeInt64 part = 4096; // a loop without a branch, which compilers make fast
  unsigned char low = 255, high = 0;
  for (vtkTypeInt64 begin = 0; begin < count && (low > 0 || high < 255); begin += part)
  {
    const vtkTypeInt64 end = std::min(begin + part, count);
    for (vtkTypeInt64 i = begin; i < end; ++i)
    {
      low = std::min(low, bytes[i]);
      high = std::max(high, bytes[i]);
    }
  }
  range[0] = low;
  range[1] = high;
  return count > 0;
}

//------------------------------------------------------------------------------
bool StreamArray::ComputeScalarRange(double* ranges)
{
  return this->ComputeScalarRange(ranges, nullptr, 0);
}

//------------------------------------------------------------------------------
bool StreamArray::ComputeScalarRange(
  double* ranges, const unsigned char* ghosts, unsigned char ghostsToSkip)
{
  if (ghosts || this->NumberOfComponents != 1 || this->GetNumberOfValues() == 0)
  {
    return this->vtkUnsignedCharArray::ComputeScalarRange(ranges, ghosts, ghostsToSkip);
  }
  return FindRange(this->GetPointer(0), this->GetNumberOfValues(), ranges);
}

//------------------------------------------------------------------------------
bool StreamArray::ComputeFiniteScalarRange(double* ranges)
{
  return this->ComputeScalarRange(ranges, nullptr, 0);
}

//------------------------------------------------------------------------------
bool StreamArray::ComputeFiniteScalarRange(
  double* ranges, const unsigned char* ghosts, unsigned char ghostsToSkip)
{
  return this->ComputeScalarRange(ranges, ghosts, ghostsToSkip); // all bytes are finite
}
