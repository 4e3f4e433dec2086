"""What the functions of `capture` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.capture import (
    autoexposure,
    camera,
    exposure,
    hand_motion,
    lens_flare,
    metering,
    movers,
    photon_transfer,
    ranges,
    responses,
    sensor,
)
from hdrlab.core.filters import warp
from hdrlab.core.filters.scatter import GlareSpread

RNG = np.random.default_rng(9)
INF, NAN = np.inf, np.nan
E = RNG.lognormal(0, 1.2, (9, 12, 3)).astype(np.float32)
L = E[..., 1]
B = np.clip(RNG.lognormal(-1.5, 1, (20, 30)), 0, 1).astype(np.float32)
BRIGHT = np.clip(B * 9, 0, 1)
SENSOR = sensor.Sensor()
SMALL = sensor.Sensor(full_well=1000, read_noise=2, gain=0.3, bits=10, black=16)
X = np.array([0.0, 1e-4, 0.01, 0.2, 0.5, 0.99, 1.0])
LIGHT = np.array([0.0, 1e-5, 0.01, 0.5, 0.994, 0.9999, 1, 3])
BALL = movers.ball((9, 12), (4.2, 5), 3)
RED = movers.ball((9, 12), (4, 5), 2.5, (3, 1, 0.5))
STEP = np.arange(7)[:, None, None, None]
PAIRS = np.rint(64 + 45 * STEP + RNG.normal(0, 1, (7, 2, 11, 10)) * np.sqrt(4 + 9 * STEP)).astype(
    int
)
FULL = np.minimum(PAIRS, 290)
TURNS = np.stack([np.eye(3), warp.turn((9, 12), 2, (0.5, 0.7))])
W = metering.average((20, 30))


def shot(model=None, times=(0.1, 1.0), E=E, **named):
    """Return a bracket of a camera."""
    return camera.shoot(E, times, *([] if model is None else [camera.Camera(**model)]), **named)


def moved(E=L, figure=BALL, at=((0, 0), (1, -2)), times=(1, 0.25), model=None, **named):
    """Return photographs of something that moves."""
    return movers.shoot(
        E, figure, at, times, *([] if model is None else [camera.Camera(**model)]), **named
    )


def dial(name):
    """Return a response and its inverse at some places."""
    found = responses.as_response(name)
    return found.f(X), found.inverse(X)


def film(x, **named):
    """Return what film makes of exposure, and the way back."""
    return responses.film(x, **named), responses.film_inverse(x, **named)


def constant(what, *args, **named):
    """Return what one of the sensor's steps that draw numbers answers."""
    return getattr(sensor, what)(*args, **named, rng=np.random.default_rng(4))


