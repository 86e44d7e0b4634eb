// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineRequests.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"

//------------------------------------------------------------------------------
void PipelineRequests::CopyGeometry(vtkInformation* input, vtkInformation* output)
{
  output->CopyEntry(input, vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  output->CopyEntry(input, vtkDataObject::SPACING());
  output->CopyEntry(input, vtkDataObject::ORIGIN());
  output->CopyEntry(input, vtkDataObject::DIRECTION());
}

//------------------------------------------------------------------------------
void PipelineRequests::RequestWholeExtent(vtkInformation* input)
{
  input->Set(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(),
    input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()), 6);
}
