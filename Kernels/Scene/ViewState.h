// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
// What the present image shows, and whether a render needs another one.
#ifndef ViewState_h
#define ViewState_h

#include "Pipeline/PipelineScene.h"

#include "vtkNew.h"
#include "vtkType.h"

#include <optional>

class vtkMatrix4x4;
class vtkRenderer;
class vtkVolume;

/// The props that may hide a translucent isosurface.
struct Obstacles
{
  int Count = 0;
  vtkMTimeType Time = 0; ///< when one of them last changed

  bool operator==(const Obstacles& other) const
  {
    return this->Count == other.Count && this->Time == other.Time;
  }
};

/// Finds the visible props beside a volume that do not lie flat on the window.
Obstacles FindObstacles(vtkRenderer* renderer, vtkVolume* volume);

/// Whether rays have the same hits in both. Cameras are compared with a relative tolerance of 1e-7
/// (vtkWindowToImageFilter perturbs the view angle by rounding), everything else exactly; the image
/// follows from it.
bool HasSameHits(const ViewGeometry& a, const ViewGeometry& b);

class ViewState
{
public:
  ViewState();
  ~ViewState();
  ViewState(const ViewState&) = delete;
  void operator=(const ViewState&) = delete;

  /// Takes what a render shows. Returns whether the image continues: its hits are the same. A new
  /// look restarts only translucent images, whose layers are blended as they are found.
  bool Update(vtkRenderer* renderer, const PipelineScene& scene, const Obstacles& obstacles,
    const std::optional<glsl::Palette>& palette);
  /// Forgets the scene: the next render starts another image.
  void Forget() { this->HasScene = false; }

  bool IsKnown() const { return this->HasScene; }
  const PipelineScene& GetScene() const { return this->Scene; }
  const std::optional<glsl::Palette>& GetPalette() const { return this->Palette; }
  /// Whether the last Update() brought other colours, or began anew.
  bool HasNewPalette() const { return this->NewPalette; }
  bool IsOf(vtkRenderer* renderer) const { return this->Renderer == renderer; }

  /// Whether one view has been rendered often enough to expect that no other takes turns with it.
  bool IsSettled() const;

  ///@{ Of the viewport's pixels, which may be more than the renderer's: a pass may draw into a
  /// larger framebuffer of its own.
  /// Turns a pixel of the renderer into the viewport's; false if it lies outside.
  bool RendererToViewport(int& x, int& y) const;
  /// Finds the world position with parameter t on a pixel's ray.
  void FindPosition(int x, int y, double t, double position[3]) const;
  ///@}

private:
  bool HasSameImage(const PipelineScene& scene, const Obstacles& obstacles) const;

  PipelineScene Scene;
  bool HasScene = false;
  std::optional<glsl::Palette> Palette;
  bool NewPalette = false;
  Obstacles SceneObstacles;
  vtkNew<vtkMatrix4x4> EyeToWorld;
  int RendererSize[2] = { 0, 0 };
  const vtkRenderer* Renderer = nullptr; ///< of the last render; it may be gone
  int Eye = 0;                           ///< 1: left
  int RendersOfView;                     ///< since another view was rendered
};

#endif
