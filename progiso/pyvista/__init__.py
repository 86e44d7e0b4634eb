"""progiso in pyvista: ``image.progiso`` (`accessor`) and ``plotter.progiso`` (`plugin`)."""

# pyvista comes first: the end of its import registers `plugin`, which needs the other modules here
# whole.
import pyvista  # noqa: F401
