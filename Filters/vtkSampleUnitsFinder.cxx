// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSampleUnitsFinder.h"

#include "Codec/HiddenSamples.h"
#include "Codec/Magnitude.h"
#include "Codec/SampleUnits.h"
#include "Status.h"

#include "vtkDataArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

vtkStandardNewMacro(vtkSampleUnitsFinder);

//------------------------------------------------------------------------------
vtkSampleUnitsFinder::vtkSampleUnitsFinder()
  : Finder(std::make_unique<UnitsFinder>())
{
}

//------------------------------------------------------------------------------
vtkSampleUnitsFinder::~vtkSampleUnitsFinder() = default;

//------------------------------------------------------------------------------
void vtkSampleUnitsFinder::Initialize()
{
  *this->Finder = UnitsFinder();
  this->Modified();
}

//------------------------------------------------------------------------------
bool vtkSampleUnitsFinder::AddSamples(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden)
{
  if (!samples || !HasComponent(samples, component))
  {
    vtkErrorMacro("Component is " << component << ", but there are "
                                  << (samples ? samples->GetNumberOfComponents() : 0) << ".");
    return false;
  }
  if (hidden && hidden->GetNumberOfValues() != samples->GetNumberOfTuples())
  {
    vtkErrorMacro("There are " << hidden->GetNumberOfValues() << " values that hide "
                               << samples->GetNumberOfTuples() << " samples.");
    return false;
  }
  ChosenSamples chosen;
  if (Status status = ChooseSamples(samples, component, chosen); !status)
  {
    vtkErrorMacro(<< "There is " << status.GetMessage() << ".");
    return false;
  }
  this->Finder->Add(chosen.Array, chosen.Component, HiddenSamples::FromMask(hidden));
  return this->IsSettled();
}

//------------------------------------------------------------------------------
bool vtkSampleUnitsFinder::IsSettled() const
{
  return this->Finder->IsSettled();
}

//------------------------------------------------------------------------------
double vtkSampleUnitsFinder::GetOffset() const
{
  return this->Finder->GetUnits().Offset;
}

//------------------------------------------------------------------------------
double vtkSampleUnitsFinder::GetScale() const
{
  return this->Finder->GetUnits().Scale;
}

//------------------------------------------------------------------------------
void vtkSampleUnitsFinder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Offset: " << this->GetOffset() << "\n";
  os << indent << "Scale: " << this->GetScale() << "\n";
  os << indent << "IsSettled: " << (this->IsSettled() ? "yes\n" : "no\n");
}
