"""Scenes that either mapper can draw, ours or VTK's own isosurface mapper, and their comparison."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkVolume,
    vtkWindowToImageFilter,
)
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

import progiso
from helpers.images import reference_volume
from helpers.scenes import orbit
from progiso import vtkIsosurfaceVolume, vtkProgressiveIsosurfaceMapper
from progiso.measure import tolerances

SIZE = (160, 128)
BACKGROUND = (0.2, 0.3, 0.4)

RED, GREEN, BLUE = (0.9, 0.2, 0.1), (0.2, 0.8, 0.3), (0.3, 0.4, 1.0)
OPAQUE = {0.1: (*GREEN, 1.0)}
NESTED = {-0.4: (*RED, 0.3), 0.1: (*GREEN, 0.5), 0.6: (*BLUE, 0.8)}

#: VTK's step, in voxels of the finest axis: its hits are late by up to so much.
STEP = 0.05


def paint(volume, surfaces):
    """Give a volume isosurfaces `{isovalue: (red, green, blue, opacity)}`.

    Each colour is flat around its isovalue.
    """
    look = volume.GetProperty()
    look.GetIsoSurfaceValues().SetNumberOfContours(len(surfaces))
    values = sorted(surfaces)
    reach = 0.45 * min((b - a for a, b in zip(values, values[1:])), default=1)
    color, opacity = look.GetRGBTransferFunction(), look.GetScalarOpacity()
    color.RemoveAllPoints()
    opacity.RemoveAllPoints()
    for i, value in enumerate(values):
        look.GetIsoSurfaceValues().SetValue(i, value)
        for place in (value - reach, value + reach):
            color.AddRGBPoint(place, *surfaces[value][:3])
            opacity.AddPoint(place, surfaces[value][3])


def matrix_of(values):
    """Return a 4x4 array as VTK's matrix."""
    matrix = vtkMatrix4x4()
    matrix.DeepCopy(np.asarray(values, float).ravel())
    return matrix


def picture_of(window):
    """Return a window's colours [row, column, rgb] as floats, row 0 at the top."""
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    width, height, _ = grab.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)
    return pixels[::-1, :, :3].astype(float)


class ComparisonScene:
    """A window for one of the two mappers. The same calls make the same scene for both.

    Parameters
    ----------
    ours : bool
        whose mapper draws the volumes that are added.
    size : (int, int)
    samples : int
        of multisampling.
    """

    def __init__(self, ours, size=SIZE, samples=0):
        self.ours = ours
        self.volumes = []
        self.clipping_range = None  # the camera's; None: what holds the scene
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(BACKGROUND)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(samples)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)

    @property
    def camera(self):
        return self.renderer.GetActiveCamera()

    @property
    def mapper(self):
        return self.volumes[0].GetMapper()

    def add(self, image, surfaces, matrix=None, renderer=None, **settings):
        """Add the isosurfaces of a compressed image; return the volume.

        Only our mapper takes `settings`.
        """
        volume = vtkIsosurfaceVolume() if self.ours else vtkVolume()
        volume.SetMapper(self.make_mapper(**settings))
        self.feed(volume.GetMapper(), image)
        paint(volume, surfaces)
        volume.GetProperty().SetInterpolationTypeToLinear()
        if matrix is not None:
            volume.SetUserMatrix(matrix_of(matrix))
        (renderer or self.renderer).AddVolume(volume)
        self.volumes.append(volume)
        return volume

    def add_mesh(self, image, surfaces, matrix=None):
        """Add the isosurfaces as triangles; translucent ones are peeled. Return the last actor."""
        for value, (*color, opacity) in surfaces.items():
            mapper, actor = vtkPolyDataMapper(), vtkActor()
            mapper.SetInputData(progiso.contour(image, value))
            mapper.ScalarVisibilityOff()
            actor.SetMapper(mapper)
            actor.GetProperty().SetColor(color)
            actor.GetProperty().SetOpacity(opacity)
            actor.GetProperty().LightingOff()
            if matrix is not None:
                actor.SetUserMatrix(matrix_of(matrix))
            self.renderer.AddActor(actor)
        if any(look[3] < 1 for look in surfaces.values()):
            self.peel(False)
        self.look_at(image)
        return actor

    def peel(self, volumes):
        """Have the renderer peel depths, of volumes too or of geometry alone."""
        self.window.SetAlphaBitPlanes(1)
        self.renderer.UseDepthPeelingOn()
        self.renderer.SetUseDepthPeelingForVolumes(volumes)
        self.renderer.SetMaximumNumberOfPeels(20)
        self.renderer.SetOcclusionRatio(0)

    def make_mapper(self, **settings):
        """Return the mapper that is compared, ours with `settings`."""
        if not self.ours:
            mapper = vtkOpenGLGPUVolumeRayCastMapper()
            mapper.SetBlendModeToIsoSurface()
            mapper.AutoAdjustSampleDistancesOff()
            return mapper
        mapper = vtkProgressiveIsosurfaceMapper()
        for name, value in settings.items():
            getattr(mapper, "Set" + name)(value)
        return mapper

    def feed(self, mapper, image):
        """Give a mapper a compressed image.

        VTK's gets the decompressed samples: both see the same values.
        """
        mapper.SetInputData(image if self.ours else progiso.decompress(image))
        if not self.ours:
            mapper.SetSampleDistance(STEP * min(np.abs(image.GetSpacing())))

    def look_at(self, image, view=1, distance=1.5, angle=50.0, camera=None):
        """Point a camera at an image, from one of the four places of an orbit."""
        place = orbit(reference_volume(image), view, 4, angle, distance)
        camera = camera or self.camera
        camera.SetPosition(place.position)
        camera.SetFocalPoint(place.focal_point)
        camera.SetViewUp(place.view_up)
        camera.SetViewAngle(place.view_angle)

    def shine(self, color=(1, 1, 1), position=(80, 60, 40), focus=(0, 0, 0)):
        """Add a light of the scene; the first takes the place of the automatic one. Return it."""
        self.renderer.AutomaticLightCreationOff()
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetColor(color)
        light.SetPosition(position)
        light.SetFocalPoint(focus)
        self.renderer.AddLight(light)
        return light

    def render(self):
        """Render; our image has to be complete."""
        if self.clipping_range is None:
            self.renderer.ResetCameraClippingRange()
        else:
            self.camera.SetClippingRange(self.clipping_range)
        self.window.Render()
        for volume in self.volumes if self.ours else []:
            if not self.renderer.HasViewProp(volume):
                continue
            assert volume.GetMapper().GetConverged()
            assert volume.GetMapper().GetNumberOfGLErrors() == 0

    def picture(self):
        """Render; return the picture."""
        self.render()
        return picture_of(self.window)


