"""The packaged scenes: their documented properties, and how they are rendered again."""

import os
import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.io.maps import exr
from hdrlab.io.maps.layers import read_layers
from hdrlab.scenes import places
from scenes import denoise, relay, render, tracer
from scenes.files import write_layers
from scenes.models import openings, shapes, sun, surfaces
from scenes.models.place import Camera, Light, Place

pytestmark = pytest.mark.scenes

DECADES = {"chapel": 5, "workshop": 5, "street": 6}
FILES = {name: places.FOLDER / f"{name}.exr" for name in scenes.PLACES}
for_each_place = pytest.mark.parametrize("name", scenes.PLACES)


# What is shipped


@for_each_place
def test_a_place_is_512_by_768_finite_and_positive(name):
    place = scenes.layers(name)
    assert place.radiance.shape == place.mover.shape == (512, 768, 3)
    assert place.depth.shape == place.mask.shape == (512, 768)
    assert all(layer.dtype == np.float32 and np.isfinite(layer).all() for layer in place)
    assert place.radiance.min() > 0 and place.depth.min() > 0 and place.mover.min() >= 0
    assert place.mask.min() == 0 and place.mask.max() == 1


@for_each_place
def test_a_place_spans_its_decades_but_for_a_thousandth_of_the_darkest_pixels(name):
    L = luminance(getattr(scenes, name)()).astype(np.float64)
    low, high = np.quantile(L, [0.001, 0.9999])
    assert np.log10(high / low) >= DECADES[name]
    assert np.log10(L.max() / L.min()) >= DECADES[name]


def test_the_files_are_half_floats_and_together_under_eight_megabytes():
    assert sum(file.stat().st_size for file in FILES.values()) < 8e6
    assert all(set(exr.read_dtypes(file)) == {"float16"} for file in FILES.values())


@for_each_place
def test_a_reader_of_single_part_exr_files_sees_the_radiance(name):
    assert np.array_equal(exr.read(FILES[name]), scenes.layers(name).radiance)


# At other sizes


