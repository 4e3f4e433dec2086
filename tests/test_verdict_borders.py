"""The rows that look for opposite verdicts: their judge, their table, and one border."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.verdicts import bands, borders, brackets, claims, machines, statistics
from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.diagnostics.warning_texts import SENTENCES
from hdrlab.pipeline.assembly import Assembly
from hdrlab.radiance.deghosting import ghosts
from hdrlab.radiance.deghosting.ghosts import Ghosts


def assembly(*warnings, notes=()):
    return Assembly(stage="compare", bracket=None, offsets=None, warnings=warnings, notes=notes)


def test_two_verdicts_contradict_each_other_only_if_they_share_no_cause():
    flicker = claims.blamed_causes(assembly("lamps flicker: the light changed by 0.10 stops"))
    either = claims.blamed_causes(
        assembly(
            "either lamps flicker or exposure times are wrong, and the pixels do not show which"
        )
    )
    moved = claims.blamed_causes(assembly(notes=("something moved in 2 regions",)))
    nothing = claims.blamed_causes(assembly(notes=("aligned",)))
    assert either == {"flicker", "times"}
    assert claims.contradict(flicker, moved)
    assert not claims.contradict(flicker, either)
    assert not claims.contradict(flicker, nothing)


@pytest.mark.parametrize("phrase", claims.PHRASES)
def test_each_phrase_that_blames_a_cause_is_a_part_of_a_warning_or_of_a_note(phrase):
    image = np.zeros((2, 2))
    one_moved = Ghosts(
        E=image,
        quality=image,
        labels=np.ones((2, 2), int),
        references=np.array([0]),
        used=np.ones((1, 2, 2), bool),
        score=image,
        alpha=image,
    )
    texts = [*SENTENCES.values(), ghosts.note(one_moved, ["a.jpg"])]
    causes = " or ".join(text for name, text in SENTENCES.items() if name.endswith("_cause"))
    texts.append(f"{causes}, and the pixels do not show which")
    assert any(phrase.removesuffix(", and") in text for text in texts)


def test_the_table_of_bands_lists_ends_around_their_limits(capsys):
    bands.print_bands()
    printed = capsys.readouterr().out
    for band in bands.BANDS:
        assert band.low <= band.limit <= band.high
        assert band.verdict in printed


@pytest.mark.papers
def test_on_both_sides_of_the_border_of_a_white_balance_no_verdict_is_the_opposite(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(borders, "BISECTIONS", 3)
    monkeypatch.setattr(borders, "REPETITIONS", 1)
    names = [series.name for series in borders.SERIES]
    results = borders.try_series((names.index("white balance"), tmp_path))
    assert results
    assert any("white_balance" in result.above for result in results)
    assert sum(result.opposites for result in results) == 0


def test_light_that_differs_by_a_millionth_changes_few_pixel_values_by_one_level(tmp_path):
    plan = brackets.plan(tmp_path, 3)
    ill = borders.state_wrong_time(1.0)
    changed = borders.add_noise(ill, 0)
    Z = np.random.default_rng(0).integers(0, 256, (400, 600, 3), np.uint8)
    expected = ill.levels(plan, 0, np.random.default_rng(0), Z)
    found = changed.levels(plan, 0, np.random.default_rng(0), Z)
    differences = np.abs(found.astype(int) - expected)
    assert differences.max() == 1
    assert 0 < np.mean(differences > 0) < 300e-6
    assert changed.light is ill.light


def test_the_statistics_of_a_bracket_are_recorded_while_it_is_assembled():
    room = scenes.room((140, 210))
    times = camera.times_around(room, 4, stops=1.5)
    taken = camera.shoot(room, times, rng=1)
    wrong = replace(taken, times=taken.times * [1, 1, 2, 1])
    names = {
        "spread, stops",
        "bands, stops",
        "similarity of gradients",
        "sum of roots over the least",
    }
    values = statistics.measure(wrong)
    assert names <= {band.statistic for band in bands.BANDS}
    assert names <= set(values)
    assert statistics.measure(wrong) == values
    assert statistics.measure(taken)["time error, stops"] < values["time error, stops"]


@pytest.mark.parametrize(("change", "flips", "opposites"), [(1.0, 0, 0), (1.06, 1, 0), (1.2, 1, 1)])
def test_a_change_larger_than_the_band_is_an_opposite_verdict(change, flips, opposites):
    band = bands.with_margin("example", "example, stops", 0.2, "names both")
    narrow = replace(band, low=0.2, high=0.22)
    changes = [("example, stops", 0.21, change), ("example, stops", 5.0, 9.0), ("other", 0.2, 9.0)]
    assert statistics.compare_band(narrow, changes) == (1, flips, opposites)


@pytest.mark.papers
@pytest.mark.parametrize("layout", ["F", "strided"])
def test_the_verdict_and_the_map_are_the_same_in_other_memory_layouts(layout):
    room = scenes.room((140, 210))
    times = camera.times_around(room, 5, stops=1.5)
    warm = camera.shoot(room * np.array([1.35, 1, 0.72], np.float32), times, rng=1).images[2]
    taken = camera.shoot(room, times, rng=1)
    images = taken.images.copy()
    images[2] = warm
    expected = pipeline.assemble(replace(taken, images=images))
    found = pipeline.assemble(replace(taken, images=machines.lay_out(images, layout)))
    assert expected.warnings
    assert found.warnings == expected.warnings
    assert found.notes == expected.notes
    assert np.allclose(found.E, expected.E, rtol=1e-5)
