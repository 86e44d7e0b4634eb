"""What is hidden, blanked points and cells and NaN, leaves clean holes, and nothing else changes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter
from vtkmodules.vtkRenderingCore import vtkLight

import progiso
from helpers.images import (
    blobs,
    make_image,
    metadata,
    noise,
    reference_values,
    reference_volume,
    same_bits,
    samples_of,
    stream_of,
)
from helpers.layers import crossings_of, places
from helpers.messages import vtk_messages
from helpers.scenes import CACHED, Scene, least_budget, orbit
from progiso import vtkCompressedVolume
from progiso.measure import tolerances
from progiso.oracle.caster import Camera

HIDDEN_POINT, HIDDEN_CELL = vtkDataSetAttributes.HIDDENPOINT, vtkDataSetAttributes.HIDDENCELL
REFINED_CELL = vtkDataSetAttributes.REFINEDCELL
SHAPE = (26, 31, 29)
ISOVALUE = 0.15
SIZE = (120, 90)


def blank(image, points=None, cells=None, flag=HIDDEN_CELL):
    """Hide points and cells, given as arrays [z, y, x] of booleans; return the image."""
    for hidden, data, value in (
        (points, image.GetPointData(), HIDDEN_POINT),
        (cells, image.GetCellData(), flag),
    ):
        if hidden is not None:
            ghosts = numpy_to_vtk(np.where(hidden, value, 0).astype(np.uint8).ravel(), deep=True)
            ghosts.SetName(vtkDataSetAttributes.GhostArrayName())
            data.AddArray(ghosts)
    return image


def ball(shape, radius, centre=0.5):
    """A ball in an array [z, y, x]: a hole with a smooth border."""
    place = [np.arange(n) - centre * (n - 1) for n in shape]
    return sum(p**2 for p in np.meshgrid(*place, indexing="ij")) < radius**2


def speckles(shape, share=0.15, seed=4):
    """Many small holes."""
    return np.random.default_rng(seed).random(shape) < share


def cells_of(points):
    """The cells, named by their lowest corners, that have one of some points."""
    cells = np.zeros(np.array(points.shape) - 1, bool)
    for corner in np.ndindex(2, 2, 2):
        cells |= points[tuple(slice(c, n - 1 + c) for c, n in zip(corner, points.shape))]
    return cells


def fewer(shape):
    return tuple(n - 1 for n in shape)


def nan_image(hidden, values):
    return make_image(np.where(hidden, np.float32(np.nan), values))


#: How something gets hidden: the image, compressed, and the cells between its samples that have no surface.
def hidden_points():
    hidden = ball(SHAPE, 12)
    return progiso.compress(blank(make_image(blobs(SHAPE, 3)), points=hidden), rate=12), cells_of(
        hidden
    )


def hidden_cells():
    hidden = ball(fewer(SHAPE), 12)
    return progiso.compress(blank(make_image(blobs(SHAPE, 3)), cells=hidden), rate=12), hidden


def refined_cells():
    hidden = ball(fewer(SHAPE), 12, 0.2)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3)), cells=hidden, flag=REFINED_CELL), rate=12
    ), hidden


def hidden_cells_of_cell_data():
    hidden = speckles(SHAPE, 0.03)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3), cells=True), cells=hidden), rate=12
    ), cells_of(hidden)


def hidden_points_of_cell_data():
    points = ball([n + 1 for n in SHAPE], 11, 0.4)
    hidden = cells_of(points)
    return progiso.compress(
        blank(make_image(blobs(SHAPE, 3), cells=True), points=points), rate=12
    ), cells_of(hidden)


def nan_samples():
    hidden = speckles(SHAPE, 0.02) | ball(SHAPE, 7, 0.8)
    return progiso.compress(nan_image(hidden, blobs(SHAPE, 3)), rate=12, mask_nan=True), cells_of(
        hidden
    )


def all_together():
    points, cells, nan = speckles(SHAPE, 0.01), ball(fewer(SHAPE), 6), ball(SHAPE, 5, 0.1)
    image = blank(nan_image(nan, blobs(SHAPE, 3)), points, cells)
    return progiso.compress(image, rate=12, mask_nan=True), cells_of(points | nan) | cells


KINDS = [
    hidden_points,
    hidden_cells,
    refined_cells,
    hidden_cells_of_cell_data,
    hidden_points_of_cell_data,
    nan_samples,
]
KINDS += [all_together]


def check_depth(scene, image, hidden, isovalues=(ISOVALUE,)):
    """Hold depths against the caster's first crossing in a cell that is not hidden."""
    got = scene.depth()
    volume = reference_volume(image)
    crossings = crossings_of(volume, isovalues, scene.camera, SIZE, scene.clipping_range)
    cells = np.floor(places(crossings, volume, scene.camera, SIZE)).astype(int)
    x, y, z = np.clip(cells, 0, np.array(hidden.shape[::-1]) - 1).T
    seen = crossings.only(~hidden[z, y, x])
    expected = np.full(SIZE[0] * SIZE[1], np.inf)
    np.minimum.at(expected, seen.ray, seen.depth)
    expected = expected.reshape(got.shape)
    assert np.isfinite(expected).mean() > 0.05
    without = np.full(expected.size, np.inf)
    np.minimum.at(without, crossings.ray, crossings.depth)
    assert (expected != without.reshape(got.shape)).mean() > 0.02, "nothing that is seen is hidden"
    same = got == expected
    near = (
        np.abs(np.subtract(got, expected, out=np.zeros(got.shape), where=~same))
        <= tolerances.DEPTH_VOXELS
    )
    assert (~(same | near)).mean() <= tolerances.LAYERS_PIXELS
    return got


