"""The procedural scenes: a room that can be rendered at any size and that obeys the laws of light."""

import inspect
import socket

import numpy as np
import pytest
from numpy.linalg import norm

from hdrlab import scenes
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError
from hdrlab.scenes import subjects as embedded
from scenes.computed import illumination, interior, subjects, textures, view
from scenes.computed.__main__ import SAMPLES

pytestmark = pytest.mark.scenes


@pytest.fixture(scope="module")
def room():
    return view.room((128, 192))


# The room


def test_the_room_spans_more_than_five_decades(room):
    assert scenes.decades(room) > 5
    assert scenes.decades(room, tail=0) > scenes.decades(room)


def test_the_default_room_spans_more_than_five_decades_between_its_thousandths():
    default = inspect.signature(view.room).parameters["shape"].default
    E = view.room(default)
    assert E.shape == (*default, 3) and scenes.decades(E) > 5.2


@pytest.mark.parametrize("shape", [(1, 1), (7, 50), (50, 7), (33, 33)])
def test_the_room_is_finite_and_positive_at_any_shape(shape):
    for samples in (1, 2):  # one sample in an odd frame looks straight ahead
        E = view.room(shape, samples=samples)
        assert E.shape == (*shape, 3) and E.dtype == np.float32
        assert np.isfinite(E).all() and E.min() > 0


def test_the_same_room_is_rendered_every_time(room):
    assert np.array_equal(room, view.room((128, 192)))


def test_the_room_does_not_depend_on_the_bands_it_is_rendered_in(room, monkeypatch):
    monkeypatch.setattr(view, "SIGHTS_PER_BAND", 192 * 4 * 3)
    assert np.allclose(view.room((128, 192)), room, rtol=1e-5)


def test_a_larger_frame_shows_the_same_room_in_more_detail(room):
    E = view.room((256, 384)).reshape(128, 2, 192, 2, 3).mean(axis=(1, 3))
    ratio = np.log2(luminance(E) / luminance(room))
    assert abs(np.median(ratio)) < 0.01 and np.quantile(abs(ratio), 0.9) < 0.25


def test_edges_are_smooth_and_surfaces_are_not():
    crude = luminance(view.room((128, 192), samples=1))
    fine = luminance(view.room((128, 192), samples=4))
    smooth = luminance(view.room((128, 192)))
    assert norm(np.log(smooth / fine)) < 0.6 * norm(np.log(crude / fine))
    floor = np.log(smooth[100:, 130:])
    assert abs(np.diff(floor, axis=1)).mean() > 0.05


def test_the_sun_is_the_brightest_spot_and_the_unlit_room_the_darkest(room):
    L = luminance(room)
    y, x = np.unravel_index(L.argmax(), L.shape)
    row, column = np.unravel_index(L.argmin(), L.shape)
    assert 25 < y < 45 and 110 < x < 130  # in the upper right pane
    assert 35 < row < 90 and 40 < column < 62  # through the door


def test_without_the_sun_the_floor_is_dim_and_without_the_lamp_its_corner(room):
    overcast = view.room((128, 192), sun=0)
    unlit = view.room((128, 192), lamp=0)
    L = luminance(room)
    dim = luminance(overcast)
    dark = luminance(unlit)
    assert (L / dim)[95:110, 90:105].mean() > 3 > 1.05 > (L / dim)[50:80, 5:25].mean()
    assert (L / dark)[20:40, 165:180].mean() > 2
    assert overcast.min() > 0 and np.all(L >= 0.999 * dim) and np.all(L >= 0.999 * dark)


def test_light_adds_up():
    lights = [
        view.room((40, 60), sun=s, lamp=m).astype(float)
        for s, m in ((0, 0), (9, 0), (0, 4), (9, 4))
    ]
    assert np.allclose(
        lights[3] - lights[0], lights[1] - lights[0] + lights[2] - lights[0], rtol=1e-3, atol=1e-3
    )


@pytest.mark.parametrize("name", subjects.SUBJECTS)
def test_the_stored_subjects_equal_the_computed_ones(name):
    computed = embedded.SUBJECTS[name]()
    made = subjects.SUBJECTS[name]()
    assert np.allclose(computed.E, made[..., :3], rtol=1e-3)  # half floats hold 11 bits
    assert np.mean(computed.mask != (made[..., 3] > 0.99)) < 1e-3


def test_the_stored_room_equals_the_computed_one():
    stored = scenes.room()
    computed = view.room(stored.shape[:2], samples=SAMPLES)
    assert np.allclose(stored, computed, rtol=2e-3)


def test_nothing_is_downloaded(monkeypatch):
    def refuse(*_):
        raise OSError("no network in this test")

    monkeypatch.setattr(socket, "socket", refuse)
    textures.texture.cache_clear()
    assert view.room((20, 30)).min() > 0


@pytest.mark.parametrize(
    "knobs",
    [
        dict(shape=(0, 9)),
        dict(shape=(9,)),
        dict(samples=0),
        dict(sun=-1),
        dict(lamp=np.nan),
        dict(sun=np.inf),
    ],
)
def test_invalid_room_parameters_raise_an_error(knobs):
    with pytest.raises(ValueError, match="expected"):
        view.room(**{"shape": (8, 8), **knobs})


