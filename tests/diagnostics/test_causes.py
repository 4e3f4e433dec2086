"""Why photos contradict each other: no verdict is the opposite of one for nearly the same numbers."""

from dataclasses import fields, replace

import numpy as np
import pytest

from hdrlab.diagnostics import causes
from hdrlab.diagnostics.causes import CAUSES, Evidence, find_causes
from hdrlab.diagnostics.contradictions import Contradictions, find_contradictions
from hdrlab.diagnostics.motion import MAX_FLICKER_FRACTION
from hdrlab.diagnostics.warning_texts import MARGIN, SENTENCES, warning_text

STATISTICS = tuple(field.name for field in fields(Evidence))
# on both sides of every limit of `causes.decide`
VALUES = {
    "tint": (0, 0.2, 0.3),
    "corners": (0, 0.015, 0.05),
    "regions": (0, 0.03, 0.08, 0.3),
    "significance": (0, 2, 8),
    "time_error": (0, 0.2, 0.4, 0.9),
    "cost": (0.01, 0.2),
    "spread": (0, 0.05, 0.2, 0.4),
    "fraction": (0, 0.003, 0.02, 0.1),
    "bands": (0, 0.03, 0.2),
}


def draw(rng):
    """Return Evidence of which half of the statistics are close to a limit."""
    return Evidence(**{name: float(rng.choice(values)) for name, values in VALUES.items()})


def find_border(low, high):
    """Return two Evidences on both sides of a border between `low` and `high`, a 1e-6th apart."""

    def mix(part):
        values = {
            name: (1 - part) * getattr(low, name) + part * getattr(high, name)
            for name in STATISTICS
        }
        return Evidence(**values)

    start = 0.0
    end = 1.0
    while end - start > 1e-6:
        middle = (start + end) / 2
        if causes.decide(mix(middle)) == causes.decide(low):
            start = middle
        else:
            end = middle
    return mix(start), mix(end)


@pytest.mark.papers
def test_on_both_sides_of_every_border_the_verdicts_have_a_cause_in_common_or_one_has_none():
    rng = np.random.default_rng(0)
    border_count = 0
    undecided_count = 0
    for _ in range(1500):
        low = draw(rng)
        high = draw(rng)
        if causes.decide(low) == causes.decide(high):
            continue
        before, after = find_border(low, high)
        # where the decision without a band would be another one
        border_count += bool(causes.decide(before)) and bool(causes.decide(after))
        first = set(find_causes(before))
        second = set(find_causes(after))
        assert not first or not second or first & second, (before, after)
        undecided_count += len(first) > 1
    assert border_count > 200
    assert undecided_count > 200


NEAR_BORDERS = {
    ("white_balance", "times"): Evidence(tint=0.25, time_error=1, spread=0.3),
    ("corners", "local"): Evidence(corners=0.02, regions=0.3, spread=0.3),
    ("local", "times"): Evidence(regions=0.25, time_error=0.5, spread=0.3),
    ("flicker", "local"): Evidence(regions=0.04, significance=9, bands=0.055, spread=0.2),
    ("flicker", "times"): Evidence(time_error=0.3, bands=0.06, spread=0.2),
    ("flicker", "moved"): Evidence(fraction=0.02, bands=0.055, spread=0.05),
    ("times", "moved"): Evidence(time_error=0.25, fraction=0.2, spread=0.1),
    ("local", "unexplained"): Evidence(regions=0.1, spread=0.4),
    ("times", "unexplained"): Evidence(time_error=0.25, spread=0.4),
    ("moved", "unexplained"): Evidence(fraction=0.006, spread=0.4),
}


@pytest.mark.parametrize("pair", NEAR_BORDERS, ids="-".join)
@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_near_the_border_of_two_causes_hdrlab_claims_neither(pair, factor):
    """Whichever side of the border the statistics are on, the verdict is the same."""
    evidence = NEAR_BORDERS[pair]
    for name in STATISTICS:
        moved = replace(evidence, **{name: factor * getattr(evidence, name)})
        if causes.decide(moved):
            assert set(pair) <= set(find_causes(moved)), name