# --- on the GPU --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", KINDS)
def test_depths_are_the_casters(make):
    image, hidden = make()
    camera = orbit(reference_volume(image), 1, 4, distance=0.9)
    whole = check_depth(Scene(image, ISOVALUE, camera, SIZE), image, hidden)
    budget = least_budget(image, ISOVALUE, camera, SIZE, **CACHED)
    scene = Scene(image, ISOVALUE, camera, SIZE, lit=True, MemoryBudget=budget, **CACHED)
    assert np.array_equal(scene.depth(), whole)
    assert np.array_equal(scene.picture(), Scene(image, ISOVALUE, camera, SIZE, lit=True).picture())


def test_several_isovalues():
    image, hidden = all_together()
    scene = Scene(image, -0.2, orbit(reference_volume(image), 2, 4), SIZE)
    scene.volume.GetProperty().GetIsoSurfaceValues().SetValue(1, 0.3)
    check_depth(scene, image, hidden, (-0.2, 0.3))


def test_the_mapper_hides_what_its_plain_input_does():
    """And follows what changes there."""
    values = blobs(SHAPE, 3)
    image = blank(make_image(values), ball(SHAPE, 9))
    scene = Scene(
        image, ISOVALUE, orbit(reference_volume(progiso.compress(image)), 1, 4), SIZE, Rate=12
    )
    before = scene.depth()
    assert np.array_equal(
        before, Scene(progiso.compress(image, rate=12), ISOVALUE, scene.camera, SIZE).depth()
    )
    image.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName()).Fill(0)
    image.GetPointData().GetArray(vtkDataSetAttributes.GhostArrayName()).Modified()
    after = scene.depth()
    assert (after != before).any()
    assert np.array_equal(
        after,
        Scene(progiso.compress(make_image(values), rate=12), ISOVALUE, scene.camera, SIZE).depth(),
    )


def test_nan_is_an_error_unless_it_is_hidden():
    hidden = ball(SHAPE, 9)
    image = nan_image(hidden, blobs(SHAPE, 3))
    scene = Scene(image, ISOVALUE, Camera((14, 14, 90), (14, 14, 12)), SIZE, Rate=12)
    with vtk_messages() as messages:
        scene.window.Render()
    assert (
        len(messages) == 1
        and f"{hidden.sum()} NaN" in messages[0]
        and "MaskNonFinite" in messages[0]
    )
    scene.mapper.MaskNonFiniteOn()
    check_depth(scene, progiso.compress(image, rate=12, mask_nan=True), cells_of(hidden))


