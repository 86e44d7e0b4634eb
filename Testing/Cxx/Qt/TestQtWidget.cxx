// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// In VTK's widget for Qt the image refines by Qt's event loop, which other events share, and ends
// as the image that is made at once.
#include "CompressionTestTools.h"

#include <gtest/gtest.h>

#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkContourValues.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkIsosurfaceVolume.h>
#include <vtkProgressiveIsosurfaceMapper.h>
#include <vtkRTAnalyticSource.h>
#include <vtkRenderer.h>
#include <vtkVolumeProperty.h>

#include <QApplication>
#include <QSurfaceFormat>
#include <QTimer>
#include <QVTKOpenGLNativeWidget.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{
constexpr int FIRST_IMAGES = 5;  // the mapper may complete a new window's first ones at once
constexpr int PATIENCE = 120000; // milliseconds; an image that never completes has failed

// Fractions that were complete after each image, and turns of the event loop in between.
struct Watch
{
  std::vector<double> Completed;
  int Turns = 0;
  int TurnsAtFirst = -1;

  static void OnImage(vtkObject*, unsigned long, void* watch, void* fraction)
  {
    auto* self = static_cast<Watch*>(watch);
    self->Completed.push_back(*static_cast<double*>(fraction));
    if (self->TurnsAtFirst < 0 && self->Completed.back() > 0.0)
    {
      self->TurnsAtFirst = self->Turns;
    }
  }
};

std::vector<float> Depths(vtkProgressiveIsosurfaceMapper* mapper)
{
  vtkNew<vtkImageData> image;
  if (!mapper->GetDepthImage(image))
  {
    return {};
  }
  auto* values = vtkFloatArray::SafeDownCast(image->GetPointData()->GetScalars());
  return { values->GetPointer(0), values->GetPointer(0) + values->GetNumberOfValues() };
}
}

TEST(QtWidget, RefinesByEventLoop)
{
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-32, 32, -32, 32, -32, 32);
  vtkNew<vtkProgressiveIsosurfaceMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->DecodeWholeVolumeOff(); // passes also of a small volume,
  mapper->SetSpeculationLimit(1); // many of them,
  mapper->SetTimeAllowance(0.0);  // and each shown
  vtkNew<vtkVolumeProperty> property;
  property->GetIsoSurfaceValues()->SetValue(0, 150.0);
  property->ShadeOn();
  vtkNew<vtkIsosurfaceVolume> volume;
  volume->SetMapper(mapper);
  volume->SetProperty(property);
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->GetActiveCamera()->Azimuth(30.0);
  renderer->ResetCamera();

  QVTKOpenGLNativeWidget widget;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  widget.setRenderWindow(window);
  window->AddRenderer(renderer);
  widget.resize(320, 240);

  Watch watch;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&watch);
  observer->SetCallback(&Watch::OnImage);
  mapper->AddObserver(vtkCommand::ProgressEvent, observer);
  QTimer turns;
  QObject::connect(&turns, &QTimer::timeout,
    [&]
    {
      ++watch.Turns;
      if (!watch.Completed.empty() && watch.Completed.back() == 1.0)
      {
        QApplication::quit();
      }
    });
  turns.start(0);
  const auto untilComplete = [&]
  {
    watch = Watch();
    window->Render();
    QApplication::exec();
  };
  QTimer::singleShot(PATIENCE, qApp, &QApplication::quit);
  widget.show();
  for (int i = 0; i < FIRST_IMAGES; ++i)
  {
    untilComplete();
  }
  renderer->GetActiveCamera()->Azimuth(20.0);
  mapper->EmptyCache();
  untilComplete();

  const std::vector<double>& completed = watch.Completed;
  EXPECT_TRUE(completed.size() > 3) << completed.size() << " images";
  EXPECT_TRUE(std::is_sorted(completed.begin(), completed.end())) << "an image lost what it had";
  EXPECT_TRUE(mapper->GetConverged()) << "not complete";
  EXPECT_TRUE(watch.Turns > watch.TurnsAtFirst + 1)
    << "other events had to wait until the image was there";
  const std::vector<float> refined = Depths(mapper);
  EXPECT_TRUE(std::count_if(refined.begin(), refined.end(),
                [](float depth) { return std::isfinite(depth); }) > 1000)
    << "hardly anything to see";

  // the same at once, as a window makes it that nobody watches
  window->SwapBuffersOff();
  mapper->EmptyCache();
  const std::size_t images = completed.size();
  window->Render();
  EXPECT_TRUE(watch.Completed.size() > images && watch.Completed[images] == 1.0)
    << watch.Completed.size() - images << " images, the first of them " << watch.Completed.back();
  EXPECT_TRUE(Depths(mapper) == refined) << "another image";
  EXPECT_TRUE(mapper->GetNumberOfGLErrors() == 0) << "OpenGL errors";
}

int main(int argc, char* argv[])
{
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
  QApplication application(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
