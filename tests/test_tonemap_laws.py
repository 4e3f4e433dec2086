"""Every tone mapping operator obeys the laws of all and those it claims; a new one is tested by existing."""

from importlib import import_module

import laws
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from hdrlab.core import catalogue

OPERATORS = {name: catalogue.method("tonemap", name) for name in catalogue.names("tonemap")}
CLAIMS = [
    (name, law) for name in OPERATORS for law in getattr(import_module(f"hdrlab.tonemap.{name}"), "LAWS", ())
]


@pytest.mark.parametrize("law", laws.ALWAYS, ids=lambda law: law.__name__)
@pytest.mark.parametrize("name", OPERATORS)
def test_every_operator(name, law):
    law(OPERATORS[name])


@pytest.mark.parametrize(("name", "law"), CLAIMS)
def test_an_operator_keeps_what_it_claims(name, law):
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
def test_no_radiance_leaves_the_display(name, L):
    Ld = OPERATORS[name](L)
    assert Ld.shape == L.shape and np.all((Ld >= 0) & (Ld <= 1))
