"""An image for HDR screens on a page: the original file, a switch, and a text for other screens."""

import numpy as np
import pytest

from hdrlab.io import screens, web
from hdrlab.show.lit import Lit


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "dusk.png"
    screens.write_png(path, np.full((4, 6, 3), 0.58))
    return path


def test_html_embeds_the_unchanged_file_with_its_alt_text(file):
    html = Lit(file, "A wall at dusk")._repr_html_()
    assert f'alt="A wall at dusk" src="{web.data_uri(file.read_bytes(), "png")}"' in html
    assert "data:image/png;base64," in html


def test_repr_is_the_alt_text(file):
    assert repr(Lit(file, "A wall at dusk")) == "A wall at dusk"


def test_empty_alt_text_is_rejected(file):
    with pytest.raises(ValueError, match="alt text"):
        Lit(file, " ")._repr_html_()


def test_html_has_a_switch_that_limits_the_image_to_white(file):
    html = Lit(file, "A wall at dusk")._repr_html_()
    assert '<label><input type="checkbox" checked> All the light' in html
    assert ":has(input:checked) img { dynamic-range-limit: no-limit; }" in html
    assert "@media (dynamic-range: high)" in html and "no light beyond white" in html
