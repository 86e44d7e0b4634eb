// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FieldArrays.h"

#include "vtkBlockMask.h"
#include "vtkDataArray.h"
#include "vtkTypeUInt64Array.h"
#include "vtkVariant.h"

#include <string>

namespace
{
//------------------------------------------------------------------------------
// Finds an array of `count` integers, or floating point numbers.
Status FindNumbers(
  vtkFieldData* fields, const char* name, int count, bool integers, vtkDataArray*& array)
{
  array = vtkArrayDownCast<vtkDataArray>(fields->GetAbstractArray(name));
  const int type = array ? array->GetDataType() : VTK_VOID;
  const bool floating = type == VTK_FLOAT || type == VTK_DOUBLE;
  if (!array || floating == integers || array->GetNumberOfValues() != count)
  {
    return Status::Error("its field data array ", name,
      array ? " does not hold " : " is missing: expected ", count,
      integers ? " integer" : " floating point", count > 1 ? " values" : " value");
  }
  return {};
}
}

//------------------------------------------------------------------------------
Status FieldArrays::GetIntegers(
  vtkFieldData* fields, const char* name, int count, vtkTypeInt64* values)
{
  vtkDataArray* array = nullptr;
  const Status status = FindNumbers(fields, name, count, true, array);
  for (int i = 0; i < count && status; ++i)
  {
    values[i] = array->GetVariantValue(i).ToTypeInt64(); // exact, where GetComponent() is a double
  }
  return status;
}

//------------------------------------------------------------------------------
Status FieldArrays::GetInteger(
  vtkFieldData* fields, const char* name, int low, int high, int& value)
{
  vtkTypeInt64 number = 0;
  if (Status status = GetIntegers(fields, name, 1, &number); !status)
  {
    return status;
  }
  if (number < low || number > high)
  {
    return Status::Error(name, " is ", number, ", not in ", low, "..", high);
  }
  value = static_cast<int>(number);
  return {};
}

//------------------------------------------------------------------------------
Status FieldArrays::GetReals(vtkFieldData* fields, const char* name, int count, double* values)
{
  vtkDataArray* array = nullptr;
  const Status status = FindNumbers(fields, name, count, false, array);
  for (int i = 0; i < count && status; ++i)
  {
    values[i] = array->GetVariantValue(i).ToDouble();
  }
  return status;
}

//------------------------------------------------------------------------------
Status FieldArrays::GetMask(
  vtkFieldData* fields, const char* name, vtkTypeInt64 blocks, vtkBlockMask& mask)
{
  vtkAbstractArray* array = fields->GetAbstractArray(name);
  if (!array)
  {
    return {};
  }
  vtkDataArray* numbers = vtkArrayDownCast<vtkDataArray>(array);
  const std::string error =
    numbers ? mask.FromArray(numbers, blocks) : std::string("does not hold numbers");
  return error.empty() ? Status() : Status::Error("its field data array ", name, " ", error);
}

//------------------------------------------------------------------------------
void FieldArrays::StoreMask(vtkFieldData* fields, const char* name, const vtkBlockMask& mask)
{
  if (!mask.IsEmpty())
  {
    const auto array = mask.ToArray();
    array->SetName(name);
    fields->AddArray(array);
  }
}

//------------------------------------------------------------------------------
void FieldArrays::ReplaceMask(vtkFieldData* fields, const char* name)
{
  auto* const array = vtkArrayDownCast<vtkDataArray>(fields->GetAbstractArray(name));
  if (array && array->GetNumberOfComponents() == 2 && array->GetDataTypeSize() == 8)
  {
    fields->AddArray(vtkBlockMask::CopyArray(array));
  }
}
