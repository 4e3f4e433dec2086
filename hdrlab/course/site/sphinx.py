"""What Sphinx is told: how docstrings, formulas and names in backticks become pages."""

import re
import textwrap
import tomllib
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from hdrlab import __version__
from hdrlab.course.site import formulas, reference

HERE = Path(__file__).parent
TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
DOTTED_NAME = re.compile(r'(?<=<span class="pre">)[\w.]+(?=</span>)')
# letters that a page's description has at least, and at most
MIN_SUMMARY_LENGTH = 40
MAX_SUMMARY_LENGTH = 200
GLYPH_SYMBOL = re.compile(r"<symbol .*?</symbol>", re.DOTALL)
# From a source to its place in the reference: viewcode names the module from which it came there
# first
BACK_LINK = re.compile(
    r'((?<=id=")([\w.]+)">\s*<a class="viewcode-back" href="[^"#]*?([\w.]+)\.html)#[^"]*'
)
SETTINGS: dict[str, Any] = tomllib.loads((HERE / "settings.toml").read_text("utf-8"))
SETTINGS |= {"version": __version__, "release": __version__, "html_theme_path": [str(HERE)]}
SETTINGS["extensions"].append(__name__)


def setup(app: Any) -> dict[str, Any]:
    """Tell Sphinx what this extension does."""
    from hdrlab.course.site.words import SearchTokenizer

    app.add_search_language(SearchTokenizer)
    # in a line of text, and by itself
    renderers = ((partial(_draw, tag=tag), None) for tag in ("span", "div"))
    app.add_html_math_renderer("drawn", *renderers)
    app.connect("autodoc-process-docstring", _docstring, priority=400)  # numpydoc comes at 500
    app.connect("autodoc-skip-member", _skip)
    app.connect("missing-reference", _resolve)
    app.connect("html-page-context", _typeset)
    app.connect("html-page-context", _describe)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _draw(writer: Any, node: Any, *, tag: str) -> None:
    """Write a formula, or its source with a complaint that names the page: it costs no more."""
    from docutils.nodes import SkipNode
    from sphinx.util import logging

    try:
        html = formulas.formula(node.astext(), inline=tag == "span")
    except Exception as error:  # whatever the parser stumbles over
        logging.getLogger(__name__).warning("formula: %s", error, location=node)
        html = f"<code>{escape(node.astext())}</code>"
    writer.body.append(f'<{tag} class="math">{html}</{tag}>')
    raise SkipNode


def _docstring(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    lines[:] = reference.format_docstring(lines, module=what == "module")


def _skip(app: Any, what: str, name: str, obj: Any, skip: bool, options: Any) -> bool | None:
    """Leave out fields of NamedTuples, and what a module has from elsewhere."""
    elsewhere = what == "module" and not str(getattr(obj, "__module__", "hdrlab")).startswith(
        "hdrlab"
    )
    # a field's only words are "Alias for field number 0"
    return True if elsewhere or type(obj).__name__ == "_tuplegetter" else None


def _resolve(app: Any, env: Any, node: Any, content: Any) -> Any:
    """Find what stands in backticks, such as `merge.merge`: in its module, its chapter, or the package."""
    if node.get("reftype") != "obj" or node.get("refdomain") != "py":
        return None
    module = node.get("py:module") or "hdrlab"
    python = env.get_domain("py")
    for around in dict.fromkeys((module, module.rpartition(".")[0], "hdrlab")):
        found = python.find_obj(env, None, None, f"{around}.{node['reftarget']}", "obj")
        if found:
            copy = node.copy()
            copy["reftarget"] = found[0][0]
            return python.resolve_xref(
                env, node["refdoc"], app.builder, "obj", found[0][0], copy, content
            )
    return None


def _describe(app: Any, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Give a page the sentences under which a link to it is shown elsewhere: its first without a formula."""
    from docutils import nodes

    context["site"] = app.config.html_baseurl
    for part in doctree.findall(nodes.paragraph) if doctree else ():
        if next(part.findall(nodes.math), None) is None and len(part.astext()) > MIN_SUMMARY_LENGTH:
            context["summary"] = textwrap.shorten(
                part.astext(), MAX_SUMMARY_LENGTH, placeholder=" …"
            )
            return


def _typeset(app: Any, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Let a name in a table break after a dot or an underscore, and draw each letter of formulas once.

    A narrow column cuts a name nowhere else; a formula uses what one before it has drawn.
    """
    drawn: dict[str, int] = {}

    def broken(table: re.Match[str]) -> str:
        return DOTTED_NAME.sub(lambda name: re.sub(r"([._])(?=.)", r"\1<wbr>", name[0]), table[0])

    def once(glyph: re.Match[str]) -> str:
        return glyph[0] if drawn.setdefault(glyph[0], glyph.start()) == glyph.start() else ""

    if "body" in context:
        context["body"] = GLYPH_SYMBOL.sub(once, TABLE.sub(broken, context["body"]))
        if page.startswith("_modules/"):
            context["body"] = BACK_LINK.sub(r"\1#hdrlab.\3.\2", context["body"])
