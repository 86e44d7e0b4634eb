// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Progress_h
#define Progress_h

#include "vtkAlgorithm.h"

#include <functional>

/// Receives the fraction of the work done, now and then, in the thread that began the work.
/// Returns false to stop it.
using ProgressCallback = std::function<bool(double)>;

/// Reports progress to an algorithm, and stops when that is aborted.
inline ProgressCallback ProgressOf(vtkAlgorithm* algorithm)
{
  return [=](double fraction)
  {
    algorithm->UpdateProgress(fraction);
    return !algorithm->GetAbortExecute();
  };
}

#endif
