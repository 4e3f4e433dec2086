"""Importing hdrlab changes nothing outside it."""

import subprocess
import sys
from unittest.mock import MagicMock

import pytest

IMPORT_EVERYTHING = """
import importlib
import pkgutil
import sys

import hdrlab

def skip(name):
    return name.endswith("__main__") or ".specification." in name or ".inside" in name

before = {name for name, module in sys.modules.items() if module is None}
for module in pkgutil.walk_packages(hdrlab.__path__, "hdrlab."):
    if not skip(module.name):
        importlib.import_module(module.name)
blocked = {name for name, module in sys.modules.items() if module is None} - before
print(*sorted(blocked))
"""


@pytest.mark.wheel
def test_importing_hdrlab_leaves_every_other_package_importable():
    command = [sys.executable, "-W", "ignore", "-c", IMPORT_EVERYTHING]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stdout.split() == []


def test_the_sphinx_extension_leaves_numpydoc_as_it_is():
    numpydoc = pytest.importorskip("numpydoc.docscrape_sphinx")
    from hdrlab.course.site import sphinx

    environment = numpydoc.SandboxedEnvironment
    sphinx.setup(MagicMock())
    assert numpydoc.SandboxedEnvironment is environment
