// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// The window whose OpenGL context holds a mapper's graphics resources.
#ifndef BoundWindow_h
#define BoundWindow_h

#include "vtkWeakPointer.h"

#include <cstdint>

class vtkOpenGLRenderWindow;
class vtkWindow;

class BoundWindow
{
public:
  /// Identifies a window's context, also among those that a window has one after the other. An
  /// external window claims at each render that its context is new: it counts as one context.
  static std::uint64_t ContextOf(vtkOpenGLRenderWindow* window);

  void Bind(vtkOpenGLRenderWindow* window);
  void Unbind();
  /// Whether a window was bound; it may have been destroyed since.
  bool IsBound() const { return this->Address != nullptr; }

  /// The window, or null if none is bound or it is being destroyed.
  vtkOpenGLRenderWindow* Get() const { return this->Window; }
  /// Whether this is the window, also while it is being destroyed.
  bool IsWindow(const vtkWindow* window) const { return this->Address == window; }
  /// Whether the window's present context is the one that was bound.
  bool HasContext(vtkOpenGLRenderWindow* window) const;

private:
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  const vtkWindow* Address =
    nullptr; ///< the window's; weak pointers to it become null before it goes
  std::uint64_t Context = 0;
};

#endif
