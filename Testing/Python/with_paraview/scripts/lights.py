"""ParaView's lights act on the isosurface as on Contour's mesh: its light kit, and added lights."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet()
display = session.show_isosurface(wavelet, view, Isovalues=[150.0])
session.look(view)
contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0])
mesh = simple.Show(contour, view)
mesh.SetRepresentationType("Surface")
simple.ColorBy(mesh, None)
simple.Hide(contour, view)
for shown in (display, mesh):
    shown.DiffuseColor, shown.Specular = [1.0, 1.0, 1.0], 0.3
found, pictures = {}, {}


def compare(name):
    """Hold the isosurface's picture against the mesh's; keep the mean difference in grey levels."""
    ours = session.screenshot(view, f"lights_{name}.png")
    simple.Hide(wavelet, view)
    simple.Show(contour, view)
    theirs = session.screenshot(view, f"lights_{name}_mesh.png")
    simple.Hide(contour, view)
    simple.Show(wavelet, view)
    surface = abs(first - first[0, 0]).max(axis=2) > 8
    found[name] = float(abs(ours - theirs)[surface].mean())
    assert found[name] < 2.0, (name, found)
    pictures[name] = ours


first = session.screenshot(view, "lights_first.png")
compare("kit")
view.KeyLightIntensity, view.KeyLightWarmth, view.KeyLightElevation = 0.4, 0.9, -30.0
compare("other_kit")
assert abs(pictures["other_kit"] - pictures["kit"]).mean() > 3
view.UseLight = 0
compare("none")
light = simple.AddLight(view=view)
for name, settings in {
    "headlight_red": {"Coords": "Headlight", "DiffuseColor": [1.0, 0.2, 0.1]},
    "camera": {"Coords": "Camera", "Position": [1.0, 1.0, 1.0], "Intensity": 0.7},
    "scene": {"Coords": "Scene", "Position": [60.0, 30.0, 0.0]},
    "positional": {"Type": "Positional"},
    "spot": {"ConeAngle": 15.0},
}.items():
    for key, value in settings.items():
        setattr(light, key, value)
    before = pictures[list(pictures)[-1]]
    compare(name)
    assert abs(pictures[name] - before).mean() > 0.5, name

session.finish(**found)