@pytest.mark.parametrize("cached", [False, True])
@pytest.mark.parametrize("make", [speckles, lambda shape: ball(shape, 8)])
def test_light_at_the_border_of_a_hole(make, cached):
    """Differences of samples do not reach into what is hidden: a plane's light is that of the plane up to the border."""
    z, y, x = np.meshgrid(*[np.arange(n, dtype=np.float32) for n in SHAPE], indexing="ij")
    values = z + 0.4 * y + 0.3 * x
    hidden = make(SHAPE)
    images = (
        progiso.compress(make_image(values), rate=32),
        progiso.compress(blank(make_image(values), hidden), rate=32),
    )
    pictures = []
    for image in images:
        scene = Scene(
            image,
            20.3,
            Camera((14, 15, 80), (14, 15, 12), view_angle=25),
            SIZE,
            lit=True,
            DecodeWholeVolume=not cached,
        )
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.SetPosition(50, 90, 70)
        scene.renderer.AddLight(light)
        scene.volume.GetProperty().SetSpecular(0)
        scene.render()
        pictures.append(scene.picture().astype(int))
        depth = progiso.depth(scene.mapper)
    seen = np.isfinite(depth)
    plane = np.median(pictures[0][seen], axis=0)
    assert (
        0.1
        < seen.mean()
        < 0.9 * np.isfinite(Scene(images[0], 20.3, scene.camera, SIZE).depth()).mean() + 0.1
    )
    # at the volume's own border differences are one-sided, as in VTK's mapper, and of half the slope
    inside = seen & (np.abs(pictures[0] - plane).max(axis=2) <= 1)
    assert inside.mean() > 0.1
    assert np.abs(pictures[1][inside] - plane).max() <= 1


