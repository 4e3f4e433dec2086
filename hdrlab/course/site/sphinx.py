"""What Sphinx is told: how docstrings, formulas and names in backticks become pages."""

import re
from html import escape
from pathlib import Path
from typing import Any

from hdrlab import __version__
from hdrlab.course.site import formulas, reference

HERE = Path(__file__).parent
TABLE = re.compile(r"<table.*?</table>", re.DOTALL)
NAME = re.compile(r'(?<=<span class="pre">)[\w.]+(?=</span>)')
SETTINGS: dict[str, Any] = {
    "project": "hdrlab",
    "version": __version__,
    "release": __version__,
    "language": "en",
    "extensions": ["sphinx.ext.autodoc", "sphinx.ext.viewcode", "numpydoc", "myst_nb", __name__],
    "autosummary_generate": False,  # numpydoc loads it, and it would look for its lists in every page
    "default_role": "py:obj",
    "autodoc_typehints": "none",  # shapes and units stand in the text
    "autodoc_preserve_defaults": True,
    "numpydoc_show_class_members": False,
    "numpydoc_xref_param_type": False,
    "add_module_names": False,
    "toc_object_entries": False,
    "python_maximum_signature_line_length": 90,
    "myst_enable_extensions": ["dollarmath", "amsmath", "deflist", "attrs_inline"],
    "myst_heading_anchors": 3,
    "nb_execution_mode": "off",  # they have been run
    "nb_merge_streams": True,  # what a cell prints is one piece, however often it came
    "nb_ipywidgets_js": {},  # a page of ours opens its widgets itself
    "html_math_renderer": "drawn",
    "html_theme": "theme",
    "html_theme_path": [str(HERE)],
    "html_title": "hdrlab",
    "html_permalinks": False,
    "html_copy_source": False,
    "html_use_index": False,
    "html_domain_indices": False,
    "html_show_search_summary": False,  # it would fetch the pages it has found, which a folder does not allow
    "pygments_style": "bw",  # the theme has the colours
    "viewcode_line_numbers": True,
}


def setup(app: Any) -> dict[str, Any]:
    """Tell Sphinx what this extension does."""
    app.add_html_math_renderer("drawn", (_inline, None), (_display, None))
    app.connect("autodoc-process-docstring", _docstring, priority=400)  # numpydoc comes at 500
    app.connect("autodoc-skip-member", _skip)
    app.connect("missing-reference", _resolve)
    app.connect("html-page-context", _breakable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: Any) -> None:
    _draw(writer, node, "span", inline=True)


def _display(writer: Any, node: Any) -> None:
    _draw(writer, node, "div", inline=False)


def _draw(writer: Any, node: Any, tag: str, *, inline: bool) -> None:
    """Write a formula, or its source with a complaint that names the page: it costs no more."""
    from docutils.nodes import SkipNode
    from sphinx.util import logging

    try:
        html = formulas.formula(node.astext(), inline=inline)
    except Exception as error:  # whatever the parser stumbles over
        logging.getLogger(__name__).warning("formula: %s", error, location=node)
        html = f"<code>{escape(node.astext())}</code>"
    writer.body.append(f'<{tag} class="math">{html}</{tag}>')
    raise SkipNode


def _docstring(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    lines[:] = reference.laid_out(lines, module=what == "module")


def _skip(app: Any, what: str, name: str, obj: Any, skip: bool, options: Any) -> bool | None:
    """Leave out fields of NamedTuples, and what a module has from elsewhere."""
    elsewhere = what == "module" and not str(getattr(obj, "__module__", "hdrlab")).startswith("hdrlab")
    return True if elsewhere or reference.is_field(obj) else None


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
            return python.resolve_xref(env, node["refdoc"], app.builder, "obj", found[0][0], copy, content)
    return None


def _breakable(app: Any, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Let a name in a table break after a dot or an underscore: a narrow column cuts it nowhere else."""

    def broken(table: re.Match[str]) -> str:
        return NAME.sub(lambda name: re.sub(r"([._])(?=.)", r"\1<wbr>", name[0]), table[0])

    if "body" in context:
        context["body"] = TABLE.sub(broken, context["body"])
