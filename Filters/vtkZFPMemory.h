// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Memory for arrays whose size a file or a caller chose (internal): where there is not enough,
// VTK's arrays throw, through code and languages that do not expect it.
#ifndef vtkZFPMemory_h
#define vtkZFPMemory_h

#include "vtkType.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>

namespace vtkZFPMemory
{
/**
 * Gives an array `count` values, not initialised; false where there is no memory for them.
 */
template <typename ArrayT>
bool Allocate(ArrayT* array, vtkTypeInt64 count)
{
  using ValueT = typename ArrayT::ValueType;
  const vtkTypeInt64 size = static_cast<vtkTypeInt64>(sizeof(ValueT));
  if (count < 0 || count > std::numeric_limits<vtkTypeInt64>::max() / size)
  {
    return false;
  }
  void* const memory = std::malloc(std::max<vtkTypeInt64>(count, 1) * size);
  if (memory)
  {
    array->SetArray(static_cast<ValueT*>(memory), count, 0, ArrayT::VTK_DATA_ARRAY_FREE);
  }
  return memory != nullptr;
}

/**
 * What to say then: "not enough memory for WHAT of 5 x 5 x 5 samples (500 bytes)".
 */
inline std::string Objection(const char* what, const int dims[3], vtkTypeInt64 bytes)
{
  std::ostringstream message;
  message << "not enough memory for " << what << " of " << dims[0] << " x " << dims[1] << " x "
          << dims[2] << " samples (";
  bytes < 0 ? message << "more than 2^60 bytes)" : message << bytes << " bytes)";
  return message.str();
}
}

#endif
