"""pyvista's accessor and plotter component, and pictures against baselines."""

import numpy as np
import pytest

import progiso
from helpers.images import blobs, marschner_lobb, reference_values, same_bits, samples_of
from helpers.pictures import check_picture

pyvista = pytest.importorskip("pyvista")

SIZE = (300, 300)


def grid(values, **geometry):
    """Return a pyvista image of values [z, y, x]."""
    image = pyvista.ImageData(dimensions=values.shape[::-1], **geometry)
    image["field"] = values.ravel()
    return image


@pytest.fixture
def plotter():
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("#203040")
    yield plotter
    plotter.close()


@pytest.fixture
def check(plotter, request, tmp_path):
    """Compare what the plotter shows with a baseline."""

    def compare(name):
        pixels = plotter.screenshot(return_img=True)
        mappers = [a.GetMapper() for a in plotter.actors.values() if a.IsA("vtkIsosurfaceVolume")]
        assert mappers and all(m.GetConverged() and m.GetNumberOfGLErrors() == 0 for m in mappers)
        check_picture(pixels, name, request.config, tmp_path)
        return pixels

    return compare


def test_accessor():
    image = grid(blobs((12, 13, 14), 1), spacing=(1, 2, 3))
    compressed = image.progiso.compress(rate=4)
    assert isinstance(compressed, pyvista.ImageData)
    assert compressed.progiso.is_compressed and not image.progiso.is_compressed
    assert compressed.progiso.info["rate"] == 4
    restored = compressed.progiso.decompress()
    assert same_bits(samples_of(restored), reference_values(compressed))
    assert restored.active_scalars_name == "field" and restored.spacing == (1, 2, 3)


def test_save_and_read(tmp_path):
    compressed = grid(blobs((12, 13, 14), 1)).progiso.compress(rate=4)
    compressed.save(tmp_path / "volume.vti")
    assert same_bits(
        reference_values(pyvista.read(tmp_path / "volume.vti")), reference_values(compressed)
    )


def test_marschner_lobb(plotter, check):
    plotter.progiso.add_isosurface(
        grid(marschner_lobb(64)).progiso.compress(rate=8), 0.5, color="tan", specular=0.4
    )
    plotter.camera_position = [(150, 110, 130), (32, 32, 32), (0, 0, 1)]
    check("marschner-lobb")


def test_among_meshes(plotter, check):
    """A mesh cuts through the surface, another shines through."""
    plotter.progiso.add_isosurface(grid(blobs((40, 40, 40), 2)), 0.1, color="ivory", rate=8)
    plotter.add_mesh(
        pyvista.Sphere(radius=12, center=(28, 12, 24)), color="steelblue", smooth_shading=True
    )
    plotter.add_mesh(pyvista.Box(bounds=(-5, 45, 18, 20, -5, 45)), color="crimson", opacity=0.4)
    plotter.camera_position = [(110, -60, 70), (20, 20, 20), (0, 0, 1)]
    check("among-meshes")


def test_cells_in_parallel_projection(plotter, check):
    image = pyvista.ImageData(dimensions=(33, 25, 41), spacing=(1, 1.5, 0.8))
    image.cell_data["field"] = blobs((40, 24, 32), 3).ravel()
    plotter.progiso.add_isosurface(image, 0.0, color="#80c0a0", ambient=0.3, diffuse=0.7)
    plotter.camera_position = [(100, 70, 60), (16, 18, 16), (0, 1, 0)]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 28
    check("cells-parallel")


def test_user_matrix(plotter, check):
    matrix = pyvista.Transform().rotate_z(30).scale(1, 1, 1.6).translate(3, 2, 1).matrix
    plotter.progiso.add_isosurface(
        grid(blobs((30, 30, 30), 4)), 0.0, color="orange", user_matrix=matrix
    )
    plotter.add_axes_at_origin(labels_off=True)
    plotter.camera_position = [(90, -40, 80), (10, 20, 20), (0, 0, 1)]
    check("user-matrix")


def test_isovalue_can_be_changed(plotter, check):
    prop = plotter.progiso.add_isosurface(grid(marschner_lobb(48)), 0.3, color="white")
    plotter.camera_position = [(110, 80, 100), (24, 24, 24), (0, 0, 1)]
    before = plotter.screenshot(return_img=True).copy()
    prop.GetProperty().GetIsoSurfaceValues().SetValue(0, 0.6)
    plotter.render()
    after = check("changed-isovalue")
    assert np.mean(np.any(before != after, axis=2)) > 0.05


@pytest.mark.parametrize("name, isovalue, position, up", [
    ("ct-cranium", 226, (0.3, 1, 0.2), (0, 0, 1)),
    ("mri-brain", 45, (-0.6, 0.5, 0.6), (0, 0, 1)),
])  # fmt: skip
def test_scans(plotter, check, name, isovalue, position, up):
    from progiso.data import fetch

    volume = pyvista.wrap(progiso.read(fetch(name))).progiso.compress(rate=8)
    plotter.progiso.add_isosurface(volume, isovalue, color="ivory")
    centre, reach = (
        np.array(volume.center),
        1.9 * max(np.subtract(volume.bounds[1::2], volume.bounds[::2])),
    )
    plotter.camera_position = [
        tuple(centre + reach * np.array(position) / np.linalg.norm(position)),
        tuple(centre),
        up,
    ]
    check(name)
