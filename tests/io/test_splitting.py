"""`hdrlab.io.splitting`: a folder is split into the brackets that were taken."""

from datetime import datetime, timedelta
from pathlib import Path

import numpy as np

from hdrlab.io.decode import PhotoHeader
from hdrlab.io.exif_exposure import Exposure
from hdrlab.io.splitting import split_into_brackets

START = datetime(2024, 5, 1, 12, 0, 0)
SERIES = [1 / 100, 1 / 400, 1 / 25]


def headers(times, seconds=None):
    """Return headers of photos with these exposure times, taken so many seconds after the first."""
    result = []
    for j, time in enumerate(times):
        taken = None if seconds is None else START + timedelta(seconds=seconds[j])
        header = PhotoHeader(
            Path(f"{j:03d}.jpg"),
            "JPEG",
            (4, 6, 3),
            np.dtype(np.uint8),
            exposure=Exposure(time, 8, 100),
            taken=taken,
        )
        result.append(header)
    return result


def sizes(brackets):
    return [len(bracket) for bracket in brackets]


def test_repeated_series_are_brackets_also_without_time_stamps():
    assert sizes(split_into_brackets(headers(3 * SERIES))) == [3, 3, 3]


def test_photos_without_exposures_and_time_stamps_are_one_bracket():
    assert sizes(split_into_brackets(headers([None] * 7))) == [7]


def test_photos_that_all_state_one_exposure_are_one_bracket():
    assert sizes(split_into_brackets(headers([1 / 60] * 5, range(5)))) == [5]


def test_an_exposure_that_was_taken_twice_does_not_split_a_bracket():
    assert sizes(split_into_brackets(headers([1, 2, 4, 4, 8, 16], range(0, 60, 10)))) == [6]


def test_a_pause_in_a_series_of_new_exposures_does_not_split_a_bracket():
    assert sizes(split_into_brackets(headers([1, 2, 4, 8], [0, 10, 150, 160]))) == [4]


def test_a_long_exposure_is_no_pause():
    assert sizes(split_into_brackets(headers([64, 128, 64.5], [0, 70, 200]))) == [3]


def test_a_pause_splits_scenes_whose_exposures_overlap():
    times = [1, 4, 16, 2, 4, 8, 32]
    seconds = [0, 2, 7, 200, 203, 208, 217]
    assert sizes(split_into_brackets(headers(times, seconds))) == [3, 4]


def test_a_very_long_pause_splits_scenes_of_different_exposures():
    times = [1, 4, 0.01, 0.04]
    assert sizes(split_into_brackets(headers(times, [0, 2, 4000, 4001]))) == [2, 2]


def test_names_of_a_camera_that_counted_over_do_not_mix_brackets():
    photos = headers(2 * SERIES, [200, 201, 202, 0, 1, 2])
    first = split_into_brackets(photos)[0]
    assert [header.path.name for header in first] == ["003.jpg", "004.jpg", "005.jpg"]


def test_a_last_series_that_was_broken_off_is_split_from_the_others():
    assert sizes(split_into_brackets(headers([*SERIES, *SERIES, *SERIES[:2]]))) == [3, 3, 2]
