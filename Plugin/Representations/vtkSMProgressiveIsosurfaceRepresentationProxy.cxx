// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMProgressiveIsosurfaceRepresentationProxy.h"

#include "vtkCommand.h"
#include "vtkObjectFactory.h"
#include "vtkPVIsosurfaceInformation.h"
#include "vtkPVSession.h"
#include "vtkSMDoubleRangeDomain.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"

#include <algorithm>
#include <cstring>
#include <vector>

vtkStandardNewMacro(vtkSMProgressiveIsosurfaceRepresentationProxy);

//------------------------------------------------------------------------------
vtkSMProgressiveIsosurfaceRepresentationProxy::vtkSMProgressiveIsosurfaceRepresentationProxy() =
  default;

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
    this->TellMessages();
    this->WarnIfNothingShows();
  }
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::TellMessages()
{
  const std::string& error = this->Statistics->GetError();
  if (this->Statistics->GetNumberOfErrors() > this->ToldErrors && !error.empty())
  {
    vtkErrorMacro("Progressive Isosurface: " << error);
  }
  const std::string& warning = this->Statistics->GetWarning();
  if (this->Statistics->GetNumberOfWarnings() > this->ToldWarnings && !warning.empty())
  {
    vtkWarningMacro("Progressive Isosurface: " << warning);
  }
  this->ToldErrors = this->Statistics->GetNumberOfErrors();
  this->ToldWarnings = this->Statistics->GetNumberOfWarnings();
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::WarnIfNothingShows()
{
  vtkSMProperty* property = this->GetProperty("Isovalues");
  auto* domain =
    vtkSMDoubleRangeDomain::SafeDownCast(property->FindDomain("vtkSMDoubleRangeDomain"));
  int hasLowest = 0, hasHighest = 0;
  const double lowest = domain ? domain->GetMinimum(0, hasLowest) : 0.0;
  const double highest = domain ? domain->GetMaximum(0, hasHighest) : 0.0;
  const std::vector<double> values = vtkSMPropertyHelper(property).GetDoubleArray();
  const bool outside = hasLowest && hasHighest && lowest <= highest &&
    std::none_of(values.begin(), values.end(),
      [=](double value) { return lowest <= value && value <= highest; });
  if (outside && !this->Warned && vtkSMPropertyHelper(this, "Visibility").GetAsInt() != 0)
  {
    vtkWarningMacro(
      "Progressive Isosurface: nothing shows, the isovalues lie outside the values of "
      "the array, "
      << lowest << " to " << highest << ".");
  }
  this->Warned = outside;
}

//------------------------------------------------------------------------------
vtkPVIsosurfaceInformation* vtkSMProgressiveIsosurfaceRepresentationProxy::GetStatistics()
{
  return this->Statistics;
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::UpdatePropertyInformationInternal(
  vtkSMProperty* vtkNotUsed(property))
{
  this->GatherInformation(this->Statistics, vtkPVSession::CLIENT | vtkPVSession::RENDER_SERVER);
  const auto set = [this](const char* name, double value)
  { vtkSMPropertyHelper(this, name).Set(value); };
  set("NumberOfProcesses", this->Statistics->GetNumberOfProcesses());
  set("NumberOfPasses", this->Statistics->GetNumberOfPasses());
  set("CompletedFraction", this->Statistics->GetCompletedFraction());
  set("TotalMilliseconds", this->Statistics->GetTotalMilliseconds());
  set("GPUBytes", this->Statistics->GetGPUBytes());
  set("CompressedBytes", this->Statistics->GetCompressedBytes());
  set("BudgetBytes", this->Statistics->GetMemoryBudget());
  set("UncertainFraction", this->Statistics->GetUncertainFraction());
  const std::vector<double>& levels = this->Statistics->GetLevelPixels();
  vtkSMPropertyHelper(this, "LevelPixels")
    .Set(levels.data(), static_cast<unsigned int>(levels.size()));
  this->InvokeEvent(vtkCommand::UpdateInformationEvent);
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::SetPropertyModifiedFlag(
  const char* name, int flag)
{
  this->Superclass::SetPropertyModifiedFlag(name, flag);
  if (flag != 0 && std::strcmp(name, "IsosurfaceValues") == 0)
  {
    this->TakeOverIsosurfaceValues();
  }
}

//------------------------------------------------------------------------------
void vtkSMProgressiveIsosurfaceRepresentationProxy::TakeOverIsosurfaceValues()
{
  const std::vector<double> values = vtkSMPropertyHelper(this, "IsosurfaceValues").GetDoubleArray();
  if (!values.empty() && this->GetTrueParentProxy() && this->IsActive())
  {
    vtkSMPropertyHelper(this, "Isovalues")
      .Set(values.data(), static_cast<unsigned int>(values.size()));
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
  os << indent << "Warned: " << this->Warned << "\n";
  os << indent << "ToldErrors: " << this->ToldErrors << "\n";
  os << indent << "ToldWarnings: " << this->ToldWarnings << "\n";
}
