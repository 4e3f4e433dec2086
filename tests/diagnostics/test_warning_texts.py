"""The texts of warnings in warning_texts.toml."""

import pytest

from hdrlab.diagnostics import warning_texts


@pytest.mark.parametrize("name", warning_texts.SENTENCES)
def test_each_text_is_one_line(name):
    text = warning_texts.SENTENCES[name]
    assert "\n" not in text
    assert "  " not in text


def test_values_are_filled_in():
    text = warning_texts.warning_text("not_aligned", pair="a.jpg and b.jpg")
    assert text.startswith("a.jpg and b.jpg: ")
