// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// Asks a window's interactor to render again while an image is incomplete.
#ifndef RefinementTimer_h
#define RefinementTimer_h

#include "vtkWeakPointer.h"

class vtkObject;
class vtkRenderWindow;
class vtkRenderWindowInteractor;

class RefinementTimer
{
public:
  RefinementTimer() = default;
  ~RefinementTimer();
  RefinementTimer(const RefinementTimer&) = delete;
  void operator=(const RefinementTimer&) = delete;

  /// Whether a window is on screen and its interactor runs, so that it can render again by itself.
  static bool CanRenderAgain(vtkRenderWindow* window);

  /// Requests one render of the window as soon as its interactor is idle.
  void RequestRender(vtkRenderWindow* window);

private:
  void Observe(vtkRenderWindowInteractor* interactor);
  void OnTimer(vtkObject* caller, unsigned long event, void* timerId);

  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  unsigned long Observer = 0;
  int PendingTimer = -1; ///< none
};

#endif
