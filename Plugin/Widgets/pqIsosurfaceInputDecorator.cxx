// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "pqIsosurfaceInputDecorator.h"

#include "pqCoreUtilities.h"
#include "pqPropertyWidget.h"
#include "vtkCommand.h"
#include "vtkPVXMLElement.h"
#include "vtkSMEnumerationDomain.h"
#include "vtkSMIsovalueDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

#include <cstring>

//-----------------------------------------------------------------------------
pqIsosurfaceInputDecorator::pqIsosurfaceInputDecorator(
  vtkPVXMLElement* config, pqPropertyWidget* parentObject)
  : Superclass(config, parentObject)
  , Input(parentObject->proxy()->GetProperty("Input"))
  , Component(parentObject->proxy()->GetProperty("IsosurfaceComponent"))
{
  if (this->Input)
  {
    pqCoreUtilities::connect(this->Input, vtkCommand::ModifiedEvent, this, SLOT(followInput()));
  }
  if (this->Component)
  {
    pqCoreUtilities::connect(
      this->Component, vtkCommand::DomainModifiedEvent, this, SIGNAL(visibilityChanged()));
  }
  this->followInput();
}

//-----------------------------------------------------------------------------
pqIsosurfaceInputDecorator::~pqIsosurfaceInputDecorator() = default;

//-----------------------------------------------------------------------------
void pqIsosurfaceInputDecorator::followInput()
{
  vtkSMPropertyHelper helper(this->Input, /*quiet=*/true);
  vtkSMProxy* source =
    this->Input && helper.GetNumberOfElements() > 0 ? helper.GetAsProxy() : nullptr;
  if (source != this->Source)
  {
    this->Source = source;
    if (source)
    {
      pqCoreUtilities::connect(
        source, vtkCommand::UpdateDataEvent, this, SIGNAL(visibilityChanged()));
    }
  }
  Q_EMIT this->visibilityChanged();
}

//-----------------------------------------------------------------------------
bool pqIsosurfaceInputDecorator::canShowWidget(bool showAdvanced) const
{
  if (this->wants("input", "plain") && vtkSMIsovalueDomain::FindCompressedRange(this->Input))
  {
    return false;
  }
  if (this->wants("components", "several"))
  {
    auto* choice =
      this->Component ? this->Component->FindDomain<vtkSMEnumerationDomain>() : nullptr;
    if (!choice || choice->GetNumberOfEntries() < 2)
    {
      return false;
    }
  }
  return this->Superclass::canShowWidget(showAdvanced);
}

//-----------------------------------------------------------------------------
bool pqIsosurfaceInputDecorator::wants(const char* attribute, const char* value) const
{
  const char* given = this->xml()->GetAttribute(attribute);
  return given && std::strcmp(given, value) == 0;
}
