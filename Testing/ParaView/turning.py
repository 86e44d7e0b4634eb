"""CPU time of interactive frames by the volume's size: ours, Contour's and Volume's.

    pvpython turning.py BUILD OUTPUT SIDE...

The wavelet with SIDE samples a side, settings of ParaView at their defaults. Prints a table in
Markdown: medians of nine frames, in CPU milliseconds of all threads, which other work on the
machine hardly changes. Wants a display (README.md).
"""

import pathlib
import statistics
import sys
import time

from paraview import simple

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "Python/with_paraview/scripts"))
import session  # noqa: E402  (reads BUILD and OUTPUT)

FRAMES, ISOVALUE = 9, 157.0


def turn(view):
    """Return the CPU milliseconds of an interactive frame, the camera turned by 3 degrees."""
    view.GetActiveCamera().Azimuth(3)
    begin = time.process_time()
    view.SMProxy.InteractiveRender()
    return 1e3 * (time.process_time() - begin)


def measure(view, source, representation, **properties):
    """Show a source and return the median of its interactive frames; hide it again."""
    display = simple.Show(source, view)
    display.SetRepresentationType(representation)
    for name, value in properties.items():
        setattr(display, name, value)
    simple.Render(view)
    turn(view), turn(view)
    median = statistics.median(turn(view) for _ in range(FRAMES))
    simple.Hide(source, view)
    return median


def main():
    view = session.start([800, 600])
    print("| side | Progressive Isosurface | Contour and Surface | Volume |\n|---|---|---|---|")
    for side in map(int, sys.argv[3:]):
        wavelet = session.make_wavelet(side // 2)
        contour = simple.Contour(
            Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISOVALUE]
        )
        view.CameraFocalPoint, view.CameraPosition = [0.0] * 3, [0.0, -2.5 * side, 1.2 * side]
        times = (
            measure(view, wavelet, session.PROGRESSIVE_ISOSURFACE, Isovalues=[ISOVALUE]),
            measure(view, contour, "Surface", ColorArrayName=[None, ""]),
            measure(view, wavelet, "Volume"),
        )
        print(f"| {side} | " + " | ".join(f"{time:.0f}" for time in times) + " |", flush=True)


main()
