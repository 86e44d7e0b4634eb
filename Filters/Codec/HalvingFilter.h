// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The filter that halves the samples along an axis (internal).
//
// Coarse sample j lies on fine sample c = 2j. Its value is the half-band filter's, [-1 0 9 16 9 0
// -1] / 32, which leaves a field of degree 3 as it is and so moves no surface to second order. It
// is limited to the range of the samples c - 1, c and c + 1, so that no coarse sample lies beyond
// what the fine ones around it hold: nothing rings beside an edge.
//
// Borders. The first and the last fine sample stay as they are. A sample that the filter lacks
// beyond them is that mirrored in the border sample, in place and value. Where the number of fine
// samples is even, the last coarse sample, one beyond the border, has the value of the last fine
// one.
//
// Hidden samples weigh nothing: where one of the fine samples c - 3 to c + 3 is hidden, the value
// is the mean of the visible ones of c - 1, c and c + 1 by the weights 1, 2 and 1, at a border that
// of the border sample, else of its neighbour. Without any, the coarse sample is hidden.
//
// Figures: Testing/Benchmarks/results/levels.md.
#ifndef HalvingFilter_h
#define HalvingFilter_h

#include "Codec/LevelSlice.h"

namespace HalvingFilter
{
/// Fine samples that the filter reaches to each side.
constexpr int Reach = 3;
constexpr int Taps = 2 * Reach + 1;

/// Makes `count` coarse samples of the rows c - 3 to c + 3, of which those beyond the border have
/// no values. `hidden` may be null if no row hides any.
void FilterAcross(const LevelRow rows[Taps], int count, float* values, unsigned char* hidden);

/// Makes the coarse samples of a row of `count` fine ones. `hidden` may be null if the row hides
/// none.
void FilterAlong(const LevelRow& row, int count, float* values, unsigned char* hidden);
}

#endif
