// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/BoundWindow.h"

#include "vtkOpenGLRenderWindow.h"

std::uint64_t BoundWindow::ContextOf(vtkOpenGLRenderWindow* window)
{
  return window->IsA("vtkExternalOpenGLRenderWindow")
    ? static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(window))
    : static_cast<std::uint64_t>(window->GetContextCreationTime());
}

void BoundWindow::Bind(vtkOpenGLRenderWindow* window)
{
  this->Window = window;
  this->Address = window;
  this->Context = ContextOf(window);
}

void BoundWindow::Unbind()
{
  this->Window = nullptr;
  this->Address = nullptr;
}

bool BoundWindow::HasContext(vtkOpenGLRenderWindow* window) const
{
  return ContextOf(window) == this->Context;
}
