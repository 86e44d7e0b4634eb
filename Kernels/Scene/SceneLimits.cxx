// SPDX-FileCopyrightText: Copyright (c) ProgIso contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/SceneLimits.h"

#include "Scene/ShownIsovalues.h"
#include "Shaders/Glsl.h"

#include "vtkContourValues.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkPlaneCollection.h"
#include "vtkRenderer.h"
#include "vtkVolumeProperty.h"

#include <cmath>

namespace
{
Status CheckIsovalues(vtkContourValues* values)
{
  for (int i = 0; i < values->GetNumberOfContours(); ++i)
  {
    if (std::isnan(values->GetValue(i)))
    {
      return Status::Error("cannot show isovalue ", i, ": it is not a number");
    }
  }
  return Status();
}

int CountLights(vtkRenderer* renderer)
{
  int count = 0;
  vtkCollectionSimpleIterator iterator;
  vtkLightCollection* lights = renderer->GetLights();
  lights->InitTraversal(iterator);
  for (vtkLight* light = lights->GetNextLight(iterator); light;
       light = lights->GetNextLight(iterator))
  {
    count += light->GetSwitch() ? 1 : 0;
  }
  return count;
}

Status CheckCount(std::size_t count, int most, const char* what)
{
  return count <= static_cast<std::size_t>(most)
    ? Status()
    : Status::Error("takes at most ", most, " ", what, ", but there are ", count,
        ": take some away, or share them among several mappers");
}
}

Status CheckLimits(
  vtkRenderer* renderer, vtkVolumeProperty* property, vtkPlaneCollection* clippingPlanes)
{
  Status status = CheckIsovalues(property->GetIsoSurfaceValues());
  if (status)
  {
    status =
      CheckCount(FindShownIsovalues(property).size(), glsl::MAX_ISOVALUES, "isovalues that show");
  }
  if (status)
  {
    status = CheckCount(clippingPlanes ? clippingPlanes->GetNumberOfItems() : 0,
      glsl::MAX_CLIPPING_PLANES, "clipping planes");
  }
  if (status && property->GetShade())
  {
    status = CheckCount(CountLights(renderer), glsl::MAX_LIGHTS, "lights that are switched on");
  }
  return status;
}
