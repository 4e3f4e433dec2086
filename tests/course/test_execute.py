"""Notebooks of the site run in parallel and leave nothing behind."""

import os
import tempfile

import nbformat
import pytest

from hdrlab.course.authoring import execute

pytestmark = pytest.mark.grading

CODE_OF_CELL = """import json, os, pathlib
from ipykernel import get_connection_file
file = pathlib.Path(get_connection_file())
print(json.loads(file.read_text())["transport"], file.parent, get_ipython().history_manager.enabled)
"""


@pytest.fixture
def asking(tmp_path):
    """A notebook that prints how its kernel is connected."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CODE_OF_CELL)])
    nbformat.write(notebook, tmp_path / "asks.ipynb")
    return tmp_path / "asks.ipynb"


def run_notebook(asking):
    """Run the notebook; return its transport, the folder of its connection file, and whether it keeps a
    history.
    """
    (done,) = execute.run_steps([asking], asking.parent / "cache")
    (output,) = nbformat.read(done.executed, as_version=4).cells[0].outputs
    return output.text.split()


def assert_no_kernel_is_left(asking):
    assert not list((asking.parent / "cache/kernels").iterdir())


@pytest.mark.skipif(
    os.name != "posix", reason="a system without sockets in files gives its kernels ports"
)
def test_a_kernel_uses_no_network_port_and_keeps_no_history(asking):
    transport, folder, history = run_notebook(asking)
    assert (transport, history) == ("ipc", "False")
    assert not os.path.exists(folder)
    assert_no_kernel_is_left(asking)


def test_a_kernel_starts_if_the_temporary_path_is_too_long_for_a_socket(asking, monkeypatch):
    long = asking.parent / ("long" * 25)
    long.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(long))
    transport, folder, _ = run_notebook(asking)
    assert transport == "tcp" and folder.startswith(str(long))
    assert not list(long.iterdir())
    assert_no_kernel_is_left(asking)


def test_a_kernel_that_dies_at_start_is_reported_with_its_notebook(asking, monkeypatch):
    short = tempfile.mkdtemp(prefix="k")
    monkeypatch.setattr(tempfile, "tempdir", short)
    monkeypatch.setenv("PYTHONHOME", "/proc/nowhere")
    with pytest.raises(execute.NotebookError, match=r"^asks\.ipynb, its kernel: Kernel died"):
        run_notebook(asking)
    os.rmdir(short)  # is empty
    assert_no_kernel_is_left(asking)
