"""The texts of warnings and notes, kept together in warning_texts.toml so that they read alike."""

import tomllib
from pathlib import Path

# A verdict must be the same for statistics that are larger or smaller by this factor. If it is not,
# the warning claims less: other processors round differently.
MARGIN = 1.1

SENTENCES: dict[str, str] = tomllib.loads(
    Path(__file__).with_name("warning_texts.toml").read_text("utf8")
)


def warning_text(name: str, **values: object) -> str:
    """Return a text of warning_texts.toml with `values` filled in.

    Examples
    --------
    >>> warning_text("rivals", frames="a.jpg")
    '; a.jpg may be the wrong photo instead, and then the map is wrong, too'
    """
    return SENTENCES[name].format(**values)