def test_what_hiding_takes():
    """Nothing where nothing is hidden; else the mask, and 16 bytes a slot."""
    image, _ = hidden_points()
    plain = progiso.compress(make_image(blobs(SHAPE, 3)), rate=12)
    camera = orbit(reference_volume(plain), 1, 4)
    memory = []
    for each in (plain, image):
        scene = Scene(each, ISOVALUE, camera, SIZE, **CACHED)
        scene.render()
        memory.append(scene.statistics()["memory"]["buffers"])
    assert "hidden_cells" not in memory[0]
    assert 0 < memory[1]["hidden_cells"] < 16 * np.prod([-(-n // 4) for n in SHAPE])
    assert memory[1]["cache_values"] * 256 == memory[0]["cache_values"] * 272


def test_all_of_it_hidden():
    """Shows nothing, and is no error."""
    image = progiso.compress(make_image(np.full(SHAPE, np.nan, np.float32)), rate=8, mask_nan=True)
    assert progiso.describe(image)["range"] == [0, 0]
    assert not np.isfinite(Scene(image, 0, Camera((14, 14, 90), (14, 14, 12)), SIZE).depth()).any()
    assert np.isnan(samples_of(progiso.decompress(image))).all()


# --- compression -------------------------------------------------------------------------------------------------------------


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    shape=st.tuples(*[st.integers(2, 19)] * 3),
    start=st.tuples(*[st.integers(-5, 5)] * 3),
    share=st.sampled_from([0, 0.02, 0.5, 0.98, 1]),
    rate=st.sampled_from([2, 9, 32]),
    cells=st.booleans(),
    seed=st.integers(0, 99),
)
def test_round_trip(shape, start, share, rate, cells, seed):
    """What was hidden is NaN and marked, hidden cells are marked, and the rest is as close as ever."""
    samples = speckles(shape, share, seed)
    image = make_image(
        np.where(samples, np.nan, noise(shape, seed)), cells=cells, extent_start=start
    )
    others = None if cells else speckles(fewer(shape), share, seed + 1)
    volume = progiso.compress(blank(image, cells=others), rate=rate, mask_nan=True)
    back = progiso.decompress(volume)
    values = samples_of(back)
    assert np.array_equal(np.isnan(values), samples)
    seen = ~samples
    assert same_bits(values[seen], reference_values(volume)[seen])
    check_flags(
        back.GetCellData() if cells else back.GetPointData(),
        samples,
        HIDDEN_CELL if cells else HIDDEN_POINT,
    )
    if not cells:
        check_flags(back.GetCellData(), others, HIDDEN_CELL)
    again = progiso.compress(back, rate=rate)
    for name in ("HiddenSamples", "HiddenCells"):
        runs = [v.GetFieldData().GetArray("ProgIso.ZFP." + name) for v in (volume, again)]
        assert (runs[0] is None) == (runs[1] is None)
        assert runs[0] is None or np.array_equal(vtk_to_numpy(runs[0]), vtk_to_numpy(runs[1]))


def check_flags(data, hidden, flag):
    flags = data.GetArray(vtkDataSetAttributes.GhostArrayName())
    assert (flags is not None) == hidden.any()
    if flags:
        assert np.array_equal(vtk_to_numpy(flags).reshape(hidden.shape), np.where(hidden, flag, 0))


def test_the_version_tells():
    """A reader from before there were masks refuses a volume that has one, and takes all others."""
    assert metadata(progiso.compress(make_image(noise(SHAPE))), "Version")[0] == 1
    assert metadata(nan_samples()[0], "Version")[0] == 2


def test_hidden_values_cost_nothing():
    """Where NaN, huge values and zeros are hidden the rest is kept alike, and about as well as without a hole."""
    values, hidden = blobs(SHAPE, 3), ball(SHAPE, 9)
    errors = []
    for filling in (np.nan, 1e30, 0):
        image = blank(make_image(np.where(hidden, np.float32(filling), values)), hidden)
        volume = progiso.compress(image, rate=6)
        errors.append(np.abs(samples_of(progiso.decompress(volume)) - values)[~hidden].max())
        assert progiso.describe(volume)["range"] == [values[~hidden].min(), values[~hidden].max()]
    whole = samples_of(progiso.decompress(progiso.compress(make_image(values), rate=6)))
    assert errors[0] == errors[1] == errors[2] <= 3 * np.abs(whole - values).max()


def test_slabs_and_files_hide_alike(tmp_path):
    hidden = ball(SHAPE, 9)
    values = np.where(hidden, np.float32(np.inf), blobs(SHAPE, 3))
    whole = progiso.compress(make_image(values), rate=5, mask_nan=True)
    values.tofile(tmp_path / f"hole_{SHAPE[2]}x{SHAPE[1]}x{SHAPE[0]}_float32.raw")
    slabs = progiso.compress_slabs(iter(values), SHAPE[::-1], rate=5, mask_nan=True)
    file = progiso.compress_file(next(tmp_path.iterdir()), rate=5, mask_nan=True)
    for volume in (slabs, file):
        assert stream_of(volume) == stream_of(whole)
        assert np.array_equal(metadata(volume, "HiddenSamples"), metadata(whole, "HiddenSamples"))
    with pytest.raises(RuntimeError, match="infinite"):
        progiso.compress_slabs(iter(values), SHAPE[::-1], rate=5)


def test_a_piece_takes_its_part_of_the_mask():
    volume, _ = all_together()
    read = vtkCompressedVolume()
    assert read.Read(volume)
    own = (9, 20, 5, 13, 11, 25)
    read.Crop(own)
    piece, extent = vtkImageData(), read.GetExtent()
    piece.SetExtent(extent)
    read.Write(piece)
    inside = tuple(slice(extent[2 * axis], extent[2 * axis + 1] + 1) for axis in (2, 1, 0))
    part, whole = progiso.decompress(piece), progiso.decompress(volume)
    assert np.array_equal(samples_of(part), samples_of(whole)[inside], equal_nan=True)
    flags = [
        vtk_to_numpy(i.GetCellData().GetArray("vtkGhostType")).reshape(
            np.array(i.GetDimensions()[::-1]) - 1
        )
        for i in (part, whole)
    ]
    assert np.array_equal(flags[0], flags[1][tuple(slice(s.start, s.stop - 1) for s in inside)])


def test_files(tmp_path):
    """A .vti carries the mask; a .zfp cannot, and says so."""
    volume, _ = all_together()
    writer, reader = vtkXMLImageDataWriter(), vtkXMLImageDataReader()
    writer.SetFileName(str(tmp_path / "hole.vti"))
    writer.SetInputData(volume)
    writer.Write()
    reader.SetFileName(str(tmp_path / "hole.vti"))
    reader.Update()
    assert np.array_equal(
        samples_of(progiso.decompress(reader.GetOutput())),
        samples_of(progiso.decompress(volume)),
        equal_nan=True,
    )
    with pytest.raises((RuntimeError, OSError), match="hidden"):
        progiso.save(volume, tmp_path / "hole.zfp")
    assert not (tmp_path / "hole.zfp").exists()


def spoiled(runs, kind=np.uint64, components=2):
    array = numpy_to_vtk(np.array(runs, kind).reshape(-1, components), deep=True)
    array.SetName("ProgIso.ZFP.HiddenSamples")
    return array


@pytest.mark.parametrize(
    "array",
    [
        spoiled([4, 1]),
        spoiled([0, 1, 5, 0, 5, 1]),
        spoiled([0, 1, 5, 0, 3, 1]),
        spoiled([0, 1, 512, 7]),
        spoiled([0, 1, 2**63, 7]),
        spoiled([0, 1, 0, 1], components=1),
        spoiled([0, 1], np.int64),
        spoiled([0, 1], np.uint32),
        spoiled([0, 1], np.float64),
    ],
)
def test_a_mask_that_is_none(array):
    volume = progiso.compress(make_image(noise((32, 32, 32))))
    volume.GetFieldData().AddArray(array)
    with pytest.raises(RuntimeError, match="HiddenSamples"):
        progiso.decompress(volume)


def test_cells_of_cell_data_are_samples():
    volume = progiso.compress(make_image(noise((9, 9, 9)), cells=True))
    array = spoiled([0, 1])
    array.SetName("ProgIso.ZFP.HiddenCells")
    volume.GetFieldData().AddArray(array)
    with pytest.raises(RuntimeError, match="HiddenCells"):
        progiso.decompress(volume)


# --- triangles ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", KINDS)
def test_triangles_are_those_of_visible_cells(make):
    """Of the surface without holes those triangles are left that lie in visible cells, with no point too many."""
    image, hidden = make()
    holes = progiso.contour(image, ISOVALUE, gradients=True)
    bare = vtkImageData()
    bare.ShallowCopy(image)
    for name in ("HiddenSamples", "HiddenCells"):
        bare.GetFieldData().RemoveArray("ProgIso.ZFP." + name)
    everything = corners_of(progiso.contour(bare, ISOVALUE))
    centres = everything.mean(axis=1) - 0.5 * (progiso.describe(image)["association"] == "cell")
    x, y, z = np.clip(np.floor(centres).astype(int), 0, np.array(hidden.shape[::-1]) - 1).T
    seen = everything[~hidden[z, y, x]]
    assert 0.1 * len(everything) < len(seen) < 0.99 * len(everything)
    assert np.array_equal(in_order(corners_of(holes)), in_order(seen))
    used = np.unique(vtk_to_numpy(holes.GetPolys().GetConnectivityArray()))
    assert np.array_equal(used, np.arange(holes.GetNumberOfPoints()))


def corners_of(surface):
    """The triangles' corners [triangle, corner, axis]."""
    points = vtk_to_numpy(surface.GetPoints().GetData())
    return points[vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)]


def in_order(triangles):
    flat = triangles.reshape(len(triangles), -1)
    return flat[np.lexsort(flat.T)]


def test_gradients_at_the_border_of_a_hole():
    z, y, x = np.meshgrid(*[np.arange(n, dtype=np.float32) for n in SHAPE], indexing="ij")
    image = progiso.compress(blank(make_image(z + 0.4 * y + 0.3 * x), speckles(SHAPE)), rate=32)
    surface = progiso.contour(image, 20.3, gradients=True)
    gradients = vtk_to_numpy(surface.GetPointData().GetArray("Gradients"))
    assert len(gradients) > 100
    assert np.abs(gradients - [0.3, 0.4, 1]).max() < 1e-4


def test_a_plain_image_hides_no_nan_from_the_contour():
    with pytest.raises(ValueError, match="rate"):
        progiso.contour(make_image(noise((8, 8, 8))), 0, mask_nan=True)


# --- at home -----------------------------------------------------------------------------------------------------------------


def test_ghosts_in_pyvista():
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.wrap(make_image(blobs(SHAPE, 3)))
    grid.point_data["vtkGhostType"] = np.where(ball(SHAPE, 12).ravel(), HIDDEN_POINT, 0).astype(
        np.uint8
    )
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    prop = plotter.progiso.add_isosurface(grid, ISOVALUE, rate=12)
    plotter.screenshot()
    expected, hidden = hidden_points()
    scene = Scene(expected, ISOVALUE, Camera.from_vtk(plotter.camera), SIZE)
    assert np.isfinite(progiso.depth(prop.GetMapper())).any()
    assert np.array_equal(np.isfinite(progiso.depth(prop.GetMapper())), np.isfinite(scene.depth()))


@pytest.mark.parametrize("cells", [False, True])
def test_the_default_array_is_no_ghost_array(cells):
    """Where no scalars are active the first array counts, in the filter and in the mapper."""
    image = make_image(noise((9, 9, 9)), cells=cells)
    data = image.GetCellData() if cells else image.GetPointData()
    values = data.GetScalars()
    data.RemoveArray("field")
    blank(image, cells=speckles((9, 9, 9))) if cells else blank(image, points=speckles((9, 9, 9)))
    data.AddArray(values)
    assert data.GetArrayName(0) == "vtkGhostType" and data.GetScalars() is None
    assert progiso.describe(progiso.compress(image))["array"] == "field"
    depth = Scene(image, 0.0, Camera((4, 4, 30), (4, 4, 4)), SIZE).depth()
    assert np.array_equal(
        depth, Scene(progiso.compress(image), 0.0, Camera((4, 4, 30), (4, 4, 4)), SIZE).depth()
    )
    assert np.isfinite(depth).any()
