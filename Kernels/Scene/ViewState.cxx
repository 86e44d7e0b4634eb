// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/ViewState.h"

#include "Scene/HitGeometry.h"
#include "Scene/Palette.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{
// If several views, or eyes, take turns, each of them restarts the image: an image that stays
// incomplete would never be completed. After so many renders of one view no other is expected.
constexpr int RendersBeforeRefining = 3;

bool NearlySame(const double* a, const double* b)
{
  double difference = 0.0, size = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(a[i]));
  }
  return difference <= 1e-7 * size;
}

bool NearlySame(const PixelVector& a, const PixelVector& b)
{
  return NearlySame(a.Base, b.Base) && NearlySame(a.PerX, b.PerX) && NearlySame(a.PerY, b.PerY);
}

bool NearlySame(const LevelSpan& a, const LevelSpan& b)
{
  const double ofA[] = { a.BlendFrom, a.Until, 0.0 }, ofB[] = { b.BlendFrom, b.Until, 0.0 };
  const double weightsOfA[] = { a.FirstWeight, a.LastWeight, 1.0 };
  const double weightsOfB[] = { b.FirstWeight, b.LastWeight, 1.0 };
  return NearlySame(ofA, ofB) && NearlySame(weightsOfA, weightsOfB);
}

bool HasSameLook(const glsl::Look& a, const glsl::Look& b)
{
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): 0 and -0 only cost an image
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}
}

Obstacles FindObstacles(vtkRenderer* renderer, vtkVolume* volume)
{
  Obstacles found;
  vtkCollectionSimpleIterator iterator;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(iterator);
  for (vtkProp* prop = props->GetNextProp(iterator); prop; prop = props->GetNextProp(iterator))
  {
    if (prop != volume && prop->GetVisibility() && !prop->IsA("vtkActor2D"))
    {
      ++found.Count;
      found.Time = std::max(found.Time, prop->GetRedrawMTime());
    }
  }
  return found;
}

bool HasSameHits(const ViewGeometry& a, const ViewGeometry& b)
{
  ViewGeometry exact = b; // with a's camera, once that is found nearly the same
  for (auto vector : { &ViewGeometry::RayOrigin, &ViewGeometry::RayDirection,
         &ViewGeometry::EyeOrigin, &ViewGeometry::EyeDirection })
  {
    if (!NearlySame(a.*vector, b.*vector))
    {
      return false;
    }
    exact.*vector = a.*vector;
  }
  for (int level = 0; level < glsl::MAX_LEVELS; ++level)
  {
    if (!NearlySame(a.Levels[level], b.Levels[level]))
    {
      return false;
    }
    exact.Levels[level] = a.Levels[level];
  }
  std::copy(std::begin(a.Depth), std::end(a.Depth), exact.Depth);
  const double rangeOfA[] = { a.NearDistance, a.FarDistance, 0.0 };
  const double rangeOfB[] = { b.NearDistance, b.FarDistance, 0.0 };
  exact.NearDistance = a.NearDistance;
  exact.FarDistance = a.FarDistance;
  std::copy(a.ImageSize, a.ImageSize + 2, exact.ImageSize);
  std::copy(a.ImageOrigin, a.ImageOrigin + 2, exact.ImageOrigin);
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return NearlySame(rangeOfA, rangeOfB) && std::memcmp(&a, &exact, sizeof(a)) == 0;
}

ViewState::ViewState()
  : RendersOfView(RendersBeforeRefining)
{
}

ViewState::~ViewState() = default;

bool ViewState::Update(vtkRenderer* renderer, const PipelineScene& scene,
  const Obstacles& obstacles, const std::optional<glsl::Palette>& palette)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  const int eye = camera->GetLeftEye();
  const bool sameView = renderer == this->Renderer && eye == this->Eye;
  const bool samePalette = IsSamePalette(palette, this->Palette);
  const bool continues = this->HasScene && sameView && this->HasSameImage(scene, obstacles) &&
    (samePalette || !scene.Translucent);

  this->RendersOfView = this->Renderer && !sameView ? 0 : this->RendersOfView + 1;
  this->NewPalette = !samePalette || !this->HasScene;
  this->Palette = palette;
  this->SceneObstacles = obstacles;
  this->Renderer = renderer;
  this->Eye = eye;
  int origin[2];
  renderer->GetTiledSizeAndOrigin(
    &this->RendererSize[0], &this->RendererSize[1], &origin[0], &origin[1]);
  vtkMatrix4x4::Invert(camera->GetModelViewTransformMatrix(), this->EyeToWorld);
  const ViewGeometry view = continues ? this->Scene.View : scene.View;
  this->Scene = scene;
  this->Scene.View = view;
  this->HasScene = true;
  return continues;
}

bool ViewState::HasSameImage(const PipelineScene& scene, const Obstacles& obstacles) const
{
  return HasSameHits(this->Scene.View, scene.View) &&
    (!scene.Translucent ||
      (HasSameLook(this->Scene.Look, scene.Look) && obstacles == this->SceneObstacles));
}

bool ViewState::IsSettled() const
{
  return this->RendersOfView >= RendersBeforeRefining;
}

bool ViewState::RendererToViewport(int& x, int& y) const
{
  if (x < 0 || y < 0 || x >= this->RendererSize[0] || y >= this->RendererSize[1])
  {
    return false;
  }
  x = static_cast<int>((x + 0.5) * this->Scene.View.ViewportSize[0] / this->RendererSize[0]);
  y = static_cast<int>((y + 0.5) * this->Scene.View.ViewportSize[1] / this->RendererSize[1]);
  return true;
}

void ViewState::FindPosition(int x, int y, double t, double position[3]) const
{
  double point[4] = { 0.0, 0.0, 0.0, 1.0 };
  EyePosition(this->Scene.View, x, y, t, point);
  this->EyeToWorld->MultiplyPoint(point, point);
  std::copy(point, point + 3, position);
}
