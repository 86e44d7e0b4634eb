"""A simulation of two steps with Catalyst, on any number of processes (in pvbatch).

Started as `pvbatch --symmetric simulation.py SCRIPT`, in the folder that the script writes to.
"""

import sys

from paraview.catalyst import bridge
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

EXTENT = [-10, 9, -10, 10, -10, 8]

bridge.initialize()
bridge.add_pipeline(sys.argv[1])
controller = vtkMultiProcessController.GetGlobalController()
process, processes = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
for step in range(2):
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(*EXTENT)
    source.SetMaximum(255 + 10 * step)
    source.UpdatePiece(process, processes, 0)
    bridge.coprocess(
        0.5 * step, step, source.GetOutputDataObject(0), name="input", wholeExtent=EXTENT
    )
bridge.finalize()
print(f"done on {processes}")
