"""progiso in pyvista: ``image.progiso`` (`accessor`) and ``plotter.progiso`` (`plugin`)."""
