"""Templates of pages. What they show comes from file names and from readers, so all of it is escaped.

A page that stands by itself, with all it needs, extends `page.html`: it fetches nothing and runs
nothing.
"""

from pathlib import Path
from typing import Any

import jinja2

HERE = Path(__file__).parent


def templates(folder: Path) -> jinja2.Environment:
    """Return the templates of a folder: all is escaped, and a name that is not known is an error."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader([folder, HERE]),
        autoescape=jinja2.select_autoescape(default=True, disabled_extensions=("rst", "plain")),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def render_page(folder: Path, name: str, **words: Any) -> str:
    """Return the page that a template of a folder makes of some words."""
    return templates(folder).get_template(name).render(words)
