"""The texts of warnings in doubts.toml."""

import pytest

from hdrlab.diagnostics import doubts


@pytest.mark.parametrize("name", doubts.SENTENCES)
def test_each_text_is_one_line(name):
    text = doubts.SENTENCES[name]
    assert "\n" not in text
    assert "  " not in text


def test_values_are_filled_in():
    text = doubts.warning_text("not_aligned", pair="a.jpg and b.jpg")
    assert text.startswith("a.jpg and b.jpg: ")
