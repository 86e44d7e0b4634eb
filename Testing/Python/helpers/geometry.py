"""Places, solids and cuts for scenes."""

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

SHAPE = (24, 32, 28)  # z, y, x
CENTRE = np.array([13.5, 15.5, 11.5])

TURNED = np.array([[0.8, -0.6, 0, 3], [0.6, 0.8, 0, -2], [0, 0, 1, 1], [0, 0, 0, 1.0]])
STRETCHED = np.diag([1.5, 0.7, 1.2, 1.0])
MIRRORED = np.diag([-1.0, 1.0, 1.0, 1.0])

REGIONS = {"sub-volume": 0x2000, "fence": 0x2EBFEBA, "inverted fence": 0x5140145, "cross": 0x417410,
           "inverted cross": 0x7BE8BEF, "arbitrary": 0x1A53C96}  # fmt: skip


PLANES = (8, 20, 9, 22, 7, 16)


def actor_of(source, color, opacity=1.0):
    """Return an unlit actor of a source's geometry."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(color)
    actor.GetProperty().SetOpacity(opacity)
    actor.GetProperty().LightingOff()
    return actor


def ball(radius, color=(1, 0.9, 0.3), opacity=1.0, centre=CENTRE):
    """Return a sphere."""
    source = vtkSphereSource()
    source.SetCenter(centre)
    source.SetRadius(radius)
    source.SetThetaResolution(48)
    source.SetPhiResolution(48)
    return actor_of(source, color, opacity)


def wall(camera, share, color=(0.1, 0.9, 0.9), opacity=1.0):
    """Return a square across the view that covers half the picture.

    It stands at a share of the way from the camera to its focal point.
    """
    place, focus = np.array(camera.GetPosition()), np.array(camera.GetFocalPoint())
    forward = focus - place
    right = np.cross(forward, camera.GetViewUp())
    right *= np.linalg.norm(forward) / np.linalg.norm(right)
    up = np.cross(right, forward)
    up *= np.linalg.norm(forward) / np.linalg.norm(up)
    centre = place + share * forward
    source = vtkPlaneSource()
    source.SetOrigin(centre - up)
    source.SetPoint1(centre - up + 2 * right)
    source.SetPoint2(centre + up)
    return actor_of(source, color, opacity)


def planes(*normals):
    """Yield planes through the centre, by their normals."""
    for normal in normals:
        plane = vtkPlane()
        plane.SetOrigin(CENTRE)
        plane.SetNormal(normal)
        yield plane
