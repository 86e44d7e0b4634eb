// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/RefinementTimer.h"

#include "vtkCommand.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"

RefinementTimer::~RefinementTimer()
{
  this->Observe(nullptr);
}

bool RefinementTimer::CanRenderAgain(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  return interactor && interactor->GetInitialized() && !window->GetOffScreenRendering() &&
    window->GetSwapBuffers();
}

void RefinementTimer::RequestRender(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  if (this->Interactor != interactor)
  {
    this->Observe(interactor);
  }
  if (this->PendingTimer < 0)
  {
    this->PendingTimer = interactor->CreateOneShotTimer(1);
  }
}

void RefinementTimer::Observe(vtkRenderWindowInteractor* interactor)
{
  if (this->Interactor)
  {
    this->Interactor->RemoveObserver(this->Observer);
  }
  this->Interactor = interactor;
  this->PendingTimer = -1;
  if (interactor)
  {
    this->Observer =
      interactor->AddObserver(vtkCommand::TimerEvent, this, &RefinementTimer::OnTimer);
  }
}

void RefinementTimer::OnTimer(vtkObject*, unsigned long, void* timerId)
{
  if (!timerId || *static_cast<int*>(timerId) != this->PendingTimer)
  {
    return;
  }
  this->PendingTimer = -1;
  if (this->Interactor)
  {
    this->Interactor->Render();
  }
}
