"""progiso in pyvista: ``image.progiso`` and ``plotter.progiso``, see `plugin`."""
