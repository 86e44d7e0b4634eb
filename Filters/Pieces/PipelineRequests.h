// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the filters of compressed volumes answer and ask for in VTK's pipeline (internal).
#ifndef PipelineRequests_h
#define PipelineRequests_h

class vtkInformation;

namespace PipelineRequests
{
/// Announces an output with the input's whole extent, spacing, origin and direction matrix.
void CopyGeometry(vtkInformation* input, vtkInformation* output);

/// Asks for the whole image, because blocks lie across any cut through it.
void RequestWholeExtent(vtkInformation* input);
}

#endif
