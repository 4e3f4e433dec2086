"""The laboratory of the tests, `tests/browser/laboratory.py`, with the Chromium that a reader has."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

from benchmarks.experiments import Skipped
from benchmarks.measure import ROOT

WINDOW = {"width": 1280, "height": 900}


def laboratory() -> ModuleType:
    """Return the tests' module; `tests` is no package."""
    spec = spec_from_file_location("laboratory", ROOT / "tests" / "browser" / "laboratory.py")
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@contextmanager
def page() -> Iterator[tuple[Any, ModuleType]]:
    """Return a page of Chromium, and the laboratory it was started with."""
    tools = laboratory()
    try:
        with tools.chromium("chromium") as browser:
            yield browser.new_page(viewport=WINDOW), tools
    except tools.Absent as reason:
        raise Skipped(str(reason)) from None


@contextmanager
def lab(folder: Path) -> Iterator[tuple[Any, ModuleType, Any]]:
    """Return a page, the laboratory, and a JupyterLab on a copy of the notebooks."""
    with page() as (opened, tools), tools.jupyterlab(folder) as server:
        yield opened, tools, server