@for_each_place
def test_a_smaller_place_has_the_mean_of_the_larger_ones_areas(name):
    whole = scenes.layers(name)
    small = scenes.layers(name, (128, 192))
    for layer, less in zip(whole, small, strict=True):
        mean = (
            layer.reshape(128, 4, 192, 4, -1)
            .mean(axis=(1, 3), dtype=np.float64)
            .reshape(less.shape)
        )
        assert np.allclose(less, mean, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("shape", [(1, 1), (77, 100), (512, 512), (100, 768), (511, 3)])
def test_a_place_at_any_shape_keeps_its_pixels_square(shape):
    E = scenes.street(shape)
    assert E.shape == (*shape, 3) and np.isfinite(E).all() and E.min() > 0
    pixel = min(512 / shape[0], 768 / shape[1])
    top = (512 - pixel * shape[0]) / 2
    left = (768 - pixel * shape[1]) / 2
    inner = scenes.street()[
        int(np.ceil(top)) : int(512 - top), int(np.ceil(left)) : int(768 - left)
    ]
    assert np.isclose(E.mean(dtype=np.float64), inner.mean(dtype=np.float64), rtol=0.05)


@pytest.mark.parametrize("shape", [(0, 5), (513, 768), (5,), (512, 769)])
def test_a_shape_that_a_place_does_not_have_raises_an_error(shape):
    with pytest.raises(ValueError, match="shape"):
        scenes.chapel(shape)


def test_a_place_that_does_not_exist_raises_an_error():
    with pytest.raises(ValueError, match="chapel, workshop, street.*'beach'"):
        scenes.layers("beach")


# The visitor


@for_each_place
def test_a_visitor_outside_the_frame_does_not_change_the_scene(name):
    place = scenes.layers(name, (128, 192))
    assert np.array_equal(scenes.compose(place, (0, 192)), place.radiance)
    assert np.array_equal(scenes.compose(place, (-500, 0)), place.radiance)


@for_each_place
def test_a_visitor_only_changes_the_pixels_that_it_covers(name):
    place = scenes.layers(name, (256, 384))
    changed = ~np.isclose(scenes.compose(place, (3, -20)), place.radiance, rtol=1e-3).all(axis=2)
    assert 0.002 < changed.mean() < 0.2
    moved = np.zeros_like(place.mask)
    moved[3:, :-20] = place.mask[:-3, 20:]
    assert not changed[moved == 0].any()
    inside = moved == 1
    assert inside.any()
    assert np.array_equal(
        scenes.compose(place, (3, -20))[inside], np.roll(place.mover, (3, -20), (0, 1))[inside]
    )


@for_each_place
def test_a_visitor_is_lit_by_the_place(name):
    place = scenes.layers(name)
    body = luminance(place.mover)[place.mask > 0.99]
    assert (
        luminance(place.radiance).min()
        < np.median(body)
        < np.quantile(luminance(place.radiance), 0.99)
    )


@pytest.mark.parametrize("offset", [3, (1, 2, 3), (0.5, 0)])
def test_an_offset_must_be_two_integers(offset):
    with pytest.raises(ValueError, match="offset"):
        scenes.compose(scenes.layers("street", (16, 24)), offset)


@for_each_place
def test_depth_is_small_near_the_camera_and_large_far_away(name):
    z = scenes.layers(name).depth
    assert z[-1].max() < np.median(z) + 5 and 0.3 < z.min() < 5 and z.max() > 10


def test_the_street_is_darkest_in_its_alley():
    L = luminance(scenes.street())
    y, x = np.unravel_index(np.argsort(L, axis=None)[:100], L.shape)
    assert y.min() > 230
    assert y.max() < 400
    assert x.min() > 100
    assert x.max() < 170  # behind the arch on the left
    assert scenes.layers("street").depth[y, x].min() > 10


# Files of layers


def test_layers_survive_a_round_trip_through_a_file(tmp_path):
    rng = np.random.default_rng(1)
    shapes_of = {"a": (9, 14, 3), "b": (9, 14), "c": (9, 14, 4)}
    layers = {name: rng.random(shape).astype(np.float16) for name, shape in shapes_of.items()}
    write_layers(tmp_path / "layers.exr", layers)
    read_back = read_layers(tmp_path / "layers.exr")
    assert list(read_back) == list(layers)
    assert all(np.array_equal(read_back[name], layers[name]) for name in layers)


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ({"a": np.ones((3, 4)), "b": np.ones((4, 3))}, "layers of one size"),
        ({"a": np.ones((3, 4, 2))}, "1, 3 or 4 channels"),
        ({"a": np.full((3, 4), np.nan)}, "in 0 to 65504"),
        ({"a": np.full((3, 4), 1e6)}, "in 0 to 65504"),
        ({"a": np.full((3, 4), -1.0)}, "in 0 to 65504"),
    ],
)
def test_layers_that_a_file_cannot_hold_raise_an_error(tmp_path, layers, message):
    with pytest.raises(ValueError, match=message):
        write_layers(tmp_path / "layers.exr", layers)
    assert not list(tmp_path.iterdir())


def test_a_file_of_layers_that_is_cut_short_raises_an_error(tmp_path):
    whole = FILES["street"].read_bytes()
    for size in (0, 10, 700, len(whole) // 2):
        (tmp_path / "cut.exr").write_bytes(whole[:size])
        with pytest.raises(InputError):
            read_layers(tmp_path / "cut.exr")


# The models


def corners_with_area(mesh):
    """Return the corners of the triangles with an area; those at the tip of an arch have none."""
    a = mesh.vertices[mesh.faces[:, 0]]
    b = mesh.vertices[mesh.faces[:, 1]]
    c = mesh.vertices[mesh.faces[:, 2]]
    return mesh.faces[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 1e-12]


@for_each_place
def test_a_model_is_made_of_triangles_and_materials_that_exist(name):
    place = render.model(name)
    emitting = {material for light in place.lights.values() for material in light.glow}
    for material, mesh in place.parts + place.visitor:
        assert material in place.materials
        assert np.isfinite(mesh.vertices).all() and np.isfinite(mesh.uv).all()
        assert np.allclose(
            np.linalg.norm(mesh.normals, axis=1)[corners_with_area(mesh)], 1, atol=1e-6
        )
        assert mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices)
    assert emitting <= {material for material, _ in place.parts}


