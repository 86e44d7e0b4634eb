// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/CameraTranslation.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
constexpr int Width = 8, Height = 4;

// Index space is the camera's: rays in both are the same.
ViewGeometry RaysOf(vtkCamera* camera)
{
  ViewGeometry view = {};
  view.ViewportSize[0] = Width;
  view.ViewportSize[1] = Height;
  vtkNew<vtkMatrix4x4> identity;
  TranslateRays(
    camera->GetProjectionTransformMatrix(double(Width) / Height, -1, 1), identity, view);
  return view;
}

double At(const PixelVector& vector, int axis, double x, double y)
{
  return vector.Base[axis] + x * vector.PerX[axis] + y * vector.PerY[axis];
}
}

TEST(CameraTranslation, PerspectiveRaysMeetInTheEye)
{
  vtkNew<vtkCamera> camera;
  camera->SetViewAngle(60.0);
  const ViewGeometry view = RaysOf(camera);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(At(view.RayOrigin, axis, 1.5, 2.5), 0.0, 1e-15);
  }
  // the angle is the height's, from the centre to the upper border half of it
  EXPECT_NEAR(At(view.RayDirection, 1, Width / 2.0, Height), std::tan(M_PI / 6.0), 1e-14);
  EXPECT_NEAR(At(view.RayDirection, 0, Width, 0.0), 2.0 * std::tan(M_PI / 6.0), 1e-14);
  EXPECT_NEAR(At(view.RayDirection, 0, Width / 2.0, 0.0), 0.0, 1e-15);
  // the parameter is the depth along the view direction
  EXPECT_EQ(At(view.RayDirection, 2, 0.5, 0.5), -1.0);
  EXPECT_EQ(At(view.RayDirection, 2, 7.5, 3.5), -1.0);
}

TEST(CameraTranslation, ParallelRaysStartOnTheCamerasPlane)
{
  vtkNew<vtkCamera> camera;
  camera->ParallelProjectionOn();
  camera->SetParallelScale(3.0);
  const ViewGeometry view = RaysOf(camera);
  EXPECT_NEAR(At(view.RayOrigin, 1, 0.0, Height), 3.0, 1e-14);
  EXPECT_NEAR(At(view.RayOrigin, 0, 0.0, 0.0), -6.0, 1e-14);
  EXPECT_EQ(At(view.RayOrigin, 2, 2.0, 2.0), 0.0);
  for (int axis = 0; axis < 2; ++axis)
  {
    EXPECT_NEAR(At(view.RayDirection, axis, 6.5, 0.5), 0.0, 1e-15);
  }
  EXPECT_EQ(At(view.RayDirection, 2, 6.5, 0.5), -1.0);
}

TEST(CameraTranslation, MovesOriginsButNotDirections)
{
  vtkNew<vtkCamera> camera;
  ViewGeometry view = RaysOf(camera);
  const ViewGeometry still = view;
  vtkNew<vtkMatrix4x4> eyeToIndex;
  for (int axis = 0; axis < 3; ++axis)
  {
    eyeToIndex->SetElement(axis, 3, 10.0 * (axis + 1));
  }
  TranslateRays(
    camera->GetProjectionTransformMatrix(double(Width) / Height, -1, 1), eyeToIndex, view);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_EQ(view.RayOrigin.Base[axis], still.RayOrigin.Base[axis] + 10.0 * (axis + 1));
    EXPECT_EQ(view.RayOrigin.PerX[axis], still.RayOrigin.PerX[axis]);
    EXPECT_EQ(view.RayDirection.Base[axis], still.RayDirection.Base[axis]);
    EXPECT_EQ(view.EyeOrigin.Base[axis], still.EyeOrigin.Base[axis]);
  }
}

TEST(CameraTranslation, DepthsAreThoseOfTheProjection)
{
  vtkNew<vtkCamera> camera;
  camera->SetClippingRange(2.0, 50.0);
  glsl::Look look = {};
  TranslateDepths(camera->GetProjectionTransformMatrix(1.0, -1, 1), look);
  const auto depth = [&](double t)
  { return (look.ClipZ + t * look.ClipZPerT) / (look.ClipW + t * look.ClipWPerT); };
  EXPECT_NEAR(depth(2.0), -1.0, 1e-6);
  EXPECT_NEAR(depth(50.0), 1.0, 1e-6);
}

TEST(CameraTranslation, NormalsAreGradientsByTheTransposedMatrix)
{
  vtkNew<vtkMatrix4x4> eyeToIndex; // voxels of 1 x 2 x 4, much too large for float's range
  const double scale = 1e60;
  for (int axis = 0; axis < 3; ++axis)
  {
    eyeToIndex->SetElement(axis, axis, scale / (1 << axis));
  }
  eyeToIndex->SetElement(0, 1, 0.5 * scale);
  glsl::Look look = {};
  TranslateNormals(eyeToIndex, look);
  EXPECT_EQ(look.NormalMatrix[0][0], 1.0f);
  EXPECT_EQ(look.NormalMatrix[1][1], 0.5f);
  EXPECT_EQ(look.NormalMatrix[2][2], 0.25f);
  EXPECT_EQ(look.NormalMatrix[0][1], 0.5f); // columns: a gradient in x turns towards y
  EXPECT_EQ(look.NormalMatrix[1][0], 0.0f);
}

TEST(CameraTranslation, FindsRaysThatAreNotFinite)
{
  vtkNew<vtkCamera> camera;
  ViewGeometry view = RaysOf(camera);
  EXPECT_TRUE(HasRays(view));
  view.RayDirection.PerY[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(HasRays(view));
  view = RaysOf(camera);
  view.RayOrigin.Base[2] = 1e201;
  EXPECT_FALSE(HasRays(view));
}
