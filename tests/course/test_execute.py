"""A notebook of the site runs beside others, and leaves nothing behind."""

import os

import nbformat
import pytest

from hdrlab.course.site import execute

ASKED = """import json, os, pathlib
from ipykernel import get_connection_file
file = pathlib.Path(get_connection_file())
print(json.loads(file.read_text())["transport"], file.parent, get_ipython().history_manager.enabled)
"""


@pytest.mark.skipif(os.name != "posix", reason="a system without sockets in files gives its kernels ports")
def test_a_kernel_listens_at_no_port_that_another_could_take_and_keeps_no_history(tmp_path):
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(ASKED)])
    nbformat.write(notebook, tmp_path / "asks.ipynb")
    (done,) = execute.run_steps([tmp_path / "asks.ipynb"], tmp_path / "cache")
    (said,) = nbformat.read(done.executed, as_version=4).cells[0].outputs
    transport, folder, history = said.text.split()
    assert (transport, history) == ("ipc", "False")
    assert not os.path.exists(folder) and not list((tmp_path / "cache/kernels").iterdir())