def outward(mesh):
    """Return whether the normals of a solid around the origin point away from it."""
    return ((mesh.vertices - mesh.vertices.mean(axis=0)) * mesh.normals).sum(axis=1) > -1e-9


def volume(mesh):
    """Return the volume inside a mesh, positive where its triangles turn outwards."""
    a = mesh.vertices[mesh.faces[:, 0]]
    b = mesh.vertices[mesh.faces[:, 1]]
    c = mesh.vertices[mesh.faces[:, 2]]
    return np.einsum("fk,fk->", a, np.cross(b, c)) / 6


def test_solids_have_their_volume_and_face_outwards():
    block = shapes.box((0, 0, 0), (1, 2, 3), bevel=0.001)
    assert np.isclose(volume(block), 6, rtol=1e-3) and outward(block).all()
    ball = shapes.ball((1, 2, 3), 0.5, sides=64)
    assert np.isclose(volume(ball), np.pi / 6, rtol=0.01) and outward(ball).all()
    drum = shapes.lathe([(0, 1), (0.5, 1), (0.5, 0), (0, 0)], sides=96)
    assert np.isclose(volume(drum), np.pi / 4, rtol=0.01)
    rod = shapes.tube([(0, 0, 0), (0, 0, 1), (0, 0, 2)], 0.1, sides=48)
    assert np.isclose(volume(rod), np.pi * 0.01 * 2 + 4 / 3 * np.pi * 0.001, rtol=0.02)


def test_a_turn_by_ninety_degrees_takes_an_axis_to_the_next():
    assert np.allclose(shapes.turned(90, "y") @ (0, 0, 1), (1, 0, 0))
    assert np.allclose(shapes.turned(90, "z") @ (1, 0, 0), (0, 1, 0))


def area(mesh):
    """Return the area of a mesh that lies in the plane z = 0."""
    a = mesh.vertices[mesh.faces[:, 0]][:, :2]
    b = mesh.vertices[mesh.faces[:, 1]][:, :2]
    c = mesh.vertices[mesh.faces[:, 2]][:, :2]
    return (
        np.abs(np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2]) / 2
    ).sum()


@pytest.mark.parametrize("rise", [0.0, 0.3])
def test_a_wall_and_its_panes_fill_the_rectangle(rise):
    holes = [openings.Opening(x, 1.0, 0.5, 1.5, rise, False) for x in (1.0, 3.0)]
    wall = openings.wall((0, 4), (0, 2.5), holes, 0.2)
    front = wall._replace(
        faces=wall.faces[np.abs(wall.vertices[wall.faces][..., 2]).max(axis=1) < 1e-9]
    )
    assert np.isclose(area(front) + sum(area(openings.pane(hole)) for hole in holes), 10, rtol=1e-3)


def test_the_arcs_of_a_pointed_arch_meet_over_its_middle():
    hole = openings.Opening(2.0, 1.2, 0.0, 3.0, 1.1)
    assert np.isclose(openings.top(hole, np.array([2.0]))[0], 4.1)
    assert np.allclose(openings.top(hole, np.array([1.4, 2.6])), 3.0)


def test_the_slide_of_a_projector_is_upright_and_as_large_as_its_pane():
    T = np.zeros((40, 20, 3))
    T[:20, :10] = 1  # the upper left quarter
    beam = sun.through(T, (0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, -1), (1, 1, 1))
    slide = beam["irradiance"][..., 0] / beam["irradiance"].max()
    lit = slide > 0.5
    half = np.tan(np.radians(beam["fov"]) / 2) * sun.FAR
    assert np.isclose(lit.mean() * (2 * half) ** 2, 0.5, rtol=0.05)
    y, _ = np.nonzero(lit)
    assert y.mean() < slide.shape[0] / 2  # from behind the pane, its upper half is still on top


def test_each_spot_of_sunlight_has_a_texel_to_itself_with_its_radiance():
    rng = np.random.default_rng(3)
    P = rng.random((11, 3))
    E = rng.random((11, 3))
    mesh = relay.squares(P, np.tile([0.0, 0, 1], (11, 1)), np.full(11, 0.1))
    data = relay.chart(E)["data"]
    middle = mesh.uv.reshape(11, 4, 2).mean(axis=1)
    row = ((1 - middle[:, 1]) * len(data)).astype(int)
    column = (middle[:, 0] * len(data)).astype(int)
    assert np.allclose(data[row, column], E)
    assert np.allclose(mesh.vertices.reshape(11, 4, 3).mean(axis=1), P + [0, 0, 0.002])