shot.__module__, moved.__module__ = "hdrlab.capture.camera", "hdrlab.capture.movers"
dial.__module__ = film.__module__ = "hdrlab.capture.responses"
constant.__module__ = "hdrlab.capture.sensor"
CAMERAS = (
    *({"response": name} for name in ("linear", "gamma", "srgb", "film", "cubic", None)),
    *(
        {"bits": 16},
        {"sensitivity": 0.3},
        {"full_well": 500.0},
        {"full_well": 500.0, "read_noise": 9.0},
    ),
    *(
        {"gray_noise": 3.0},
        {"hot": 0.2},
        {"vignetting": 0.6},
        {"sensor": SMALL},
        {"sensor": SENSOR, "hot": 0.3},
    ),
    *(
        {"sensor": SMALL, "bayer": True},
        {"sensor": SMALL, "white": (2, 1, 1.5)},
        {"bits": 16, "gray_noise": 9.0},
    ),
)
WRONG = (
    *({"bits": 12}, {"sensitivity": 0}, {"sensitivity": INF}, {"full_well": 0}, {"read_noise": -1.0},
        {"gray_noise": -1.0}),
    *({"read_noise": INF, "full_well": 9.0}, {"gray_noise": INF}, {"hot": -0.1}, {"hot": 1.1},
        {"vignetting": -0.1}),
    *({"vignetting": 1.1}, {"read_noise": 1.0}, {"bayer": True}, {"white": (1, 2, 1)}, {"sensor": SMALL,
        "full_well": 9.0}),
    *({"response": "other"},),
)  # fmt: skip
CASES = recorded.named(
    *(of(autoexposure.measure_brightness, E, ev, **k) for ev in (3, 9) for k in ({}, {"aperture": 4.0,
        "iso": 400.0})),
    of(autoexposure.measure_brightness, E * 99, 8, full_well=500, read_noise=5, rng=3),
    *(of(autoexposure.expose, E * 100, *a) for a in ((), ("spot",), ("matrix",), ("average",), ("partial",))),
    *(of(autoexposure.expose_steps, E * 100, **k) for k in ({}, {"at": (0.2, 0.8), "start": 3.0},
        {"target": 0.5, "max_shots": 2})),
    *(of(camera.shake, n, **k) for n, k in ((5, {}), (4, {"radius": 2, "rng": 7}), (1, {"radius": 0}), (0,
        {}), (3, {"radius": -1}))),
    *(of(camera.times_around, E, **k) for k in ({}, {"count": 2, "stops": 1.0}, {"middle": 0.3,
        "sensitivity": 2.0}, {"count": 1})),
    *(of(camera.times_around, E, **{k: v}) for k, v in (("count", 0), ("stops", 0), ("middle", INF),
        ("sensitivity", -1))),
    of(camera.times_around, E * 0),
    of(camera.times_around, [[0, 0.2, 3]]),
    *(of(shot, model) for model in (None, *CAMERAS, *WRONG)),
    *(of(shot, k) for k in ({"full_well": 0.5}, {"hot": 1.0, "vignetting": 1.0}, {"sensor": SMALL,
        "white": (0.5, 1, 2)})),
    *(of(shot, model, E=L) for model in CAMERAS[9:15]),
    *(of(shot, None, t) for t in (0.3, [2, 1, 0.5], [], [0, 1], [1, 1])),
    *(of(shot, None, offsets=o, rng=5) for o in ([[1, 2], [0, 0]], [[1, 2]], [[0.5, 0.2], [0, 0]], TURNS)),
    *(of(exposure.shutter_series, *n) for n in ((), (1,), (3,), (2,))),
    *(of(exposure.seconds, name) for name in ("1/30", " 1/4s ", "2", "0.5s", "1/0", "a", "0", "inf", "-1",
        "1/2/3", "")),
    *(of(exposure.true_time, t) for t in (1 / 30, 1 / 60, 0.3, 15, 1 / 8000, 99.0, 0, INF)),
    *(of(exposure.read_dial, n) for n in (["1/30", "1/60", "x", "1/47", "0.7"], ["2", "1/50s", "1/45"], [])),
    *(of(exposure.ev, F, t, **k) for F, t, k in ((8, 0.01, {}), (2.8, 1, {"S": 400}), (0, 1, {}), (1, 0, {}),
        (1, 1, {"S": 0}))),
    *(of(exposure.stops, a, b) for a, b in ((8, 2), (1, 3), (0, 1), (1, 0), (INF, 1))),
    *(of(exposure.equivalent_time, 0.1, 4, F, **k) for F, k in ((8, {}), (2, {"S": 200, "S_new": 400}), (0,
        {}), (1, {"S": 0}))),
    *(of(exposure.irradiance, *a, **k) for a, k in (((100, 4), {}), ((100, 4), {"angle": 0.3}), ((1, 0),
        {}))),
    *(of(f, np.array([0, 0.5, 3])) for f in (exposure.transmittance, exposure.density)),
    *(of(exposure.saturating_luminance, 0.01, **k) for k in ({}, {"F": 4.0}, {"S": 400.0}, {"S": 0})),
    *(of(hand_motion.views, E, o) for o in ([[0, 0], [2, -1], [1, 3]], [[0.5, 0.2], [0, 0]], TURNS, [[8, 0],
        [0, 0]])),
    *(of(hand_motion.views, E, o) for o in ([[9, 0], [0, 0]], [[0, 12], [0, 0]], [[0, 11], [0, 0]], [], [[1,
        2, 3]], [["a", "b"]])),
    of(hand_motion._tilted, (2, 2), 0.3, 0.2),
    *(of(hand_motion.frame_homographies, TURNS, s) for s in ((9, 12), (30, 20))),
    *(of(hand_motion.shake, 4, (30, 40), **k) for k in ({}, {"radius": 2.0, "degrees": 3.0, "zoom": 0.1,
        "tilt": 0.1, "rng": 3})),
    *(of(hand_motion.shake, 3, (1, 40), **k) for k in ({"tilt": 0.2}, {"zoom": 0.5}, {"tilt": 0.5},
        {"radius": -1}, {"degrees": INF})),
    *(of(hand_motion.shake, n, (1, 40), radius=0) for n in (0, 1)),
    *(of(lens_flare.add_glare, E, *s) for s in ((), (GlareSpread(0.2, 2.0, 2.0),), (GlareSpread(0.0),),
        (GlareSpread(1.0),))),
    *(of(metering.average, s) for s in ((3, 4), (1, 1))),
    *(of(metering.spot, (9, 12), **k) for k in ({}, {"at": (0.2, 0.9)}, {"share": 0.2}, {"share": 1},
        {"share": 0}, {"share": 1.1})),
    *(of(metering.spot, s, at=at) for s in ((3, 4), (0, 4), (3, 4, 5)) for at in ((0, 1), (-0.1, 0), (0,
        1.1))),
    *(of(metering.partial, (9, 12), **k) for k in ({}, {"at": (0.2, 0.9)}, {"share": 0.3})),
    *(of(metering.centre, (9, 12), **k) for k in ({}, {"inside": 0.5, "share": 0.1}, {"at": (0.3, 0.6)},
        {"inside": 1}, {"inside": 0.25})),
    *(of(metering.zones, s) for s in ((20, 30), (3, 4), (1, 1))),
    *(of(metering.matrix, B, **k) for k in ({}, {"at": (0.2, 0.8)}, {"near": 0.4}, {"tolerance": 1.0})),
    of(metering.matrix, B * (B > 0.3)),
    *(of(metering.weights, B, m, at=at) for m in (*metering.MODES, "other") for at in ((0.5, 0.5), (0.3,
        0.7))),
    *(of(metering.reading, B, w) for w in (W, W * 3, W[1:], -W, W * 0, B)),
    *(of(metering.optimum, 10, b, *o) for b, o in ((0.18, ()), (0.5, ()), (0.5, (0.1,)))),
    *(of(metering.predict_reading, BRIGHT, W, s) for s in (-3, 0, 1.5)),
    *(of(metering.correction, b, W, *a, **k) for b in (B, BRIGHT) for a, k in (((), {}), ((0.4,), {}), ((),
        {"most": 0.5}))),
    *(of(movers.ball, (9, 12), (4, 5.5), r, *a, **k) for r, a, k in ((3, (), {}), (2.5, ((1, 2, 3),),
        {"stripes": 0}), (4, (2,), {"stripes": 3}))),
    *(of(movers.ball, (9, 12), c, r, a) for c, r, a in (((4, 5), 0, 1), ((4, 5), INF, 1), ((4, 5, 6), 1, 1),
        ((4, 5), 1, (1, 2)), ((4, 5), 1, 0), ((4, 5), 1, INF))),
    of(movers.ball, (9, 12), (4, 5), 2, stripes=-1),
    of(movers.ball, (9, 12), (4, 5), 0.8),
    *(of(movers.path, n, s) for n, s in ((5, (1.5, -2)), (4, (3, 1)), (1, (1, 1)), (0, (1, 1)), (3, (1,
        INF)), (3, (1, 2, 3)))),
    *(of(movers.shift_layer, L, at) for at in ((0, 0), (2, -3), (-1, 4), (9, 0), (0, -12), (-20, 1))),
    *(of(movers.compose_moment, e, f, (1, -2)) for e, f in ((L, BALL), (E, RED))),
    *(of(moved, **k) for k in ({}, {"E": E, "figure": RED}, {"model": {"response": "linear"}},
        {"offsets": [[1, 2], [0, 0]], "rng": 3})),
    *(of(moved, **k) for k in ({"at": [[0, 0]]}, {"at": [[0.5, 0], [0, 0]]}, {"offsets": [[1, 2], [1, 0]]},
        {"model": {"hot": 0.1}}, {"times": [1]})),
    *(of(moved, **k) for k in ({"figure": RED}, {"E": E}, {"times": 1, "at": [[2, 1]]}, {"offsets": [[0,
        0]]}, {"times": [1, 1]})),
    *(of(movers.as_figure, movers.Figure(L, m), L) for m in (BALL.mask, BALL.mask * 2, -BALL.mask,
        BALL.mask[1:])),
    *(of(photon_transfer.calibrate, z) for z in (PAIRS, FULL, PAIRS[:4], PAIRS[:3], PAIRS[:, :1],
        PAIRS * 1.0, PAIRS[:, :, :10], PAIRS[..., :9], PAIRS[::-1], PAIRS * 0)),
    of(photon_transfer.variance, PAIRS[3]),
    of(photon_transfer.line, np.array([0.0, 10, 20, 50]), np.array([0.05, 3, 5, 14])),
    *(of(ranges.dynamic_range, hi, lo) for hi, lo in ((1000, 1), (8, 2), (1, 1), (1, 2), (1, 0), (INF, 1))),
    *(of(f, s) for f in (ranges.noise_floor, ranges.sensor_range, sensor.full_electrons) for s in (SENSOR,
        SMALL)),
    *(of(ranges.snr, X, s) for s in (SENSOR, SMALL)),
    *(of(ranges.expose_levels, LIGHT, t, s, **k) for t, s, k in ((1, SENSOR, {}), (0.5, SMALL,
        {"sensitivity": 3.0}), (0, SENSOR, {}), (1, SENSOR, {"sensitivity": 0}), (INF, SENSOR, {}), (1,
        SENSOR, {"sensitivity": INF}))),
    *(of(ranges.expose_levels, a, 1, SENSOR) for a in (-LIGHT, LIGHT + INF)),
    *(of(ranges.levels_per_stop, n) for n in (1, 8, 32, 33, 0, 8.5)),
    *(of(dial, name) for name in (*responses.RESPONSES, None, np.sqrt, "other", lambda x: 1 - x,
        lambda x: x * 1.01, lambda x: x - 0.01, lambda x: 0.2 + 0.6 * x, lambda x: np.minimum(2 * x, 1),
        lambda x: 0 * x + 0.5)),
    *(of(film, X, **k) for k in ({}, {"a": 0.3}, {"gamma": 0.8})),
    *(of(responses.true_g, *a) for a in ((), ("gamma",), ("srgb", 65536), (np.sqrt, 16), ("cubic", 7))),
    *(of(sensor.falloff, s, loss) for s in ((5, 4), (1, 3), (2, 1, 3)) for loss in (0, 0.5)),
    *(of(sensor.vignette, e, 0.4) for e in (E, L)),
    of(sensor.filter_bayer, E),
    *(of(sensor.exposure, E, 0.3, **k) for k in ({}, {"sensitivity": 5.0})),
    *(of(constant, "photons", E, full_well=w) for w in (50, 1e4)),
    of(constant, "readout", E * 100, read_noise=3.0),
    *(of(sensor.digitise, np.float32([-500, 0, 2.4, 2.5, 2.6, 1e4, 1e6]), s) for s in (SENSOR, SMALL)),
    *(of(sensor.balance, g) for g in ([1, 2, 3], [1, 2], [0, 1, 2], [1, INF, 2])),
    *(of(constant, "grain", L / 9, gray_noise=g, bits=b) for g, b in ((3.0, 8), (90.0, 16))),
    *(of(sensor.quantise, np.array([-1, 0, 0.4 / 255, 0.5 / 255, 0.6 / 255, 0.3, 1, 2]), bits=b) for b in (8,
        16)),
    of(sensor.quantise, X),
    *(of(constant, "read", E / 3, s) for s in (SENSOR, SMALL)),
    *(of(sensor.raw, e, 0.2, *s, **k) for e, s, k in ((E, (), {}), (L, (SMALL,), {"sensitivity": 2.0,
        "vignetting": 0.5, "rng": 3}), (E, (), {"bayer": True}))),
    *(of(sensor.raw, L, t, **k) for t, k in ((0, {}), (-1, {}), (INF, {}), (1, {"sensitivity": 0}), (1,
        {"vignetting": 1.1}), (1, {"vignetting": -0.1}), (1, {"vignetting": 1}))),
    *(of(sensor.develop, (E * 500).astype(np.uint16), *s, **k) for s, k in (((), {}), ((SMALL,),
        {"white": (2, 1, 3)}), ((), {"bayer": True}), ((), {"white": (1, 0, 1)}), ((), {"white": (1, 2)}),
        ((), {"white": (INF, 1, 1)}))),
    *(of(sensor.develop, (L * 500).astype(np.uint16), *s, **k) for s, k in (((), {}), ((SMALL,),
        {"bayer": True, "white": (2, 1, 3)}))),
    *(of(sensor.develop, z) for z in (E, (E * 0).astype(np.uint16)[:0], np.zeros(4, np.uint16))),
    *(of(sensor.as_sensor, sensor.Sensor(**{k: v})) for k, v in (("bits", 1), ("bits", 16), ("bits", 17),
        ("bits", 0), ("black", 0), ("black", -1), ("black", 4095), ("black", 4094))),
    *(of(sensor.as_sensor, sensor.Sensor(**{k: v})) for k in ("full_well", "gain", "read_noise") for v in (0,
        -1.0, INF, 1.0)),
    of(sensor.as_sensor, sensor.Sensor(bits=1, black=0)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
