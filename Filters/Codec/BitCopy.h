// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BitCopy_h
#define BitCopy_h

#include "vtkType.h"

/**
 * Copies `count` bits from bit `fromBit` of a stream to bit `toBit` of another. A stream is 64-bit
 * little-endian words, lowest bit first, at any address. Keeps what precedes these bits in the
 * first word that it writes, clears what follows in the last, and reads no word without bits to
 * copy. The streams must not overlap.
 */
void CopyBits(
  const void* from, vtkTypeInt64 fromBit, void* to, vtkTypeInt64 toBit, vtkTypeInt64 count);

#endif
