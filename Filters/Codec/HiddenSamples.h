// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   HiddenSamples
 * @brief   which samples of an array are hidden (internal)
 */
#ifndef HiddenSamples_h
#define HiddenSamples_h

#include "vtkType.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>

struct HiddenSamples
{
  const unsigned char* Flags = nullptr; ///< ghost flags of every tuple; null: no sample has any
  unsigned char HidingFlags = 0;        ///< flags that hide
  bool HideNonFinite = false;           ///< whether NaN and infinite samples are hidden

  /// Hides the samples whose value in a mask, which may be null, is not 0.
  static HiddenSamples FromMask(vtkUnsignedCharArray* mask)
  {
    HiddenSamples hidden;
    hidden.Flags = mask ? mask->GetPointer(0) : nullptr;
    hidden.HidingFlags = 0xff;
    return hidden;
  }

  bool MayHide() const { return this->Flags || this->HideNonFinite; }

  /// Whether a tuple's flags hide it.
  bool IsFlagged(vtkTypeInt64 tuple) const
  {
    return this->Flags && (this->Flags[tuple] & this->HidingFlags);
  }

  bool IsHidden(vtkTypeInt64 tuple, float value) const
  {
    return this->IsFlagged(tuple) || (this->HideNonFinite && !std::isfinite(value));
  }
};

#endif
