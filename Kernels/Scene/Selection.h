// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Draws an image for VTK's hardware selector, which reads ids of props, blocks, processes, cells
// and points from colours.
#ifndef Selection_h
#define Selection_h

#include "GL/Device.h"

class ProgressivePipeline;
class vtkCompressedVolume;
class vtkHardwareSelector;
class vtkOpenGLState;
struct ViewGeometry;

/// What a selection names: the cells and points of an image, of a block of a composite data set.
struct SelectedImage
{
  int Extent[6] = { 0, -1, 0, -1, 0, -1 };
  unsigned int CompositeIndex = 0; ///< the block's; 0: the image is none
};

/// Finds what ids Select.frag draws for cells, or for points, of an image of this extent.
SelectedId FindIds(const int extent[6], vtkCompressedVolume* volume, bool ofPoints);

/// Draws what the selector asks for in its present pass. The pipeline's image is complete.
void DrawSelection(vtkHardwareSelector* selector, vtkOpenGLState* state, const ViewGeometry& view,
  vtkCompressedVolume* volume, const SelectedImage& image, ProgressivePipeline& pipeline);

#endif
