"""The texts of warnings and notes, kept together in doubts.toml so that they read alike; their margin."""

import tomllib
from pathlib import Path

# A verdict must be the same for statistics that are larger or smaller by this factor. If it is not,
# the warning claims less: other processors round differently.
MARGIN = 1.1

SENTENCES: dict[str, str] = tomllib.loads(Path(__file__).with_name("doubts.toml").read_text("utf8"))


def warning_text(name: str, **values: object) -> str:
    """Return a text of doubts.toml with `values` filled in.

    Examples
    --------
    >>> warning_text("rivals", frames="a.jpg")
    '; a.jpg may be the wrong photo instead, and then the map is wrong, too'
    """
    return SENTENCES[name].format(**values)
