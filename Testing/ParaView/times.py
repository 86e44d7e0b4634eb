"""Times of ParaView's ways to an isosurface: a first image, turning, still, a new isovalue.

    pvpython times.py BUILD OUTPUT [SIDE]

BUILD holds the plugin; the wavelet has SIDE samples a side, 256 by default. Ways take turns, so
that what else the machine does meets all of them; each figure is a median. Prints a table in
Markdown, of seconds and, in brackets, of CPU seconds of all threads: llvmpipe draws in several,
and other work on the machine does not count. Wants a display (README.md).
"""

import pathlib
import statistics
import sys
import time

from paraview import simple

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "Python/with_paraview/scripts"))
import session  # noqa: E402  (reads BUILD and OUTPUT)

SIDE = int(sys.argv[3]) if len(sys.argv) > 3 else 256
ROUNDS, FRAMES = 5, 5
ISOVALUE, OTHERS = 157.0, (150.0, 165.0, 140.0, 175.0, 130.0)

#: Name of a way, its representation, and whether it has a mesh or a compressed volume of its own.
WAYS = {
    "Progressive Isosurface": "Progressive Isosurface",
    "the same of ZFP Compress": "Progressive Isosurface",
    "the same of a .zfp file": "Progressive Isosurface",
    "Contour and Surface": "Surface",
    "Volume": "Volume",
    "Volume, blend mode Isosurface": "Volume",
}


def timed(work):
    """Return the seconds that something takes, and the CPU seconds."""
    begin, cpu = time.perf_counter(), time.process_time()
    work()
    return time.perf_counter() - begin, time.process_time() - cpu


def shown(times):
    """Return the medians of seconds and CPU seconds as a cell of the table."""
    wall, cpu = (statistics.median(part) for part in zip(*times, strict=True))
    return f"{wall:.2f} ({cpu:.2f})"


class Way:
    """One of the ways: what is shown, and the times that it took, by column."""

    def __init__(self, name, view, wavelet, compressed, path):
        self.name, self.view, self.times = name, view, {}
        first = timed(lambda: self.show(wavelet, compressed, path))
        self.times["first image"] = [first]
        self.hide()

    def show(self, wavelet, compressed, path):
        self.source = {
            "the same of ZFP Compress": lambda: compressed,
            "the same of a .zfp file": lambda: simple.OpenDataFile(str(path)),
            "Contour and Surface": lambda: simple.Contour(
                Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISOVALUE]
            ),
        }.get(self.name, lambda: wavelet)()
        self.display = simple.Show(self.source, self.view)
        self.display.SetRepresentationType(WAYS[self.name])
        if "Isosurface" in WAYS[self.name]:
            self.display.Isovalues = [ISOVALUE]
        elif "blend" in self.name:
            self.display.BlendMode = "Isosurface"
            self.display.IsosurfaceValues = [ISOVALUE]
        elif self.name != "Volume":
            simple.ColorBy(self.display, None)
        simple.Render(self.view)

    def set_isovalue(self, value):
        if self.name == "Contour and Surface":
            self.source.Isosurfaces = [value]
        elif "blend" in self.name:
            self.display.IsosurfaceValues = [value]
        else:
            self.display.Isovalues = [value]
        simple.Render(self.view)

    def hide(self):
        simple.Hide(self.source, self.view)

    def turn(self):
        self.view.GetActiveCamera().Azimuth(3)
        self.view.SMProxy.InteractiveRender()

    def round(self, isovalue):
        """Turn, stand still, and take another isovalue."""
        simple.Show(self.source, self.view)
        self.display.SetRepresentationType(WAYS[self.name])
        simple.Render(self.view)
        self.turn()
        for _ in range(FRAMES):
            self.add("turning", self.turn)
        self.add("still after turning", lambda: simple.Render(self.view))
        if self.name != "Volume":
            self.add("new isovalue", lambda: self.set_isovalue(isovalue))
        self.hide()

    def add(self, column, work):
        self.times.setdefault(column, []).append(timed(work))


def main():
    view = session.start([800, 600])
    wavelet = session.make_wavelet(SIDE // 2)
    compressed = simple.ZFPCompress(Input=wavelet, Rate=8.0)
    times = {"compress": timed(compressed.UpdatePipeline)}
    path = pathlib.Path(sys.argv[2]) / "times.zfp"
    simple.SaveData(str(path), compressed)
    sphere = simple.Sphere()  # the window and ParaView's own shaders
    simple.Show(sphere, view)
    session.look(view)
    simple.Render(view)
    simple.Hide(sphere, view)
    view.CameraFocalPoint, view.CameraPosition = [0.0] * 3, [0.0, -2.5 * SIDE, 1.2 * SIDE]
    ways = [Way(name, view, wavelet, compressed, path) for name in WAYS]
    for number in range(ROUNDS):
        for way in ways:
            way.round(OTHERS[number % len(OTHERS)])
    columns = ("first image", "turning", "still after turning", "new isovalue")
    print("| seconds | " + " | ".join(columns) + " |\n|---" + "|---" * len(columns) + "|")
    for way in ways:
        cells = [shown(way.times[c]) if c in way.times else "" for c in columns]
        print(f"| {way.name} | " + " | ".join(cells) + " |")
    print(f"\nCompressing alone: {shown([times['compress']])} s.")


main()
