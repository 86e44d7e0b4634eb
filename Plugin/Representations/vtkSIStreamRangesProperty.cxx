// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSIStreamRangesProperty.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkCompressedVolume.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkSIStreamRangesProperty);

namespace
{
//------------------------------------------------------------------------------
void OnRead(vtkObject* reader, unsigned long, void*, void*)
{
  vtkDataObject* const output = vtkAlgorithm::SafeDownCast(reader)->GetOutputDataObject(0);
  vtkCompressedVolume::SpeedUpRanges(output);
  if (auto* const blocks = vtkCompositeDataSet::SafeDownCast(output))
  {
    const auto block = vtk::TakeSmartPointer(blocks->NewIterator());
    for (block->InitTraversal(); !block->IsDoneWithTraversal(); block->GoToNextItem())
    {
      vtkCompressedVolume::SpeedUpRanges(block->GetCurrentDataObject());
    }
  }
}
}

//------------------------------------------------------------------------------
bool vtkSIStreamRangesProperty::ReadXMLAttributes(vtkSIProxy* proxy, vtkPVXMLElement* element)
{
  const bool isRead = this->Superclass::ReadXMLAttributes(proxy, element);
  if (auto* const reader = vtkAlgorithm::SafeDownCast(this->GetVTKObject()))
  {
    vtkNew<vtkCallbackCommand> onRead;
    onRead->SetCallback(OnRead);
    reader->AddObserver(vtkCommand::EndEvent, onRead);
  }
  return isRead;
}

//------------------------------------------------------------------------------
void vtkSIStreamRangesProperty::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
