// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMIsovalueDomain.h"

#include "vtkDataObject.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMUncheckedPropertyHelper.h"

#include <algorithm>

vtkStandardNewMacro(vtkSMIsovalueDomain);

//------------------------------------------------------------------------------
void vtkSMIsovalueDomain::Update(vtkSMProperty* property)
{
  vtkPVArrayInformation* range = FindCompressedRange(this->GetRequiredProperty("Input"));
  if (!range)
  {
    this->Superclass::Update(property);
    return;
  }
  double lowest = range->GetComponentRange(0)[0];
  double highest = range->GetComponentRange(0)[1];
  for (int component = 1; component < range->GetNumberOfComponents(); ++component)
  {
    lowest = std::min(lowest, range->GetComponentRange(component)[0]);
    highest = std::max(highest, range->GetComponentRange(component)[1]);
  }
  this->SetEntries({ vtkEntry(lowest, highest) });
}

//------------------------------------------------------------------------------
vtkPVArrayInformation* vtkSMIsovalueDomain::FindCompressedRange(vtkSMProperty* inputProperty)
{
  if (!inputProperty)
  {
    return nullptr;
  }
  vtkSMUncheckedPropertyHelper input(inputProperty);
  if (input.GetNumberOfElements() == 0)
  {
    return nullptr;
  }
  vtkSMSourceProxy* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (!source)
  {
    return nullptr;
  }
  source->CreateOutputPorts();
  vtkPVDataInformation* data = source->GetDataInformation(input.GetOutputPort());
  return data ? data->GetArrayInformation("ProgIso.ZFP.Range", vtkDataObject::FIELD) : nullptr;
}

//------------------------------------------------------------------------------
void vtkSMIsovalueDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