# Its range


def test_decades_count_powers_of_ten():
    assert np.isclose(scenes.decades(np.geomspace(1e-3, 1e4, 50)[None], tail=0), 7)


def test_decades_ignore_black_and_outlying_pixels():
    E = np.geomspace(1, 100, 10_000).reshape(100, 100)
    E[0, :3] = 0
    E[0, 3] = 1e9
    assert np.isclose(scenes.decades(E), 2, atol=0.02)


@pytest.mark.parametrize(
    ("E", "tail"), [([[0.0]], 0), ([[1.0]], 0.5), ([[1.0]], -0.1), ([[-1.0]], 0)]
)
def test_decades_raise_an_error_for_images_without_a_range(E, tail):
    with pytest.raises(InputError):
        scenes.decades(E, tail=tail)


# Its light, its surfaces


def integrate(point, n, window, steps=400):
    """Return F of a bright rectangle by summing over small squares."""
    (x0, y0, z), (x1, y1, _) = window
    x, y = np.meshgrid(
        *(
            low + (high - low) * (np.arange(steps) + 0.5) / steps
            for low, high in ((x0, x1), (y0, y1))
        )
    )
    v = np.stack([x, y, np.full_like(x, z)]) - np.reshape(point, (3, 1, 1))
    squared = (v**2).sum(axis=0)
    return (np.tensordot(n, v, 1) * abs(v[2]) / squared**2).mean() * (x1 - x0) * (y1 - y0) / np.pi


@pytest.mark.parametrize(
    ("point", "face", "n"),
    [
        ((0.3, 0.0, 2.0), interior.FLOOR, (0, 1, 0)),
        ((-2.5, 1.0, 3.0), interior.LEFT, (1, 0, 0)),
        ((2.5, 2.0, 1.0), interior.RIGHT, (-1, 0, 0)),
        ((0.0, 2.9, 3.5), interior.CEILING, (0, -1, 0)),
    ],
)
def test_the_light_of_a_window_is_the_sum_over_its_parts(point, face, n):
    P = np.float32(point)[:, None]
    assert np.isclose(
        illumination.from_window(P, face, interior.WINDOW)[0],
        integrate(point, n, interior.WINDOW),
        rtol=1e-3,
    )


def test_a_window_gives_no_light_to_its_own_wall():
    P = np.float32([[-2, 2], [1, 1], [4.6, 4.6]])
    assert np.allclose(illumination.from_window(P, interior.BACK, interior.WINDOW), 0, atol=1e-3)


def test_the_light_of_a_globe_falls_with_the_square_of_its_distance():
    P = np.float32([[0, 0], [0, 0], [0, 0]])
    near = illumination.from_globe(P, interior.FLOOR, textures.rgb(0, 1, 0), 0.1)[0]
    far = illumination.from_globe(P, interior.FLOOR, textures.rgb(0, 2, 0), 0.1)[0]
    assert np.isclose(near, 0.01) and np.isclose(far, 0.0025)
    # it is behind that surface
    assert illumination.from_globe(P, interior.CEILING, textures.rgb(0, 1, 0), 0.1)[0] == 0


def test_a_line_of_sight_leaves_a_box_where_it_should():
    d = np.float32([[0, 0, 3], [0, -1, 0], [1, 1, 1]])
    t, face = interior.leave(
        np.zeros((3, 1), np.float32), d, illumination.Box((-1, -2, -1), (1, 2, 4))
    )
    assert np.allclose(t, [4, 2, 1 / 3])
    assert face.tolist() == [
        interior.BACK,
        interior.FLOOR,
        interior.RIGHT,
    ]


@pytest.mark.parametrize("name", ["astronaut", "brick", "chelsea", "coffee", "grass", "gravel"])
def test_a_texture_has_reflectances_below_1_and_its_mip_levels_the_same_mean(name):
    levels = textures.texture(name)
    assert levels[0].min() > 0 and levels[0].max() < 1 and levels[-1].shape[:2] == (1, 1)
    assert np.allclose(levels[4].mean(axis=(0, 1)), levels[0].mean(axis=(0, 1)), rtol=0.05)


def test_a_distant_texture_shows_its_mean():
    u = np.linspace(0, 5, 100, dtype=np.float32)
    rho = textures.look_up("coffee", u, u, np.full(100, 8, np.float32))
    assert rho.shape == (3, 100) and np.ptp(rho, axis=1).max() < 1e-6


def test_a_near_texture_shows_its_pixels():
    rho = textures.texture("gravel")[0]
    row = np.array([5, 100, 300])
    column = np.array([7, 200, 40])
    u = (column + 0.5) / 512
    v = (row + 0.5) / 512
    texture_value = textures.look_up(
        "gravel", np.float32(u), np.float32(v), np.full(3, 1e-5, np.float32)
    )
    assert np.allclose(texture_value[0], rho[row, column, 0], atol=1e-3)


def test_an_edge_covers_half_of_the_pixel_that_it_crosses():
    assert np.allclose(textures.within(np.array([-1, 0, 1]), 0.5), [0, 0.5, 1])
