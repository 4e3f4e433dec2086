"""Laws of a tone-mapping operator and the error of a response curve, for checks of a student's function."""

import warnings

import numpy as np

from hdrlab.capture.responses import Response, bisect, film


def scene(shape=(96, 128), seed=0):
    """Return a luminance of about five decades: soft light, a bright window, fine texture."""
    rng = np.random.default_rng(seed)
    y, x = np.indices(shape) / max(shape)
    light = 4 * np.exp(-8 * ((x - 0.6) ** 2 + (y - 0.3) ** 2)) + 3 * (x > 0.8) - 2 * (y > 0.5)
    return np.exp(1.5 * light + 0.3 * rng.standard_normal(shape)).astype(np.float32)


def hot_pixel(L, value=1e12):
    """Return L with one hot pixel."""
    L = L.copy()
    L[L.shape[0] // 2, L.shape[1] // 3] = value
    return L


RADIANCES = {
    "a scene": scene(),
    "a scene with zeros": np.where(np.arange(128) % 3 == 0, 0, scene()),
    "all zeros": np.zeros((16, 20)),
    "one lamp in the dark": hot_pixel(np.zeros((16, 20)), 3.0),
    "1e-12": np.full((16, 20), 1e-12),
    "1e12": np.full((16, 20), 1e12),
    "1e-12 next to 1e12": np.where(np.arange(20) < 10, 1e-12, 1e12) * np.ones((16, 1)),
    "the range of float32": np.geomspace(1e-45, 3e38, 320).reshape(16, 20),
    "one hot pixel": hot_pixel(scene()),
    "a constant": np.full((33, 17), 3.7),
    "1 x 1": np.full((1, 1), 5.0),
    "2 x 3": np.array([[0.0, 1.0, 2.0], [3.0, 400.0, 5e5]]),
    "one row": scene((1, 200)),
    "integers": np.arange(320).reshape(16, 20),
    "float64": scene().astype(np.float64),
}


def stays_in_range(tonemap):
    """Display luminance is finite, float32, of L's shape, and within 0 and 1, whatever the scene."""
    for name, L in RADIANCES.items():
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            Ld = tonemap(L)
        assert Ld.shape == L.shape and Ld.dtype == np.float32, name
        assert np.all((Ld >= 0) & (Ld <= 1)), (
            f"{name}: {np.count_nonzero(~((Ld >= 0) & (Ld <= 1)))} values outside 0 ... 1"
        )


def answers_the_same_twice(tonemap):
    """Nothing is left behind that changes the next answer."""
    assert np.array_equal(tonemap(scene()), tonemap(scene()))


def takes_any_memory_layout(tonemap):
    """Columns first, every second column, or the other order of bytes: the answer is the same."""
    wide = np.zeros((96, 256), np.float32)
    wide[:, ::2] = scene()
    for L in (np.asfortranarray(scene()), wide[:, ::2], scene().astype(">f4")):
        assert np.allclose(tonemap(L), tonemap(scene()), atol=1e-6)


def shows_the_scene(tonemap):
    """Half the pixels are neither black nor white, and regions that differ in light differ in the picture."""
    L = scene()
    Ld = np.clip(tonemap(L), 0, 1)
    assert np.mean((Ld > 0.01) & (Ld < 0.99)) >= 0.5, (
        "more than half of the image is black or white"
    )
    means = [A.reshape(6, 16, 8, 16).mean(axis=(1, 3)).ravel() for A in (np.log(L), Ld)]
    assert np.ptp(means[1]) > 0.05, "all regions of the image are equally bright"
    ranks = [np.argsort(np.argsort(m)) for m in means]
    assert abs(np.corrcoef(ranks[0], ranks[1])[0, 1]) > 0.5, (
        "bright and dark regions of the image do not match those of the scene"
    )


def keeps_the_light_the_right_way_up(tonemap):
    """Brighter regions come out brighter: the ranks of coarse averages hardly change."""
    L = scene()
    means = [A.reshape(6, 16, 8, 16).mean(axis=(1, 3)).ravel() for A in (np.log(L), tonemap(L))]
    ranks = [np.argsort(np.argsort(m)) for m in means]
    assert np.corrcoef(ranks[0], ranks[1])[0, 1] > 0.5


def exposure(tonemap):
    """The unit of L cancels: a power of two to the last bits, any other factor to a twentieth of a level."""
    for L, Ld in [(L, tonemap(L)) for L in (scene(), RADIANCES["a scene with zeros"])]:
        for factor, atol in ((2.0**-20, 1e-5), (2.0**20, 1e-5), (3.7e-6, 2e-4), (5.1e7, 2e-4)):
            assert np.allclose(tonemap(L * np.float32(factor)), Ld, atol=atol), factor


def drawn_response(rng):
    """Return the response of a camera that nobody has seen, of a gamma and a film curve, mixed.

    f(X) = (1 - s) X^(1 / gamma) + s film(X; a, t), with gamma, shoulder a, toe t and share s drawn.
    """
    gamma, a, toe, s = rng.uniform((1.4, 0.5, 1.05, 0.2), (2.4, 1.2, 1.4, 0.42))

    def f(X):
        return (1 - s) * X ** (1 / gamma) + s * film(X, a=a, gamma=toe)

    return Response(f, bisect(f))


def curve_error(g, truth):
    """Return the RMSE of f^-1 over levels 10 to 250 of 256, its unit fitted, per its largest value."""
    at = np.arange(10, 251) * (len(g) - 1) // 255
    X = np.exp(g[at])
    true = np.exp(truth[at])
    return np.sqrt(np.mean((X * (X @ true) / (X @ X) - true) ** 2)) / true.max()
