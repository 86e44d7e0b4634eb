// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Draws an image for VTK's hardware selector, which reads prop and cell ids from colours.
#ifndef Selection_h
#define Selection_h

class ProgressivePipeline;
class vtkCompressedVolume;
class vtkHardwareSelector;
class vtkOpenGLState;
struct ViewGeometry;

/// Draws what the selector asks for in its present pass. The pipeline's image is complete.
void DrawSelection(vtkHardwareSelector* selector, vtkOpenGLState* state, const ViewGeometry& view,
  vtkCompressedVolume* volume, ProgressivePipeline& pipeline);

#endif
