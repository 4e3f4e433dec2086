"""The brackets of the site's page about problems: the packaged photos are those in the figures."""

from pathlib import Path

import numpy as np
import pytest

from hdrlab.course.site import pages
from hdrlab.io import web
from scenes import cases

pytestmark = pytest.mark.scenes


@pytest.mark.parametrize("name", cases.CASES)
def test_the_picture_of_a_case_that_travels_is_the_one_that_is_drawn(name):
    shipped = web.decode_picture((Path(pages.PAGES) / "cases" / f"{name}.webp").read_bytes())
    drawn = web.decode_picture(web.encode_webp(cases.draw_case(name)))  # which loses a little
    assert shipped.shape == drawn.shape
    assert np.abs(shipped.astype(float) - drawn).mean() < 2
