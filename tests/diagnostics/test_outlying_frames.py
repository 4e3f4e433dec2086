"""Which frames are left out, by how far the others agree without them."""

import numpy as np
import pytest

from hdrlab.diagnostics import flat_patches, outlying_frames


class Patches:
    """Patches that are never looked at."""

    def of(self, frames):
        """Return those of some of the frames."""
        return self


@pytest.mark.parametrize(
    ("count", "misfits", "found"),
    [
        (4, {"": 0.3, "2": 0}, ((), ())),
        (4, {"": 0.31, "2": 0}, ((2,), ())),
        (4, {"": 0.31, "0": 0.14, "1": 0.1, "2": 0.1}, ((1,), (2,))),
        (4, {"": 0.31, "0": 0.11}, ((), ())),
        (4, {"": 0.31, "1": 0.1, "2": 0.105}, ((1,), (2,))),  # 2 is named, too: it may be the one
        (4, {"": 0.31, "1": 0.105, "2": 0.1}, ((2,), (1,))),
        (4, {"": 0.31, "1": 0.1, "2": 0.14}, ((1,), ())),
        (6, {"": 1, "0": 0.1, "01": 0}, ((0,), ())),
        (6, {"": 1, "0": 0.9, "01": 0.1}, ((0, 1), ())),
        (6, {"": 1, "0": 0.9, "01": 0.8, "012": 0}, ((), ())),
        (3, {"": 1, "0": 0}, ((), ())),
    ],
)
def test_at_most_a_third_of_the_frames_is_left_out_and_only_if_the_others_then_agree(
    count, misfits, found, monkeypatch
):
    def pair_errors(patches, B):
        gone = set(range(count)) - {round(t) - 1 for t in np.exp(B)}
        return np.full(len(B) - 1, misfits.get("".join(map(str, sorted(gone))), 2))

    monkeypatch.setattr(flat_patches, "find_flat_patches", lambda *_, **__: Patches())
    monkeypatch.setattr(outlying_frames, "measure_pair_errors", pair_errors)
    monkeypatch.setattr(outlying_frames, "contradicts_others", lambda *_: True)
    images = np.zeros((count, 2, 2), np.uint8)
    assert outlying_frames.find_outlying_frames(images, np.arange(1, count + 1)) == found
