// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The pixels whose rays can meet a volume: an image costs what these cost.
#ifndef ImageRectangle_h
#define ImageRectangle_h

#include "Pipeline/ViewGeometry.h"

/// Finds the image: the least rectangle of the viewport in which the drawn part of the volume lies,
/// as far as it is in the clipping range, and a pixel around it. Empty where nothing of it is in
/// the viewport; all of the viewport where a place in the volume is not known to half a pixel.
void FindImage(ViewGeometry& view);

/// Whether the image has no pixels.
bool IsEmpty(const ViewGeometry& view);

#endif
