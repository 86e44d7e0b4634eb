// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The arrays that an image has beside the compressed one, on an isosurface (internal).
#ifndef OtherArrays_h
#define OtherArrays_h

class vtkDataSetAttributes;
class vtkPolyData;

namespace OtherArrays
{
/// Interpolates arrays linearly at a surface's points, which lie on edges between samples, in index
/// coordinates. `extent` has the samples that the arrays hold; points beyond get values of its
/// faces. An array whose name the surface's points have already is left out, and so are flags.
void Interpolate(vtkDataSetAttributes* arrays, const int extent[6], vtkPolyData* surface);
}

#endif
