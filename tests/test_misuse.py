"""Every public function, given unusual input, raises a clear ValueError or is right, and keeps its input.

The tests find public functions automatically: their docstring has a section `Raises`, and their first
argument is a photo or radiance. A test names new functions whose arguments are not in VALUES.
"""

import inspect
import pkgutil
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module

import numpy as np
import pytest
from PIL import Image

from hdrlab.capture import camera
from hdrlab.capture.sensor import Sensor
from hdrlab.errors import InputError

ROOMS = (
    "align",
    "beyond",
    "capture",
    "core",
    "diagnostics",
    "enhance",
    "fast",
    "radiance",
    "response",
)
ROOMS += ("tonemap",)
# other letters: F is an f-number in `exposure`; figures and the parts of a verb have tests of their
# own, and so has what wants more pixels than these
ELSEWHERE = ("capture.exposure.ev", "capture.exposure.irradiance", "capture.movers.shoot")
ELSEWHERE += ("diagnostics.noise.estimate_noise",)
FIRST = {"images", "L", "E", "F", "picture"}
LIGHT = (10.0 ** np.random.default_rng(3).uniform(-1.5, 1.5, (24, 32))).astype(np.float32)
TAKEN = camera.shoot(LIGHT, camera.times_around(LIGHT, 5, stops=1.5), camera.Camera(), rng=1)
VALUES = {
    "images": TAKEN.images,
    "times": TAKEN.times,
    "g": np.log(np.maximum(np.arange(256), 0.5) / 128),
    **dict.fromkeys(("L", "E", "F", "truth"), LIGHT),
    "reference": 1.5 * LIGHT[:, ::-1],
    "luminance_of_unit": 100.0,
    "key": 0.18,
    "Ld": LIGHT / LIGHT.max(),
    "picture": TAKEN.images[2],
    "w": np.ones(256),
    "well": np.ones(LIGHT.shape, bool),
    "time": 0.1,
    "N": 1e4,
    "sensor": Sensor(),
    "centre": (12, 16),
    **{"x": 16, "y": 12, "reading": 5.0},
    "offsets": np.zeros((5, 2), int),
    "homographies": np.stack([np.eye(3)] * 5),
}
# view transforms map colors
COLORS = np.stack([LIGHT, LIGHT[::-1], LIGHT[:, ::-1]], axis=-1)
VALUES_OF_VERBS = {
    "tonemap.agx.tonemap_rgb": {"E": COLORS},
    "tonemap.khronos.tonemap_rgb": {"E": COLORS},
    "tonemap.view_unit.scale_colors": {"E": COLORS},
}
SHARES = {
    "beyond.assorted.shoot": np.tile([[1, 0.25], [0.5, 0.125]], (12, 16)),
    "beyond.splitter.shoot": np.array([0.9, 0.07, 0.01]),
}


def verbs():
    """Return the public verbs by name, and the names of what each must be given."""
    public_verbs = {}
    for room in ROOMS:
        package = import_module(f"hdrlab.{room}")
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            for name, verb in list(vars(import_module(module.name)).items()):
                if (
                    not inspect.isfunction(verb)
                    or verb.__module__ != module.name
                    or name.startswith("_")
                ):
                    continue
                place = f"{module.name[7:]}.{name}"
                known = inspect.signature(verb).parameters.values()
                needed = [
                    parameter.name
                    for parameter in known
                    if parameter.default is parameter.empty
                    and parameter.kind < parameter.VAR_KEYWORD
                ]
                raises = (
                    "\nRaises" in inspect.cleandoc(verb.__doc__ or "")
                    or place == "radiance.merge.merge"
                )
                if raises and {*needed[:1]} <= FIRST and needed and place not in ELSEWHERE:
                    public_verbs[place] = verb, needed
    return public_verbs


VERBS = verbs()


def arguments(verb):
    """Return what a verb is given, of its own: name to value."""
    own = {**VALUES, "e": SHARES.get(verb), **VALUES_OF_VERBS.get(verb, {})}
    return {
        name: np.copy(own[name]) if isinstance(own[name], np.ndarray) else own[name]
        for name in VERBS[verb][1]
    }


def call(verb, arguments_of_call):
    return VERBS[verb][0](**arguments_of_call)


def leaves(answer):
    """Return the arrays and numbers of an answer, in order."""
    if isinstance(answer, tuple | list):
        return [leaf for part in answer for leaf in leaves(part)]
    if isinstance(answer, dict):
        return leaves(list(answer.values()))
    return (
        leaves(list(vars(answer).values())) if hasattr(answer, "__dict__") else [np.asarray(answer)]
    )


