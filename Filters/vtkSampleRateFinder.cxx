// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSampleRateFinder.h"

#include "Codec/BlockGeometry.h"
#include "Codec/LabelDetector.h"
#include "Codec/Magnitude.h"
#include "Codec/RateFinder.h"
#include "Status.h"

#include "vtkCompressedVolume.h"
#include "vtkDataArray.h"
#include "vtkObjectFactory.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

vtkStandardNewMacro(vtkSampleRateFinder);

//------------------------------------------------------------------------------
struct vtkSampleRateFinder::Work
{
  int Dimensions[3] = { 0, 0, 0 };
  vtkTypeInt64 First = 0; // slabs of blocks of the present slab of samples
  vtkTypeInt64 Last = 0;
  RateFinder Rates;
  LabelDetector Labels;
};

//------------------------------------------------------------------------------
vtkSampleRateFinder::vtkSampleRateFinder()
  : Tolerance(LabelDetector::Tolerance)
  , Pass(std::make_unique<Work>())
{
}

//------------------------------------------------------------------------------
vtkSampleRateFinder::~vtkSampleRateFinder() = default;

//------------------------------------------------------------------------------
void vtkSampleRateFinder::SetRate(double rate)
{
  this->Pass->Rates.SetBlockBits(
    std::max(vtkCompressedVolume::BlockBitsForRate(rate), +vtkCompressedVolume::MinimumBlockBits));
  this->Modified();
}

//------------------------------------------------------------------------------
double vtkSampleRateFinder::GetRate() const
{
  return this->Pass->Rates.GetBlockBits() / 64.0;
}

//------------------------------------------------------------------------------
double vtkSampleRateFinder::GetLeastError() const
{
  return this->Pass->Rates.GetLeastError();
}

//------------------------------------------------------------------------------
void vtkSampleRateFinder::Start(const int dims[3])
{
  std::copy_n(dims, 3, this->Pass->Dimensions);
  this->Pass->First = this->Pass->Last = 0;
  this->Pass->Labels = LabelDetector();
}

//------------------------------------------------------------------------------
// Finds which blocks a slab has; false if it does not fit.
bool vtkSampleRateFinder::TakeSlab(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden, ChosenSamples& chosen)
{
  Work& pass = *this->Pass;
  const vtkTypeInt64 perSlice = static_cast<vtkTypeInt64>(pass.Dimensions[0]) * pass.Dimensions[1];
  const vtkTypeInt64 slices = samples && perSlice > 0 ? samples->GetNumberOfTuples() / perSlice : 0;
  const vtkTypeInt64 left = pass.Dimensions[2] - BlockSide * pass.Last;
  if (slices < 1 || slices > left || slices * perSlice != samples->GetNumberOfTuples() ||
    (slices % BlockSide != 0 && slices < left))
  {
    vtkErrorMacro("A slab has " << slices << " slices where " << left << " are left of "
                                << pass.Dimensions[2]
                                << "; all but the last need a multiple of 4, of whole slices.");
    return false;
  }
  if (!HasComponent(samples, component) ||
    (hidden && hidden->GetNumberOfValues() != samples->GetNumberOfTuples()))
  {
    vtkErrorMacro("Component is " << component << " of " << samples->GetNumberOfComponents()
                                  << ", or what is hidden does not fit the samples.");
    return false;
  }
  if (Status status = ChooseSamples(samples, component, chosen); !status)
  {
    vtkErrorMacro(<< "There is " << status.GetMessage() << ".");
    return false;
  }
  pass.First = pass.Last;
  pass.Last += BlocksAlong(slices);
  pass.Rates.Hidden = HiddenSamples::FromMask(hidden);
  pass.Rates.Hidden.HideNonFinite = this->MaskNonFinite && HasNonFinite(chosen.Array);
  pass.Rates.Units = { this->Offset, this->Scale };
  pass.Rates.Tolerance = this->Tolerance;
  pass.Rates.Threads = this->NumberOfThreads;
  pass.Labels.Hidden = pass.Rates.Hidden;
  return true;
}

//------------------------------------------------------------------------------
bool vtkSampleRateFinder::AddForLabels(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden)
{
  Work& pass = *this->Pass;
  ChosenSamples chosen;
  if (!this->TakeSlab(samples, component, hidden, chosen))
  {
    return false;
  }
  pass.Labels.AddSlabs(pass.Dimensions, pass.First, pass.Last, chosen.Array, chosen.Component);
  return !pass.Labels.IsSettled();
}

//------------------------------------------------------------------------------
bool vtkSampleRateFinder::AddSlab(
  vtkDataArray* samples, int component, vtkUnsignedCharArray* hidden)
{
  Work& pass = *this->Pass;
  ChosenSamples chosen;
  if (!this->TakeSlab(samples, component, hidden, chosen))
  {
    return false;
  }
  pass.Rates.AddSlabs(pass.Dimensions, pass.First, pass.Last, chosen.Array, chosen.Component);
  return true;
}

//------------------------------------------------------------------------------
bool vtkSampleRateFinder::FindsLabels() const
{
  return this->Pass->Labels.FindsLabels();
}

//------------------------------------------------------------------------------
void vtkSampleRateFinder::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Offset: " << this->Offset << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "MaskNonFinite: " << (this->MaskNonFinite ? "on\n" : "off\n");
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Rate: " << this->GetRate() << "\n";
  os << indent << "LeastError: " << this->GetLeastError() << "\n";
}
