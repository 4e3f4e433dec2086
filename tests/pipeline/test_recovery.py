"""A response that the photos contradict is replaced with a warning; a user's own response is not."""

from dataclasses import replace

import numpy as np
import pytest
from support import laws

from hdrlab import pipeline
from hdrlab.capture import camera
from hdrlab.capture.responses import RESPONSES, true_g
from hdrlab.errors import InputError
from hdrlab.fast import debevec
from hdrlab.pipeline import catalogue, recovery
from hdrlab.response import linear

pytestmark = pytest.mark.papers

CAMERAS = {"mann": ["gamma", "linear"], "marginal": ["film"]}
METHODS = [name for name in catalogue.names("response") if name != "linear"]
CASES = [
    (method, response) for method in METHODS for response in CAMERAS.get(method, sorted(RESPONSES))
]


@pytest.mark.parametrize("law", laws.CONSISTENCY, ids=lambda law: law.__name__)
@pytest.mark.parametrize(("name", "response"), CASES)
def test_every_recovery_by_name_is_validated(name, response, law):
    law(recovery.find_validated_method(name), response)


@pytest.fixture(scope="module")
def taken(decades):
    return camera.shoot(
        decades((60, 80)), [0.01, 0.04, 0.16, 0.64], camera.Camera(response="film"), rng=1
    )


@pytest.mark.parametrize("method", ["auto", *METHODS])
def test_the_response_of_the_prior_is_used_if_the_photos_contradict_their_times(taken, method):
    wrong = replace(taken, times=taken.times * [1, 1, 1, 10_000])
    recovered = pipeline.assemble(wrong, align="none", response=method)
    assert any("check the exposure times" in warning for warning in recovered.warnings)
    assert recovered.fallback and np.all(np.isfinite(recovered.E)) and recovered.E.any()


def test_the_response_of_the_prior_is_used_if_a_method_finds_none(taken, monkeypatch):
    def refuse(*_, **__):
        raise InputError("expected the moon")

    monkeypatch.setattr("hdrlab.response.mann.recover", refuse)
    recovered = recovery.find_response("mann", recovery.choose_response("mann", taken), taken)
    assert laws.curve_error(recovered.g, true_g("film")) < 0.05 and not recovered.fallback
    (warning,) = recovered.warnings
    assert "expected the moon" in warning


@pytest.mark.quick
def test_linear_and_callables_are_not_validated():
    assert recovery.find_validated_method("linear") is linear.recover
    assert recovery.find_validated_method(debevec.recover) is debevec.recover


def test_validation_does_not_change_the_response(taken):
    g = recovery.find_validated_method("debevec")(taken.images, taken.times)
    assert np.array_equal(g, debevec.recover(taken.images, taken.times))


def test_values_that_only_one_photo_shows_do_not_close_a_gap():
    assert recovery.find_widest_gap([[100, 200], [101, 201], [20, 255]]) == 99
    assert recovery.find_widest_gap([[100, 200], [101, 201], [150, 255], [150, 0]]) == 99
