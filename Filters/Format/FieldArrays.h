// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Typed access to arrays of field data (internal). Messages of errors are sentences that name the
// array.
#ifndef FieldArrays_h
#define FieldArrays_h

#include "Status.h"

#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkType.h"

class vtkBlockMask;

namespace FieldArrays
{
/// Gets an array of exactly `count` integers of any type.
Status GetIntegers(vtkFieldData* fields, const char* name, int count, vtkTypeInt64* values);

/// Gets an array of one integer in [low, high].
Status GetInteger(vtkFieldData* fields, const char* name, int low, int high, int& value);

/// Gets an array of exactly `count` floating point numbers.
Status GetReals(vtkFieldData* fields, const char* name, int count, double* values);

/// Gets the mask of a volume of so many blocks; an empty one if the array is missing.
Status GetMask(vtkFieldData* fields, const char* name, vtkTypeInt64 blocks, vtkBlockMask& mask);

/// Stores a mask, unless it is empty.
void StoreMask(vtkFieldData* fields, const char* name, const vtkBlockMask& mask);

/// Makes of a mask's array, if there is one, one that VTK's writers can handle.
void ReplaceMask(vtkFieldData* fields, const char* name);

template <typename ArrayT, typename T>
void StoreValues(vtkFieldData* fields, const char* name, const T* values, int count)
{
  vtkNew<ArrayT> array;
  array->SetName(name);
  array->SetNumberOfValues(count);
  for (int i = 0; i < count; ++i)
  {
    array->SetValue(i, values[i]);
  }
  fields->AddArray(array);
}

template <typename ArrayT, typename T>
void StoreValue(vtkFieldData* fields, const char* name, const T& value)
{
  StoreValues<ArrayT>(fields, name, &value, 1);
}
}

#endif