def both(build, **settings):
    """Build a scene for each of the mappers; return the two scenes."""
    scenes = ComparisonScene(ours=True, **settings), ComparisonScene(ours=False, **settings)
    for scene in scenes:
        build(scene)
    return scenes


def far_apart(ours, theirs, beside=None):
    """Return how far pictures differ, `beside` some pixels.

    That is the share of pixels that differ by more levels than allowed, and the mean difference.
    """
    difference = np.abs(ours - theirs).max(axis=2)
    if beside is not None:
        difference = difference[~beside]
    return (difference > tolerances.VTK_LEVELS).mean(), difference.mean()


def check_like_vtk(ours, theirs, beside=None):
    """Hold our picture against VTK's. This is the one definition of agreement."""
    assert ours.shape == theirs.shape
    assert (np.abs(theirs - theirs[0, 0]).max(axis=2) > 0).mean() > 0.05, (
        "VTK's picture shows next to nothing"
    )
    share, mean = far_apart(ours, theirs, beside)
    assert share <= tolerances.VTK_PIXELS and mean <= tolerances.VTK_MEAN, (
        f"{share:.2%} of the pixels are not VTK's, {mean:.2f} levels in the mean"
    )


def check_scene_like_vtk(build, **settings):
    """Build a scene for both mappers and compare their pictures.

    Return the scenes, and our picture.
    """
    ours, theirs = both(build, **settings)
    picture = ours.picture()
    check_like_vtk(picture, theirs.picture())
    return ours, theirs, picture


def show(scene, image, surfaces=OPAQUE, view=1, **settings):
    """Add a volume that the camera looks at; return it."""
    volume = scene.add(image, surfaces, **settings)
    scene.look_at(image, view)
    return volume


def show_lit(scene, image, surfaces=OPAQUE, specular=0.0, **settings):
    """Add a lit volume without ambient light; return it.

    Where a light is in the scene VTK's mapper has that light's ambient colour, on no colour of the
    surface.
    """
    volume = show(scene, image, surfaces, **settings)
    look = volume.GetProperty()
    look.ShadeOn()
    look.SetAmbient(0.0)
    look.SetDiffuse(0.7)
    look.SetSpecular(specular)
    look.SetSpecularPower(8)
    return volume
