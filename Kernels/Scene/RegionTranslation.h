// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Which part of a volume is drawn: its own piece of an image, clipping planes, cropping regions.
#ifndef RegionTranslation_h
#define RegionTranslation_h

#include "Pipeline/ViewGeometry.h"

class vtkCompressedVolume;
class vtkImageData;
class vtkMatrix4x4;
class vtkPlaneCollection;
class vtkVolume;
class vtkVolumeMapper;

/// Finds the map from index space, in which the stream's first sample is the origin, to world
/// coordinates: extent, origin, spacing, directions and the prop's matrix.
void FindIndexToWorld(
  vtkVolume* prop, vtkImageData* image, vtkCompressedVolume* volume, vtkMatrix4x4* matrix);

/// Finds the samples between which the surface is drawn: those of the image. A stream may cover
/// more samples, which other processes draw.
void TranslateExtent(vtkImageData* image, vtkCompressedVolume* volume, ViewGeometry& view);

/// Translates planes in world coordinates; null stands for none.
void TranslateClipping(vtkPlaneCollection* planes, vtkMatrix4x4* worldToIndex, ViewGeometry& view);

/// Translates cropping regions. Their planes lie in the image's own axes, whatever its direction
/// matrix is.
void TranslateCropping(
  vtkVolumeMapper* mapper, vtkImageData* image, vtkCompressedVolume* volume, ViewGeometry& view);

#endif
