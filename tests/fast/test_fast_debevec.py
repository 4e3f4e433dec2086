"""The fast solution of Debevec and Malik's system: the lesson's, on any input, and the curves it finds."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.capture import camera, responses
from hdrlab.core import sampling, weights
from hdrlab.core.arrays import levels
from hdrlab.course.checks.specification import test_gsolve
from hdrlab.errors import InputError
from hdrlab.fast import debevec
from hdrlab.response import debevec as lesson

CUT = weights.cut(weights.hat())
CURVES = sorted(responses.RESPONSES)


def samples(N=40, P=5, seed=0, **knobs):
    """Return Z (N, P) and B (P,) as the specification draws them: frames one and a half stops apart."""
    return test_gsolve.samples(np.random.default_rng(seed), N, P, **knobs)


@pytest.mark.parametrize("w", [weights.hat(), weights.gaussian()], ids=["hat", "gaussian"])
@pytest.mark.parametrize("smoothness", [1, 30, 300])
@pytest.mark.parametrize("seed", [0, 1])
def test_the_fast_solution_equals_the_lesson(seed, smoothness, w):
    Z, B = samples(seed=seed)
    fast = debevec.gsolve(Z, B, smoothness, w)
    slow = lesson.gsolve(Z, B, smoothness, w)
    assert np.allclose(fast.g, slow.g, rtol=0, atol=1e-8)
    assert np.allclose(fast.lE, slow.lE, rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_with_cut_weights_the_fast_solution_equals_the_lesson_and_is_constant_above_the_cut(seed):
    Z, B = samples(seed=seed)
    fast = debevec.gsolve(Z, B, 30, CUT).g
    slow = lesson.gsolve(Z, B, 30, CUT).g
    # the last smoothness row reaches one level beyond the cut
    reached = np.flatnonzero(CUT)[-1] + 1
    assert np.allclose(fast, slow, rtol=0, atol=1e-8)
    assert np.all(fast[reached:] == fast[reached])


@given(
    seed=st.integers(0, 99), smoothness=st.floats(0.1, 1000), P=st.integers(2, 8), cut=st.booleans()
)
def test_the_gauge_holds_exactly(seed, smoothness, P, cut):
    Z, B = samples(P=P, seed=seed)
    assert debevec.gsolve(Z, B, smoothness, CUT if cut else weights.hat()).g[128] == 0


@pytest.mark.parametrize("name", CURVES)
def test_lE_is_where_the_samples_lie_on_the_curve(name):
    Z, B = samples(200, response=responses.RESPONSES[name], noise=0)
    g, lE = debevec.gsolve(Z, B, 1, CUT)
    error = np.where(CUT[Z] > 0.5, g[Z] - lE[:, None] - B, 0)
    assert np.abs(error).max() < 0.03  # half a level in the middle of a curve


def test_a_sample_without_weight_has_lE_0_and_does_not_change_the_others():
    Z, B = samples()
    seen = debevec.gsolve(Z, B, 30, CUT)
    more = debevec.gsolve(np.concatenate([Z, np.full((1, len(B)), 255)]), B, 30, CUT)
    assert more.lE[-1] == 0
    assert np.allclose(more.g, seen.g, atol=1e-12)
    assert np.allclose(more.lE[:-1], seen.lE)


def test_samples_seen_in_one_frame_do_not_change_the_curve():
    Z, B = samples()
    g = debevec.gsolve(Z, B, 30, CUT).g
    alone = np.full((7, len(B)), 255)
    alone[:, 2] = np.arange(20, 160, 20)
    assert np.allclose(debevec.gsolve(np.concatenate([Z, alone]), B, 30, CUT).g, g, atol=1e-9)


# What is refused


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"Z": [[0.5, 1.0]]}, "integer pixel levels"),
        ({"Z": [1, 2]}, r"integer pixel levels Z \(N, P\), got shape \(2,\)"),
        ({"Z": np.empty((0, 2), int)}, r"got shape \(0, 2\)"),
        ({"Z": [[0, 256]]}, "expected pixel levels 0 to 255"),
        ({"Z": [[-1, 6]]}, "expected pixel levels 0 to 255"),
        ({"B": [0, 1, 2]}, r"finite ln times B \(2,\), got shape \(3,\)"),
        ({"B": [0, np.inf]}, "finite ln times"),
        ({"w": -weights.hat()}, "not negative"),
        ({"w": weights.hat() * np.nan}, "finite"),
        ({"smoothness": -1}, "smoothness that is finite and not negative, got -1"),
        ({"smoothness": np.nan}, "smoothness that is finite"),
        ({"Z": [[0, 255]]}, "well exposed in two photos"),
        ({"B": [0, 0]}, "well exposed in two photos"),
    ],
)
def test_invalid_arguments_of_gsolve_raise_an_error(changes, message):
    knobs = {"Z": [[100, 200]], "B": [0.0, 1.0], "smoothness": 10, "w": weights.hat()} | changes
    with pytest.raises(ValueError, match=message):
        debevec.gsolve(**knobs)


STACK = np.tile(np.arange(256, dtype=np.uint8).reshape(16, 16), (2, 1, 1))


@pytest.mark.parametrize(
    ("images", "times", "message"),
    [
        (STACK[:1], [1], "at least 2 different exposure times, got"),
        (STACK, [1, 1], r"at least 2 different exposure times, got \[1.0, 1.0\] s"),
        (STACK, [1, 0], "positive exposure times"),
        (STACK, [1], "expected 2 exposure times"),
        (STACK * 0, [1, 2], "samples that are well exposed in two photos"),
        (STACK * 0 + 255, [1, 2], "samples that are well exposed in two photos"),
        (STACK.astype(float), [1, 2], "uint8 or uint16"),
    ],
    ids=[
        "one frame",
        "equal times",
        "zero time",
        "a time too few",
        "all black",
        "all white",
        "float",
    ],
)
def test_a_bracket_without_usable_samples_raises_an_error(images, times, message):
    with pytest.raises(ValueError, match=message):
        debevec.recover(images, times)


# Photographs of a known camera


def rmse(g, name):
    """Return the root mean square error of f^-1 over levels 10 to 250, in shares of its largest value.

    A curve is known up to the unit of exposure, which is fitted.
    """
    X = np.exp(g[10:251])
    truth = np.exp(responses.true_g(name)[10:251])
    return np.sqrt(np.mean((X * (X @ truth) / (X @ X) - truth) ** 2)) / truth.max()


@pytest.mark.parametrize("choose", [sampling.by_rank, sampling.by_grid])
@pytest.mark.parametrize("name", CURVES)
def test_seven_noisy_frames_give_the_response_to_one_percent(name, choose, seven_frames):
    _, taken = seven_frames(name)
    assert rmse(debevec.recover(taken.images, taken.times, choose=choose), name) < 0.01


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", CURVES)
def test_the_noise_of_a_phone_leaves_the_response_within_one_percent(name, seed, decades):
    E = decades(seed=seed)
    knobs = dict(full_well=5000, read_noise=5, gray_noise=1.0)
    taken = camera.shoot(
        E, camera.times_around(E, 7, stops=2), camera.Camera(response=name, **knobs), rng=seed
    )
    assert rmse(debevec.recover(taken.images, taken.times), name) < 0.01


def test_cut_weights_reproduce_the_noisy_experiment_of_cerman_and_hlavac():
    E = np.geomspace(1 / 4096, 1, 40_000, dtype=np.float32).reshape(200, 200)
    taken = camera.shoot(
        E, 4.0 ** np.arange(6), camera.Camera(response="cubic", gray_noise=1.0), rng=0
    )
    knobs = dict(smoothness=20, samples=200, choose=sampling.by_grid)
    hat = debevec.recover(taken.images, taken.times, w=weights.hat(), **knobs)
    cut = debevec.recover(taken.images, taken.times, **knobs)
    ranks = debevec.recover(taken.images, taken.times, smoothness=20, samples=200)
    assert rmse(cut, "cubic") < 0.01 and rmse(ranks, "cubic") < 0.005
    assert rmse(hat, "cubic") > 2 * rmse(cut, "cubic")


def test_each_channel_is_recovered_independently(decades):
    E = decades((60, 80))
    times = camera.times_around(E, 5, stops=2)
    gray = [
        camera.shoot(E, times, camera.Camera(response=name)).images
        for name in ("film", "gamma", "linear")
    ]
    g = debevec.recover(np.stack(gray, axis=-1), times)
    assert g.shape == (256, 3)
    for c, images in enumerate(gray):
        assert np.allclose(g[:, c], debevec.recover(images, times), atol=1e-12)


def test_the_curve_rises_even_where_noise_would_make_it_fall(decades):
    E = decades((40, 50))
    taken = camera.shoot(
        E, camera.times_around(E, 3, stops=4), camera.Camera(gray_noise=8.0), rng=2
    )
    knobs = dict(samples=30, smoothness=0.5, choose=sampling.by_grid)
    g = debevec.recover(taken.images, taken.times, **knobs)
    assert np.all(np.diff(g) >= 0) and g[128] == 0
    Z = sampling.by_grid(taken.images, 30)
    assert np.any(np.diff(debevec.gsolve(Z, np.log(taken.times), 0.5, CUT).g) < 0)


def test_masked_pixels_do_not_change_the_curve(decades):
    E = decades((60, 80))
    taken = camera.shoot(E, camera.times_around(E, 5, stops=2))
    images = taken.images.copy()
    valid = np.ones(taken.images.shape, bool)
    images[1:3, :, :20] = 90
    valid[1:3, :, :20] = False
    g = debevec.recover(taken.images[:, :, 20:], taken.times)
    assert np.allclose(debevec.recover(images, taken.times, valid=valid), g, atol=1e-12)
    assert np.abs(debevec.recover(images, taken.times) - g)[20:230].max() > 0.1


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_a_curve_has_256_levels_at_any_depth(dtype):
    images = np.stack([np.linspace(1, top, 400).reshape(20, 20) for top in (100, 200)])
    images = (images * (levels(np.zeros(1, dtype)) - 1) / 255).astype(dtype)
    assert debevec.recover(images, [1, 2]).shape == (256,)


def test_an_underdetermined_system_raises_an_error():
    """Two samples connect no levels with each other, and without smoothness nothing else connects them."""
    with pytest.raises(InputError, match="more pixels, photos or smoothness"):
        debevec.gsolve([[100, 200], [10, 20]], [0.0, 1.0], 0, weights.hat())
