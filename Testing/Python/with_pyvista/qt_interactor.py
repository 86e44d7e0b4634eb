"""Shows an isosurface in `pyvistaqt.QtInteractor` and prints as JSON how it refined.

That is the fractions complete after each image, the turns of Qt's event loop before it, and whether
it ended as the image that is made at once. The argument is where to save a picture of the window.
"""

import json
import sys

import numpy as np
from pyvistaqt import QtInteractor
from qtpy import QtCore, QtWidgets

import progiso
from helpers.images import blobs, make_image

FIRST_IMAGES = 5  # the mapper may complete a new window's first ones at once
PATIENCE = 120000  # milliseconds; an image that never completes has failed

application = QtWidgets.QApplication([])
window = QtWidgets.QMainWindow()
window.resize(400, 320)
plotter = QtInteractor(window, auto_update=False)
window.setCentralWidget(plotter)
image = progiso.compress(make_image(blobs((60, 56, 64), 12, waves=6)), rate=8)
mapper = plotter.progiso.add_isosurface(image, isovalue=0.1, color="ivory").GetMapper()
mapper.SetDecodeWholeVolume(False)  # passes also of a small volume,
mapper.SetSpeculationLimit(1)  # many of them,
mapper.SetTimeAllowance(0.0)  # and each shown

images = []
turns = 0


def look(*_):
    images.append({"completed": mapper.GetCompletedFraction(), "turns": turns})


def turn():
    global turns
    turns += 1
    if images and images[-1]["completed"] == 1.0:
        application.quit()


mapper.AddObserver("ProgressEvent", look)
timer = QtCore.QTimer()
timer.timeout.connect(turn)
timer.start(0)
QtCore.QTimer.singleShot(PATIENCE, application.quit)
window.show()
for _ in range(FIRST_IMAGES):
    application.exec_()
    plotter.render()
plotter.camera.azimuth += 20
mapper.EmptyCache()
images.clear()
plotter.render()
application.exec_()
timer.stop()

refined = progiso.depth(mapper)
window.grab().save(sys.argv[1])
plotter.render_window.SwapBuffersOff()  # as in a screenshot
mapper.EmptyCache()
before = len(images)
plotter.render_window.Render()
at_once = [image["completed"] for image in images[before:]] == [1.0]
same = np.array_equal(refined, progiso.depth(mapper))
hits = int(np.isfinite(refined).sum())
errors = mapper.GetNumberOfGLErrors()
plotter.close()
print(
    json.dumps(
        {
            "images": images[:before],
            "at_once": at_once,
            "same": same,
            "hits": hits,
            "errors": errors,
        }
    )
)