def test_windows_with_a_common_texture_are_separate_lamps():
    """A single mesh of all would have several places for each texel, and Mitsuba would find only one."""
    place = render.model("street")
    light = place.lights["windows"]
    names = [name for name, _ in tracer.solids(place.parts, light)]
    for name, glow in light.glow.items():
        panes = sum(texture == name for texture, _ in place.parts)
        assert names.count(name) == (1 if isinstance(glow, tuple) else panes)
    assert names.count("road") == 1 and len(names) > 40


# The noise


def noisy(rng):
    """Return a scene of two surfaces under a gradient of light, and two noisy halves of its samples."""
    y, x = np.mgrid[:48, :72] / 48
    rho = np.where(x < 0.7, 0.2, 0.6)[..., None] * np.ones(3)
    E = rho * (1 + 3 * y)[..., None]
    guides = np.dstack([rho, 0 * rho])
    return E, rho, guides, *(E * rng.gamma(4, 1 / 4, E.shape) for _ in range(2))


def test_denoising_removes_most_of_the_noise_and_keeps_the_light():
    E, rho, guides, A, B = noisy(np.random.default_rng(0))
    clean = rho * denoise.denoise(A, B, rho, guides)
    before = np.sqrt(np.mean((((A + B) / 2) / E - 1) ** 2))
    after = np.sqrt(np.mean((clean / E - 1) ** 2))
    assert after < before / 5
    assert abs(np.mean(clean / E) - 1) < 0.03


def test_denoising_does_not_cross_an_edge_between_surfaces():
    E, rho, guides, A, B = noisy(np.random.default_rng(1))
    light = denoise.denoise(
        A * np.where(rho > 0.4, 5, 1), B * np.where(rho > 0.4, 5, 1), rho, guides
    )
    ratio = light[:, 34:] / light[:, :34].mean(axis=1, keepdims=True)
    assert 4 < ratio[:, :8].mean() < 6


def test_fireflies_are_removed():
    A = np.ones((9, 9, 3))
    B = np.ones((9, 9, 3))
    A[4, 4] = 500
    assert denoise.believed(A, B).max() == 2 and np.array_equal(denoise.believed(B, A), B)


def test_upsampling_light_follows_the_edges_of_its_guides():
    x = np.arange(64)
    guides = np.repeat((x >= 33)[None, :, None] * 1.0, 40, axis=0)
    coarse = guides.reshape(20, 2, 32, 2, 1).mean(axis=(1, 3))
    light = np.where(coarse > 0.5, 8.0, 1.0) * np.ones(3)
    fine = denoise.finer(light, coarse, guides)
    assert np.allclose(fine[:, :32], 1, rtol=0.02) and np.allclose(fine[:, 34:], 8, rtol=0.02)


# Made again


def test_the_layer_of_the_visitor_recomposes_the_scene_with_the_visitor():
    y, x = np.mgrid[:60, :90]
    without = (1 + x / 90)[..., None] * np.array([1.0, 2.0, 3.0])
    hidden = np.clip(12.5 - np.hypot(y - 20, x - 40), 0, 1)
    shaded = without * np.where((y > 36) & (y < 56) & (x > 30) & (x < 50), 0.5, 1)[..., None]
    visited = hidden[..., None] * 0.7 + (1 - hidden[..., None]) * shaded
    layer = render.visitor(visited, without, hidden)
    again = layer[..., :3] + (1 - layer[..., 3:]) * without
    assert np.allclose(again[hidden > 0], visited[hidden > 0], rtol=1e-5)
    assert np.allclose(again[41:51, 36:44], visited[41:51, 36:44], rtol=0.1)
    assert np.allclose(again[:, 60:], without[:, 60:], rtol=1e-6)


@pytest.mark.parametrize("height", [50, 16, 0])
def test_a_height_that_cannot_be_halved_twice_raises_an_error(height):
    with pytest.raises(ValueError, match="height"):
        render.rendered("chapel", height=height)


