"""The switch next to an image for HDR screens."""

import numpy as np
import pytest

from hdrlab.io import screens
from hdrlab.show.lit import Lit

pytestmark = pytest.mark.browser

LIMIT = "() => getComputedStyle(document.querySelector('img')).dynamicRangeLimit"


def test_the_switch_holds_the_picture_at_white_and_lets_it_go_again(page, tmp_path):
    screens.write_png(tmp_path / "dusk.png", np.linspace(0, 1, 96).reshape(4, 8, 3))
    (tmp_path / "page.html").write_text(Lit(tmp_path / "dusk.png", "A ramp")._repr_html_(), "utf8")
    page.goto((tmp_path / "page.html").as_uri())
    assert page.evaluate(LIMIT) == "no-limit"
    page.get_by_label("All the light").press("Space")
    assert page.evaluate(LIMIT) == "standard"
    page.get_by_label("All the light").click()
    assert page.evaluate(LIMIT) == "no-limit"
    assert page.get_by_text("no light beyond white").is_visible()  # no screen has any here