def same(a, b):
    a = leaves(a)
    b = leaves(b)
    return len(a) == len(b) and all(
        np.asarray(x).tobytes() == np.asarray(y).tobytes() for x, y in zip(a, b, strict=True)
    )


def some(array, value):
    changed = np.array(array, np.float64)
    changed.flat[1] = value
    return changed


def masked(array):
    hidden = np.zeros(np.shape(array), bool)
    hidden.flat[1] = True
    return np.ma.array(array, mask=hidden)


ANY = {
    "None": lambda a: None,
    "a word": lambda a: "bright",
    "words": lambda a: np.full(a.shape, "bright"),
    "objects": lambda a: np.full(a.shape, None),
    "complex": lambda a: a + 0.5j,
    "masked": masked,
    "nothing": lambda a: np.empty(0),
    "ragged": lambda a: [[1, 2], [3]],
    "one axis more": lambda a: a[None],
}
NOT_FINITE = {"NaN": lambda a: some(a, np.nan), "infinite": lambda a: some(a, np.inf)}
NO_LIGHT = {
    **NOT_FINITE,
    "negative": lambda a: some(a, -1),
    "beyond float32": lambda a: some(a, 1e300),
}
MISTAKES = {
    "images": {
        **ANY,
        "NaN": lambda a: some(a, np.nan),
        "shares": lambda a: a / 255,
        "signed": lambda a: a.astype(np.int16),
        "masked frames": lambda a: [masked(frame) for frame in a],
        "a frame of another size": lambda a: [a[0], a[1][:-1], *a[2:]],
        "a frame that is None": lambda a: [*a[:-1], None],
        "four channels": lambda a: np.stack([a] * 4, axis=-1),
        "no columns": lambda a: a[:, :, :0],
        "one photograph of Pillow in CMYK": lambda a: Image.fromarray(a[0]).convert("CMYK"),
        "Pillow's places in a palette": lambda a: [
            Image.fromarray(frame).convert("P") for frame in a
        ],
    },
    "times": {
        **ANY,
        **NOT_FINITE,
        "negative": lambda a: -a,
        "0": lambda a: 0 * a,
        "one too few": lambda a: a[1:],
    },
    "g": {
        **ANY,
        **NOT_FINITE,
        "falling": lambda a: a[::-1],
        "short": lambda a: a[:17],
        "huge": lambda a: 1e3 * a,
    },
    **dict.fromkeys(
        ("L", "E", "F"), {**ANY, **NO_LIGHT, "four channels": lambda a: np.stack([a] * 4, axis=-1)}
    ),
    "picture": {
        **ANY,
        "shares": lambda a: a / 255,
        "16 bits": lambda a: a.astype(np.uint16),
        "Pillow's places in a palette": lambda a: Image.fromarray(a).convert("P"),
    },
    **dict.fromkeys(("truth", "reference"), {**ANY, **NO_LIGHT, "another size": lambda a: a[:-1]}),
    "Ld": {**ANY, **NOT_FINITE, "another size": lambda a: a[:-1]},
    "well": {**ANY, "another size": lambda a: a[:-1]},
    "w": {**ANY, **NOT_FINITE, "negative": lambda a: -a, "0": lambda a: 0 * a},
    "e": {**ANY, **NOT_FINITE, "negative": lambda a: -a, "0": lambda a: 0 * a},
    "offsets": {
        **ANY,
        "NaN": lambda a: some(a, np.nan),
        "one too few": lambda a: a[1:],
        "a half": lambda a: a + 0.5,
    },
    "homographies": {
        **ANY,
        **NOT_FINITE,
        "one too few": lambda a: a[1:],
        "singular": lambda a: 0 * a,
    },
    "centre": {
        "None": lambda a: None,
        "a number": lambda a: 3,
        "three": lambda a: (*a, 1),
        "NaN": lambda a: (np.nan, 1),
    },
}
# what answers instead: `sanitize` mends light; in float64 1e300 is light; a camera takes any number
# of times
ANSWERED = {
    ("core.gamut.sanitize", "E"): {*NO_LIGHT, "objects"},
    ("tonemap.reinhard.tonemap", "L"): {"beyond float32"},
    ("capture.camera.shoot", "times"): {"one too few"},
}
# a lesson takes for numbers what NumPy does: the real part, what a mask hides, places in a palette;
# the commands run `fast`, or come through `core.bracket`, which do not
LESSONS = (
    "align.cerman.align",
    "align.homography.align",
    "align.mtb.align",
    "radiance.merge.merge",
)
LESSONS += ("response.mitsunaga.recover", "response.robertson.recover")
HIDDEN = ("masked", "masked frames", "Pillow's places in a palette")
ANSWERED |= {
    (lesson, name): {*HIDDEN} | ({"complex"} if name != "images" else set())
    for lesson in LESSONS
    for name in ("images", "times", "g")
    if (lesson, name) != ("response.robertson.recover", "images")
}
ANSWERED["radiance.merge.merge", "images"] -= {"masked"}
# photographs of four pixels a row, and of no pixels: nothing moves
ANSWERED["align.mtb.align", "images"] |= {"one photograph of Pillow in CMYK", "no columns"}
# any arrays can be moved, and light be of any shape
ANSWERED["align.shift.shift", "images"] = {*MISTAKES["images"]} - {
    "None",
    "a word",
    "nothing",
    "ragged",
}
ANSWERED["capture.ranges.expose_levels", "L"] = {"complex", "masked", "nothing", "one axis more"}
ANSWERED["capture.ranges.expose_levels", "L"] |= {"beyond float32", "four channels"}
ANSWERED["diagnostics.motion.measure_motion", "w"] = {"None"}
ANSWERED |= {
    (f"beyond.{module}.shoot", "e"): {"complex", "masked"} for module in ("assorted", "splitter")
}
ANSWERED["core.metrics.radiance_errors", "well"] = {"masked"}
ANSWERED["align.shift.shift", "offsets"] = {"masked"}
ANSWERED["align.resample.photographs", "homographies"] = {"masked"}
GATED = [(verb, name) for verb, (_, needed) in VERBS.items() for name in needed if name in MISTAKES]


