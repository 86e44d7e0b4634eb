// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef TestWindow_h
#define TestWindow_h

#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include <gtest/gtest.h>

/// Tests that need an OpenGL context: that of a small window off the screen.
class TestWithWindow : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Window->SetOffScreenRendering(1);
    this->Window->SetSize(16, 16);
    this->Window->Render();
  }

  vtkNew<vtkRenderWindow> Window;
};

#endif
