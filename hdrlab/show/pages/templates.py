"""Render HTML pages from Jinja templates, with all values escaped.

The values come from file names and from readers, so they may contain HTML. A page that embeds all
that it shows extends `page.html`, which fetches nothing and runs no script.
"""

from pathlib import Path
from typing import Any

import jinja2

SHARED_TEMPLATES = Path(__file__).parent


def templates(folder: Path) -> jinja2.Environment:
    """Return the templates of a folder; they escape all values, and refuse unknown names."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader([folder, SHARED_TEMPLATES]),
        autoescape=jinja2.select_autoescape(default=True, disabled_extensions=("rst", "plain")),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def render_page(folder: Path, name: str, **words: Any) -> str:
    """Return the page that a template of a folder makes of the values `words`."""
    return templates(folder).get_template(name).render(words)
