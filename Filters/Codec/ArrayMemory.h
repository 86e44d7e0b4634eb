// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ArrayMemory_h
#define ArrayMemory_h

#include "Status.h"

#include "vtkType.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

/**
 * Gives an array `count` values, not initialised; false where there is no memory for them, or
 * `count` is below 0. When memory runs out, VTK's own arrays throw exceptions through code and
 * languages that do not expect them.
 */
template <typename ArrayT>
bool TryAllocate(ArrayT* array, vtkTypeInt64 count)
{
  using ValueT = typename ArrayT::ValueType;
  const vtkTypeInt64 size = static_cast<vtkTypeInt64>(sizeof(ValueT));
  if (count < 0 || count > std::numeric_limits<vtkTypeInt64>::max() / size)
  {
    return false;
  }
  void* const memory = std::malloc(std::max<vtkTypeInt64>(count * size, 1));
  if (memory)
  {
    array->SetArray(static_cast<ValueT*>(memory), count, 0, ArrayT::VTK_DATA_ARRAY_FREE);
  }
  return memory != nullptr;
}

/**
 * Gives an array `count` values, not initialised; `count` < 0 is more than there can be. An error
 * names what the memory is for, and the dimensions of the volume: "not enough memory for WHAT of
 * 5 x 5 x 5 samples (500 bytes)". Needed where a file or a caller chose the size.
 */
template <typename ArrayT>
Status AllocateArray(ArrayT* array, vtkTypeInt64 count, const char* what, const int dims[3])
{
  using ValueT = typename ArrayT::ValueType;
  const vtkTypeInt64 size = static_cast<vtkTypeInt64>(sizeof(ValueT));
  const bool fits = count >= 0 && count <= std::numeric_limits<vtkTypeInt64>::max() / size;
  return TryAllocate(array, count)
    ? Status()
    : Status::Error("not enough memory for ", what, " of ", dims[0], " x ", dims[1], " x ", dims[2],
        " samples (", fits ? std::to_string(count * size) : "more than 2^60", " bytes)");
}

#endif
