"""Ways to start hdrlab other than pip: Binder, the image for a JupyterHub, and the dev container."""

import json
import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.specifiers import SpecifierSet
from traitlets.config import PyFileConfigLoader

from hdrlab import cli
from hdrlab.course import materials

ROOT = Path(__file__).parents[1]
BINDER = ROOT / ".binder"
pytestmark = pytest.mark.skipif(
    not BINDER.exists(), reason="reads a clone, and this is an installed package"
)


@pytest.fixture(scope="module")
def project():
    return tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


@pytest.fixture(scope="module")
def containerfile():
    """The instructions of the Containerfile, without comments, each in one line."""
    text = re.sub(r"^#.*\n", "", (ROOT / "Containerfile").read_text("utf-8"), flags=re.MULTILINE)
    return text.replace("\\\n", " ").splitlines()


def test_binder_installs_hdrlab_with_a_python_that_it_allows(project):
    name, _, version = (BINDER / "runtime.txt").read_text("utf-8").strip().partition("-")
    assert name == "python" and version in SpecifierSet(project["requires-python"])
    lines = (BINDER / "requirements.txt").read_text("utf-8").splitlines()
    (installed,) = (line for line in lines if not line.startswith("#"))
    assert (ROOT / installed / "pyproject.toml").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="Binder runs Linux")
def test_binder_starts_the_server_with_hdrlabs_configuration(tmp_path):
    (tmp_path / "python").symlink_to(sys.executable)
    path = os.pathsep.join([str(tmp_path), os.environ["PATH"]])
    environment = {**os.environ, "PATH": path, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [BINDER / "start", "printenv", "JUPYTER_CONFIG_PATH"]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert Path(ran.stdout.strip()) == materials.JUPYTER


def test_the_configuration_names_an_extension_that_is_there_and_every_notebook():
    config = PyFileConfigLoader(
        "jupyter_server_config.py", path=str(materials.JUPYTER)
    ).load_config()
    (folder,) = config.LabServerApp.extra_labextensions_path
    package = json.loads((Path(folder) / "hdrlab/package.json").read_text("utf-8"))
    assert (Path(folder) / "hdrlab" / package["jupyterlab"]["_build"]["load"]).is_file()
    digests = config.ServerApp.tornado_settings["page_config_data"]["hdrlabCodeDigests"]
    assert len(set(digests)) == len(list(materials.folder("notebooks").glob("*.ipynb")))


def test_a_digest_covers_the_code_of_a_notebook_and_not_its_text(tmp_path, monkeypatch):
    monkeypatch.setattr(materials, "folder", lambda name: tmp_path)
    path = tmp_path / "one.ipynb"

    def digest(text, *codes):
        cells = [{"cell_type": "code", "source": [code]} for code in codes]
        cells.insert(0, {"cell_type": "markdown", "source": [text]})
        path.write_text(json.dumps({"cells": cells}), "utf-8")
        return materials.code_digests()

    assert digest("A title", "x = 1", "y = 2") == digest("Another", "x = 1", "y = 2")
    assert digest("A title", "x = 1", "y = 2") != digest("A title", "x = 1", "y = 3")
    assert digest("A title", "x = 1", "y = 2") != digest("A title", "x = 1\ny = 2")


def test_the_image_runs_commands_of_hdrlab(project, containerfile):
    (command,) = (line for line in containerfile if line.startswith("CMD"))
    first, _, server = json.loads(command.removeprefix("CMD"))[-1].partition(" && ")
    program, name, *options = shlex.split(first)
    assert program in project["scripts"] and name in cli.main.commands
    known = [option for knob in cli.main.commands[name].params for option in knob.opts]
    assert set(options) <= set(known)
    assert server == "exec jupyterhub-singleuser"


def test_the_image_has_what_the_strict_sandbox_needs_and_no_model_solutions(containerfile):
    (packages,) = (line for line in containerfile if "apt-get install" in line)
    assert {"bubblewrap", "libseccomp2"} <= set(packages.split())
    assert not [line for line in containerfile if line.startswith(("COPY", "ADD"))]


def test_the_dev_container_uses_a_stage_and_a_user_of_the_containerfile(project, containerfile):
    folder = ROOT / ".devcontainer"
    container = json.loads((folder / "devcontainer.json").read_text("utf-8"))
    build = container["build"]
    assert (folder / build["dockerfile"]).resolve() == (ROOT / "Containerfile").resolve()
    assert (folder / build["context"]).resolve() == ROOT.resolve()
    assert any(line.endswith(f" AS {build['target']}") for line in containerfile)
    assert any("useradd" in line and container["remoteUser"] in line for line in containerfile)
    extras = re.search(r"'\.\[(.+)\]'", container["postCreateCommand"])[1].split(",")
    assert set(extras) <= set(project["optional-dependencies"])
