"""Lights of every kind."""

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkLightKit

from helpers.comparison import NESTED, OPAQUE, check_scene_like_vtk, show, show_lit


def test_ambient_light_only(image):
    def build(scene):
        look = show(scene, image, NESTED).GetProperty()
        look.ShadeOn()
        look.SetAmbient(0.6)
        look.SetDiffuse(0)
        look.SetSpecular(0)

    check_scene_like_vtk(build)


def directional(scene):
    scene.shine()


def two_coloured(scene):
    scene.shine((1, 0.3, 0.2)).SetIntensity(0.7)
    scene.shine((0.2, 0.5, 1), position=(-50, 70, 90)).SetIntensity(0.6)


def positional(scene):
    light = scene.shine(position=(30, 40, 55))
    light.PositionalOn()
    light.SetConeAngle(180)
    return light


def attenuated(scene):
    positional(scene).SetAttenuationValues(0.2, 0.02, 0.0005)


def spot(scene):
    light = scene.shine(position=(50, 60, 75), focus=(24, 24, 24))
    light.PositionalOn()
    light.SetConeAngle(20)
    light.SetExponent(3)


def camera_light(scene):
    scene.shine(position=(0.6, 0.7, 1), focus=(0, 0, 0)).SetLightTypeToCameraLight()


def switched(scene):
    scene.shine()
    scene.shine((1, 0, 0), position=(0, -50, 0)).SwitchOff()


def many(scene):
    for i in range(12):
        angle = 2 * np.pi * i / 12
        scene.shine(
            (i % 2, i % 3 / 2, 1), position=(60 * np.cos(angle), 60 * np.sin(angle), 40)
        ).SetIntensity(0.2)


def light_kit(scene):
    scene.renderer.AutomaticLightCreationOff()
    scene.kit = vtkLightKit()
    scene.kit.AddLightsToRenderer(scene.renderer)
    scene.kit.Update()


LIGHTS = [
    directional,
    two_coloured,
    positional,
    attenuated,
    spot,
    camera_light,
    switched,
    many,
    light_kit,
]


@pytest.mark.parametrize("two_sided", [True, False])
@pytest.mark.parametrize("lights", LIGHTS, ids=lambda lights: lights.__name__)
def test_lights(cube, lights, two_sided):
    """Both sides are lit, or only the one where the values are lower."""

    def build(scene):
        show_lit(scene, cube)
        scene.renderer.SetTwoSidedLighting(two_sided)
        lights(scene)

    check_scene_like_vtk(build)


@pytest.mark.parametrize("surfaces", [OPAQUE, NESTED])
@pytest.mark.parametrize("lights", [directional, positional])
def test_specular_light(cube, surfaces, lights):
    """One-sided, as VTK's mapper puts highlights of the other side where no mirror would.

    The highlight has a colour of its own.
    """

    def build(scene):
        show_lit(scene, cube, surfaces, specular=0.6)
        scene.renderer.TwoSidedLightingOff()
        lights(scene)
        light = scene.renderer.GetLights().GetItemAsObject(0)
        light.SetDiffuseColor(1, 0.8, 0.6)
        light.SetSpecularColor(0.1, 0.5, 1)

    check_scene_like_vtk(build)


def test_headlight(cube):
    """From far away, where VTK's headlight, which shines from the camera's position to each point,
    is ours, which shines along the view as `vtkLight` says. The material's ambient light is there,
    too."""

    def build(scene):
        show_lit(scene, cube, specular=0.3).GetProperty().SetAmbient(0.2)
        scene.look_at(cube, 1, distance=30, angle=3)

    check_scene_like_vtk(build)
