"""A translucent isosurface beside whatever else is translucent: it shows, without a message."""

import session
from paraview import simple

view = session.start()
wavelet = session.make_wavelet(10)


def hide_all():
    for source in simple.GetSources().values():
        simple.Hide(source, view)
    view.AxesGrid.Visibility = 0


def show_isosurface(source=wavelet, **properties):
    look = {"Isovalues": [157.0], "Opacity": 0.4, **properties}
    return session.show_isosurface(source, view, **look)


def show_translucent(source, representation="Surface"):
    display = simple.Show(source, view)
    display.SetRepresentationType(representation)
    display.Opacity = 0.4
    return display


def add_axes_grid():
    view.AxesGrid.Visibility = 1


def add_data_axes():
    show_isosurface().DataAxesGrid.GridAxesVisibility = 1


def add_slice():
    show_translucent(simple.Slice(Input=wavelet))


def add_contour():
    show_translucent(simple.Contour(Input=wavelet, ContourBy="RTData", Isosurfaces=[200.0]))


def add_outline():
    show_translucent(simple.Outline(Input=wavelet))


def add_volume():
    other = simple.Wavelet(WholeExtent=[2, 14] * 3)
    show_translucent(other, "Volume")
    simple.ColorBy(simple.GetDisplayProperties(other, view), ("POINTS", "RTData"))


def add_isosurface():
    show_isosurface(simple.Wavelet(WholeExtent=[2, 14] * 3), Isovalues=[120.0])


def add_all():
    for add in (add_axes_grid, add_slice, add_contour, add_volume, add_isosurface):
        add()


show_isosurface()
session.look(view)
seen = {}
ADDED = [add_axes_grid, add_data_axes, add_slice, add_contour, add_outline, add_volume]
for add in [*ADDED, add_isosurface, add_all]:
    hide_all()
    add()
    name = add.__name__
    without = session.screenshot(view, f"translucent_{name}_without.png")
    with session.messages() as listener:
        display = show_isosurface()
        both = session.screenshot(view, f"translucent_{name}.png")
        simple.ColorBy(display, ("POINTS", "RTData"))
        display.SetScalarBarVisibility(view, False)
        simple.Render(view)
        simple.ColorBy(display, None)
    assert not listener.GetOutput(), f"{name}: {listener.GetOutput()}"
    seen[name] = float((abs(both - without).max(axis=2) > 8).mean())
    if add is not add_data_axes:  # which is the isosurface's own
        assert seen[name] > 0.08, f"{name}: {seen[name]}"
    display.DataAxesGrid.GridAxesVisibility = 0
session.finish(**seen)