SLOW = ("beyond.patches.synthesise", "response.debevec.recover", "response.marginal.recover")


def test_every_public_verb_is_given_what_it_needs():
    known = {*VALUES, "e"}
    assert len(VERBS) > 45 and not {
        name: needed for name, (_, needed) in VERBS.items() if {*needed} - known
    }


@pytest.mark.parametrize(("verb", "name"), GATED)
@pytest.mark.filterwarnings("ignore")
def test_invalid_values_are_refused_with_a_message(verb, name):
    for mistake, make in MISTAKES[name].items():
        if mistake in ANSWERED.get((verb, name), ()):
            continue
        arguments_of_call = arguments(verb)
        arguments_of_call[name] = make(arguments_of_call[name])
        try:
            call(verb, arguments_of_call)
        except ValueError as error:
            numpy_says_it = str(error).startswith(("could not convert", "setting an array"))
            assert isinstance(error, InputError) or numpy_says_it, mistake
        else:
            pytest.fail(f"{verb} answered to {name} that are {mistake}")


class OnlyArray:
    """What is no NumPy array, no sequence and no picture, and can be made an array."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return np.array(self.array, dtype=dtype)


def is_number_array(value):
    return isinstance(value, np.ndarray) and value.dtype.kind in "iuf"


FORMS = {
    "Fortran order": np.asfortranarray,
    "the other byte order": lambda a: a.astype(a.dtype.newbyteorder()),
    "rows from the last to the first": lambda a: a[::-1].copy()[::-1],
    "an object with only __array__": OnlyArray,
}
# A lesson shows a loop over frames, and takes a list or an array of them.
NEEDS_ARRAYS = (*LESSONS, "align.shift.shift")


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb not in SLOW])
def test_memory_layout_and_container_type_do_not_change_the_result(verb):
    first = call(verb, arguments(verb))
    for form, change in FORMS.items():
        if form == "an object with only __array__" and verb in NEEDS_ARRAYS:
            continue
        arguments_of_call = {
            name: change(value) if is_number_array(value) else value
            for name, value in arguments(verb).items()
        }
        assert same(first, call(verb, arguments_of_call)), form


BRIGHTEST = np.float32(3e38)
AWKWARD = {
    "one pixel": lambda a: np.full((1, 1), 5, np.float32),
    "one row": lambda a: a[:1],
    "one column": lambda a: a[:, :1],
    "all black": lambda a: 0 * a,
    "minus zero": lambda a: -0.0 * a,
    "all equal": lambda a: np.full_like(a, 7),
    "all near the largest float32": lambda a: np.full_like(a, BRIGHTEST),
    "half near the largest float32": lambda a: np.where(a > np.median(a), BRIGHTEST, a),
    "one bright pixel": lambda a: some(0 * a, 5),
    "denormal numbers": lambda a: np.full_like(a, 1e-42),
    "denormal numbers and others": lambda a: a * np.float32(1e-39),
    "integers": lambda a: np.full(a.shape, 3),
}
# the spread of a glare that cannot be measured, which is documented as infinite
INFINITE = ("radiance.flare.estimate_spread", "radiance.flare.remove_glare")
LIT = [
    verb
    for verb, (_, needed) in VERBS.items()
    if verb.startswith(("fast.", "radiance.", "tonemap.")) and needed[0] in ("L", "E", "F")
]


@pytest.mark.parametrize("verb", LIT)
def test_unusual_radiance_gives_finite_numbers_or_a_clear_error(verb):
    for kind, make in AWKWARD.items():
        arguments_of_call = arguments(verb)
        for name in {"L", "E", "F"} & arguments_of_call.keys():
            arguments_of_call[name] = make(arguments_of_call[name])
        if "picture" in arguments_of_call:
            arguments_of_call["picture"] = np.full(arguments_of_call["L"].shape, 90, np.uint8)
        try:
            answer = call(verb, arguments_of_call)
        except InputError:
            continue
        if verb not in INFINITE:
            assert all(np.all(np.isfinite(leaf)) for leaf in leaves(answer)), kind


AWKWARD_PHOTOS = {
    "one pixel": lambda a: a[:, :1, :1],
    "one row": lambda a: a[:, :1],
    "one column": lambda a: a[:, :, :1],
    "all black": np.zeros_like,
    "all white": lambda a: np.full_like(a, 255),
    "all equal": lambda a: np.full_like(a, 128),
    "one bright pixel": lambda a: np.where(
        np.arange(a[0].size).reshape(a[0].shape) == 5, 255, 0 * a
    ),
    "16 bits": lambda a: a.astype(np.uint16) * 257,
    "16 bits in the other byte order": lambda a: (a.astype(np.uint16) * 257).astype(">u2"),
}
OF_PHOTOS = [
    verb for verb, (_, needed) in VERBS.items() if needed[0] == "images" and verb not in SLOW
]


# a standard deviation is infinite where no photo measures, and so is a contradiction of light that
# other photos clip
INFINITE_OF_PHOTOS = (
    "radiance.deghosting.ghosts.remove_ghosts",
    "radiance.uncertainty.merge_with_deviation",
)


@pytest.mark.parametrize("verb", OF_PHOTOS)
@pytest.mark.filterwarnings("error")
def test_unusual_photos_give_an_answer_without_infinite_numbers_or_a_clear_error(verb):
    for kind, make in AWKWARD_PHOTOS.items():
        arguments_of_call = arguments(verb)
        arguments_of_call["images"] = make(arguments_of_call["images"])
        try:
            answer = call(verb, arguments_of_call)
        except InputError:
            continue
        for leaf in leaves(answer):
            if leaf.dtype.kind in "fc" and verb not in INFINITE_OF_PHOTOS:
                assert not np.any(np.isinf(leaf)), kind


@pytest.mark.parametrize("verb", LIT)
def test_half_floats_give_what_their_values_give(verb):
    arguments_of_call = arguments(verb)
    half = {
        name: value.astype(np.float16)
        for name, value in arguments_of_call.items()
        if name in ("L", "E", "F")
    }
    single = {name: value.astype(np.float32) for name, value in half.items()}
    assert same(call(verb, arguments_of_call | half), call(verb, arguments_of_call | single))


@pytest.mark.parametrize("verb", [verb for verb in VERBS if verb not in SLOW])
def test_inputs_do_not_change_and_their_layout_order_and_threads_do_not_change_the_result(verb):
    arguments_of_call = arguments(verb)
    first = call(verb, arguments_of_call)
    locked = {}
    for name, value in arguments_of_call.items():
        if isinstance(value, np.ndarray):
            wide = np.repeat(value, 2, axis=-1)
            locked[name] = wide[..., ::2]  # every second element of a row: not contiguous
            locked[name].flags.writeable = False
            assert np.array_equal(value, arguments(verb)[name]), name
        else:
            locked[name] = value
    with ThreadPoolExecutor(2) as pool:
        others = list(pool.map(lambda result: call(verb, result), (locked, arguments_of_call)))
    assert all(same(first, other) for other in others)