def test_rounds_are_averaged_and_clipped_to_the_range_of_half_floats():
    first = {"radiance": np.float32([[[0, 2, 90_000]]]), "mover": np.zeros((1, 1, 4), np.float32)}
    second = {"radiance": np.float32([[[0, 4, 90_000]]]), "mover": np.ones((1, 1, 4), np.float32)}
    mean = render.mean([first, second])
    assert mean["radiance"].tolist() == [[[render.DIMMEST, 3, exr.LARGEST_HALF]]]
    assert (mean["mover"] == 0.5).all()
    assert all(layer.dtype == np.float32 for layer in mean.values())


def test_averaging_no_rounds_raises_an_error():
    with pytest.raises(ValueError, match="one round.*0"):
        render.rendered("chapel", rounds=0)


mitsuba = pytest.mark.skipif(
    find_spec("mitsuba") is None, reason="renders a place again, which needs Mitsuba 3"
)


@mitsuba
@pytest.mark.parametrize(
    ("name", "corner"), [("chapel", (180, 320)), ("workshop", (240, 440)), ("street", (200, 560))]
)
def test_rendering_again_reproduces_the_shipped_scene(name, corner):
    """A part of the image, with a third of the paths: means of 8 x 8 pixels, because single ones are
    noisy.
    """
    part = tuple(slice(start, start + size) for start, size in zip(corner, (48, 72), strict=True))
    mi = render.mitsuba("scalar_rgb")
    place = render.model(name)
    frame = render.Frame(512, 768, *part)
    E = render.radiance(mi, place, place.parts, frame, 32, 1).astype(np.float32)
    shipped = scenes.layers(name)
    blocks = (
        luminance(L).reshape(6, 8, 9, 8).mean(axis=(1, 3)) for L in (E, shipped.radiance[part])
    )
    stops = np.log2(np.divide(*blocks))
    assert abs(np.median(stops)) < 0.15 and np.quantile(np.abs(stops), 0.8) < 0.5
    assert np.median(np.abs(render.depth(mi, place, frame) / shipped.depth[part] - 1)) < 0.002


@mitsuba
def test_light_from_a_projector_falls_through_its_pane_onto_the_floor():
    """A pane over a floor, the sun over both: a matt floor returns rho E cos / pi."""
    towards = np.array([0.3, 1, 0.2]) / np.linalg.norm([0.3, 1, 0.2])
    beam = sun.through(
        np.ones((8, 8, 3)), (0, 2, 0), (1, 0, 0), (0, 0, -1), towards, (100, 100, 100)
    )
    parts = [("floor", shapes.quad((-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3)))]
    place = Place(
        parts,
        {"floor": surfaces.matt((0.5, 0.5, 0.5))},
        {"sun": Light({}, (beam,))},
        Camera((0, 5, 1), (0, 0, -1), 60),
        [],
    )
    E = render.radiance(render.mitsuba("scalar_rgb"), place, parts, render.Frame(48, 72), 16, 0)[
        ..., 1
    ]
    pixels = E > 50 * 0.5 / np.pi
    assert np.isclose(np.median(E[pixels]), 100 * towards[1] * 0.5 / np.pi, rtol=0.02)
    z = render.depth(render.mitsuba("scalar_rgb"), place, render.Frame(48, 72))
    slant = 5 / np.hypot(5, 2)  # cosine of the floor's normal against the camera's axis
    pixel = 2 * np.tan(np.radians(30)) / 72
    # a pane of one square metre
    assert np.isclose((z[pixels] ** 2 * pixel**2).sum(), slant, rtol=0.15)


def test_without_mitsuba_the_command_says_what_to_install(tmp_path):
    (tmp_path / "mitsuba.py").write_text("raise ImportError('hidden by the test')")
    home = str(Path(scenes.__file__).parents[2])
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), home])}
    command = [sys.executable, "-m", "scenes.render", "chapel", "-o", str(tmp_path / "chapel.exr")]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert ran.returncode == 1 and 'pip install "hdrlab[scenes]"' in ran.stderr
    assert "Traceback" not in ran.stderr and not (tmp_path / "chapel.exr").exists()


def test_each_model_is_named_after_its_place():
    assert all(import_module(f"scenes.models.{name}").place for name in scenes.PLACES)
    with pytest.raises(ValueError, match="beach"):
        render.model("beach")
