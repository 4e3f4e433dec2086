"""Photos that neither clearly fit nor clearly do not: hdrlab says so, and checks everything else."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.diagnostics.registration import Validation
from hdrlab.pipeline import alignment, registration, rigid_motion
from hdrlab.pipeline.alignment import Registration
from hdrlab.pipeline.rigid_motion import Fit

PAIR = Validation(
    moving=0,
    fixed=1,
    H=np.eye(3),
    offset=(0.0, 0.0),
    degrees=0.0,
    before=0.1,
    after=0.1,
    confidence=0.9,
    informative=True,
    failure="3 of 4 quarters of the image fit better elsewhere",
)
BORDERLINE = replace(PAIR, confirmed=False, is_borderline=True)


def fit(similarity=0.9, shift=0.1, usable=0.5):
    return Fit(
        H=np.eye(3),
        next=np.eye(3),
        step=0.0,
        usable=usable,
        similarity=similarity,
        shifts=np.full(8, shift),
        scale=1,
    )


def test_a_measure_close_to_its_limit_neither_confirms_nor_refutes_an_alignment():
    limit = rigid_motion.MIN_SIMILARITY
    for similarity, confirmed, refuted in ((0.99, False, False), (1.01, True, False)):
        found = fit(similarity=similarity * limit)
        assert (found.is_confirmed, found.is_refuted) == (confirmed, refuted)
    assert fit(similarity=0.8 * limit).is_refuted
    largest = rigid_motion.allowed_shift(1)
    assert not fit(shift=0.99 * largest).is_refuted
    assert not fit(shift=1.01 * largest).is_refuted
    assert fit(shift=1.5 * largest).is_refuted
    assert not fit(shift=9, usable=1.01 * rigid_motion.MIN_USABLE_FRACTION).is_refuted


@pytest.mark.parametrize(
    ("pairs", "claims_misalignment", "is_undecided"),
    [
        ([PAIR], False, False),
        ([BORDERLINE], False, True),
        ([replace(PAIR, apart=True, is_borderline=True)], False, True),
        ([replace(PAIR, confirmed=False)], True, False),
        ([replace(PAIR, apart=True)], True, False),
        ([BORDERLINE, replace(PAIR, confirmed=False)], True, False),
    ],
)
def test_a_borderline_pair_is_reported_without_a_claim(pairs, claims_misalignment, is_undecided):
    warnings, _ = registration.describe_pairs(pairs, ("a", "b"), "look")
    text = " ".join(warnings)
    assert ("could not be aligned" in text or "probably misaligned" in text) == claims_misalignment
    assert ("neither confirm nor refute" in text) == is_undecided


@pytest.mark.papers
@pytest.mark.parametrize("is_borderline", [False, True])
def test_photos_that_may_be_aligned_are_checked_for_other_causes(is_borderline, monkeypatch):
    """So the verdict shares a cause with that of the same photos if they were just aligned."""
    room = scenes.room((140, 210))
    warm = room * np.array([1.35, 1, 0.72], np.float32)
    times = camera.times_around(room, 5, stops=1.5)
    taken = camera.shoot(room, times, rng=1)
    taken.images[2] = camera.shoot(warm, times, rng=1).images[2]
    pair = replace(BORDERLINE, is_borderline=is_borderline)

    def register(images, method, **options):
        return Registration(
            homographies=np.tile(np.eye(3), (5, 1, 1)), pairs=(pair,), method="none"
        )

    monkeypatch.setattr(alignment, "register", register)
    warnings = " ".join(pipeline.assemble(taken).warnings)
    assert "misaligned" in warnings
    assert ("white balance" in warnings) == is_borderline
