"""Two dozen isovalues at once, opaque and as layers of glass: the picture of ParaView's Contour."""

import numpy
import session
from paraview import simple

view = session.start([120, 90])
view.MaximumNumberOfPeels = 60
ISOVALUES = list(numpy.linspace(3, 15, 24))
distance = simple.Calculator(
    Input=session.make_wavelet(10), ResultArrayName="distance", Function="mag(coords)"
)
contour = simple.Contour(
    Input=distance, ContourBy=["POINTS", "distance"], Isosurfaces=ISOVALUES, ComputeScalars=1
)


def show(source, opacity):
    """Return the picture of one of the two, coloured by isovalue."""
    simple.Hide(distance, view)
    simple.Hide(contour, view)
    if source is contour:
        display = simple.Show(contour, view)
    else:
        display = session.show_isosurface(
            source,
            view,
            IsosurfaceArray=["POINTS", "distance"],
            Isovalues=ISOVALUES,
            CompressionRate=16,
        )
    simple.ColorBy(display, ("POINTS", "distance"))
    display.SetScalarBarVisibility(view, False)
    simple.GetColorTransferFunction("distance").RescaleTransferFunction(0.0, 17.0)
    display.Opacity = opacity
    session.look(view)
    return session.screenshot(view, f"many_{opacity}_{source is contour}.png")


for opacity in (1.0, 0.1):
    ours, theirs = (show(source, opacity) for source in (distance, contour))
    assert session.covered(ours) > 0.2
    differing = (abs(ours - theirs).max(axis=2) > 24).mean()
    assert differing < 0.05 * session.covered(theirs), f"opacity {opacity}: {differing}"
session.finish(isovalues=len(ISOVALUES))
