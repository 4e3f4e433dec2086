"""Every tone-mapping operator obeys the general laws and those it claims; new ones are tested automatically.

VARIED has other values than the defaults for all parameters of all operators; the laws hold for them,
too.
"""

from functools import partial
from importlib import import_module

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from support import laws

from hdrlab.pipeline import catalogue

OPERATORS = {name: catalogue.method("tonemap", name) for name in catalogue.names("tonemap")}
LESSONS = {name: import_module(f"hdrlab.tonemap.{name}").tonemap for name in OPERATORS}
LESSONS = {name: lesson for name, lesson in LESSONS.items() if lesson is not OPERATORS[name]}
VARIED = {
    "agx": [{"key": 0.02}, {"key": 3.0}],
    "brush": [{"bins": 1}, {"bins": 64, "limit": 1}, {"limit": np.inf}],
    "chiu": [
        {"headroom": 2},
        {"headroom": 64, "passes": 0},
        {"sigma": 3.5},
        {"sigma": 30, "passes": 2},
    ],
    "curves": [
        {"curve": "linear", "cut": 0},
        {"curve": "gamma", "gamma": 0.5},
        {"cut": 0.2, "encoded": False},
    ],
    "drago": [{"bias": 0.5}, {"bias": 0.7}, {"bias": 1}],
    "durand": [
        {"contrast": 1.5, "sigma_s": 8},
        {"contrast": 1e4, "cut": 0},
        {"sigma_s": 40, "sigma_r": 5},
    ],
    "fattal": [
        {"alpha": 0.3, "beta": 0.85},
        {"beta": 1, "noise": 1},
        {"black": 0, "white": 0},
        {"black": 0.1},
    ],
    "khronos": [{"key": 0.02}, {"key": 3.0}],
    "local_laplacian": [
        {"sigma": 0.3, "samples": 2},
        {"alpha": 0.5, "beta": 1},
        {"alpha": 3, "beta": 0.3, "samples": 9},
    ],
    "reinhard": [
        {"key": 0.72, "white": 0.5},
        {"key": "auto", "white": np.inf},
        {"local": True, "phi": 1, "threshold": 0.5},
        {"local": True, "phi": 15, "threshold": 1e-3, "white": 2},
    ],
    "ward": [
        {"white": 1e5, "tolerance": 0.5},
        {"black": 0.5, "white": 0.6},
        {"bins": 1},
        {"bins": 500, "field": 30, "tolerance": 1e-6},
    ],
}
VARIATIONS = [(name, i) for name, varied in VARIED.items() for i in range(len(varied))]
# a neighbourhood of 3 pixels may turn light upside down, but nothing may break these
FOR_ANY_KNOBS = (
    laws.stays_in_range,
    laws.refuses_and_counts_invalid_radiance,
    laws.answers_the_same_twice,
    laws.is_robust_against_a_hot_pixel,
)
CLAIMS = [
    (name, law)
    for name in OPERATORS
    for law in getattr(import_module(f"hdrlab.tonemap.{name}"), "LAWS", ())
]


@pytest.mark.parametrize("law", laws.ALWAYS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("name", OPERATORS)
def test_every_operator(name, law):
    law(OPERATORS[name])


@pytest.mark.parametrize("law", laws.ALWAYS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("name", LESSONS)
def test_every_lesson_that_has_a_fast_operator(name, law):
    # it refuses without a count
    if (name, law) != (
        "reinhard",
        laws.refuses_and_counts_invalid_radiance,
    ):
        law(LESSONS[name])


@pytest.mark.parametrize("law", FOR_ANY_KNOBS, ids=lambda law: law.__name__)
@pytest.mark.parametrize(("name", "i"), VARIATIONS)
def test_every_operator_with_other_parameters(name, i, law):
    law(partial(OPERATORS[name], **VARIED[name][i]))


@pytest.mark.parametrize(
    ("name", "law", "i"),
    [
        (name, law, i)
        for name, law in CLAIMS
        for i, knobs in enumerate(VARIED.get(name, []))
        if not (law == "monotone" and knobs.get("local"))  # dodge and burn is no curve
    ],
)
def test_an_operator_obeys_the_laws_that_it_claims_with_other_parameters(name, law, i):
    laws.CLAIMED[law](partial(OPERATORS[name], **VARIED[name][i]))


@pytest.mark.parametrize(("name", "law"), CLAIMS)
def test_an_operator_obeys_the_laws_that_it_claims(name, law):
    laws.CLAIMED[law](OPERATORS[name])


@pytest.mark.parametrize("name", OPERATORS)
@settings(max_examples=40, deadline=None)
@given(
    L=arrays(
        np.float32,
        array_shapes(min_dims=2, max_dims=2, max_side=12),
        elements=st.floats(0, float(np.float32(3e38)), width=32),
    )
)
def test_displayed_values_stay_in_range_for_any_radiance(name, L):
    Ld = OPERATORS[name](L)
    assert Ld.shape == L.shape and np.all((Ld >= 0) & (Ld <= 1))