@pytest.mark.parametrize("pair", NEAR_BORDERS, ids="-".join)
def test_far_from_the_border_hdrlab_claims_one_of_the_two(pair):
    evidence = NEAR_BORDERS[pair]
    claims = set()
    for name in STATISTICS:
        value = getattr(evidence, name)
        for factor in (0.3, 3):
            claims.add(find_causes(replace(evidence, **{name: factor * value})))
    assert any(len(claim) == 1 for claim in claims)


def test_a_bracket_without_contradictions_gets_no_warning_close_to_a_limit():
    for name, limit in (("fraction", 0.006), ("bands", 0.055), ("spread", 0.25), ("tint", 0.25)):
        assert find_causes(Evidence(**{name: 0.999 * limit})) == ()


@pytest.mark.parametrize("cause", CAUSES)
def test_each_cause_has_a_warning_of_its_own_and_a_part_in_the_undecided_one(cause):
    assert cause in SENTENCES
    for part in ("cause", "evidence", "advice"):
        assert f"{cause}_{part}" in SENTENCES


def test_an_undecided_warning_names_both_causes_with_their_numbers_and_what_to_do():
    found = Contradictions(
        stops=np.array([0, 0.5, 0, 0]), regions=np.array([0.1, 0.25, 0.25]), cost=0.3
    )
    text = causes.warn_of_contradictions(found, "abcd", 0.3)
    assert "either" in text
    assert "b by +0.50" in text
    assert "between b and c" in text
    for cause in ("local", "times"):
        assert warning_text(f"{cause}_advice") in text


def test_moving_things_and_flickering_lamps_are_told_apart_or_named_together():
    """Ghosts are removed only where something moved, so this decides on the map, too."""
    assert causes.is_moving(0.1, 0.03)
    assert causes.is_moving(0.1, 0.2)
    assert not causes.is_moving(0.02, 0.2)
    assert not causes.is_moving(0.02, 0.056)
    assert not causes.is_moving(0.02, 0.054)


def test_whether_a_region_with_ghosts_is_found_does_not_change_a_verdict_into_its_opposite():
    """If hdrlab removes ghosts, it says that something moved, and ignores bands."""
    rng = np.random.default_rng(6)
    flickering_count = 0
    for _ in range(300):
        evidence = replace(draw(rng), fraction=0.0)
        with_ghosts = {"moved", *find_causes(replace(evidence, bands=0.0))}
        without_ghosts = set(find_causes(replace(evidence, unresolved_fraction=0.05)))
        assert not without_ghosts or with_ghosts & without_ghosts
        flickering_count += "flicker" in without_ghosts
    assert flickering_count > 10


def test_whether_ghosts_are_removed_does_not_change_a_verdict_into_its_opposite():
    """Close to the limit of clear motion, bands are ignored on one side, and not on the other."""
    rng = np.random.default_rng(7)
    limit = MAX_FLICKER_FRACTION * MARGIN
    flickering_count = 0
    for _ in range(300):
        evidence = replace(draw(rng), bands=0.2)
        assert causes.is_moving(1.001 * limit, evidence.bands)
        assert not causes.is_moving(limit / 1.001, evidence.bands)
        with_ghosts = {"moved", *find_causes(replace(evidence, fraction=0.0, bands=0.0))}
        without_ghosts = set(find_causes(replace(evidence, fraction=limit / 1.001)))
        assert with_ghosts & without_ghosts
        flickering_count += "flicker" in without_ghosts
    assert flickering_count > 10


def test_photos_that_are_about_as_likely_to_have_the_wrong_time_are_named_too():
    images = np.random.default_rng(0).integers(20, 200, (4, 60, 90), np.uint8)
    assert find_contradictions(images, [1, 2, 4, 8]).other_stops.size in (0, 4)
    found = Contradictions(
        stops=np.array([0, 0, 1.0, 1.0]),
        other_stops=np.array([-1.0, -1.0, 0, 0]),
        regions=np.zeros(3),
    )
    text = causes.warn_of_contradictions(found, "abcd")
    assert "c by +1.00, d by +1.00" in text
    assert "a by -1.00, b by -1.00" in text
