// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMProgressiveIsosurfaceRepresentationProxy.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkSMPropertyHelper.h"

#include <cstring>

vtkStandardNewMacro(vtkSMProgressiveIsosurfaceRepresentationProxy);

//------------------------------------------------------------------------------
vtkSMProgressiveIsosurfaceRepresentationProxy::~vtkSMProgressiveIsosurfaceRepresentationProxy()
{
  this->StopObserving();
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  if (this->View == view)
  {
    return;
  }
  this->StopObserving();
  this->View = view;
  this->ImageObserver = view->AddObserver(
    vtkCommand::EndEvent, this, &vtkSMProgressiveIsosurfaceRepresentationProxy::OnImage);
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::OnImage()
{
  if (this->IsActive())
  {
    this->UpdatePropertyInformation();
  }
}

//------------------------------------------------------------------------------
bool vtkSMProgressiveIsosurfaceRepresentationProxy::IsActive()
{
  vtkSMProxy* whole = this->GetTrueParentProxy();
  if (!whole || !whole->GetProperty("Representation"))
  {
    return true;
  }
  const char* active = vtkSMPropertyHelper(whole, "Representation").GetAsString();
  return active && std::strcmp(active, "Progressive Isosurface") == 0;
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::StopObserving()
{
  if (this->View)
  {
    this->View->RemoveObserver(this->ImageObserver);
  }
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "View: " << this->View << "\n";
}
