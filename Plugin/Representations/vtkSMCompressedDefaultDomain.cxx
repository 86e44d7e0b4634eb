// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMCompressedDefaultDomain.h"

#include "vtkObjectFactory.h"
#include "vtkSMIsovalueDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cstring>

vtkStandardNewMacro(vtkSMCompressedDefaultDomain);

//------------------------------------------------------------------------------
int vtkSMCompressedDefaultDomain::SetDefaultValues(vtkSMProperty* property, bool useUnchecked)
{
  vtkSMProxy* part = property->GetParent();
  vtkSMProxy* whole = part ? part->GetTrueParentProxy() : nullptr;
  vtkSMProperty* type = whole ? whole->GetProperty("Representation") : nullptr;
  if (type && vtkSMIsovalueDomain::FindCompressedRange(this->GetRequiredProperty("Input")))
  {
    // ParaView's default of image data
    vtkSMPropertyHelper helper(type);
    if (helper.GetAsString() && std::strcmp(helper.GetAsString(), "Outline") == 0)
    {
      helper.Set("Progressive Isosurface");
    }
  }
  return this->Superclass::SetDefaultValues(property, useUnchecked);
}

//------------------------------------------------------------------------------
void vtkSMCompressedDefaultDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
