"""An installed wheel does all that a clone does."""

import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.skipif(
    not (ROOT / "pyproject.toml").exists(),
    reason="builds the wheel from a clone, and this is an installed package",
)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    out = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    return next(out.glob("hdrlab-*.whl"))


def test_notebooks_specification_scripts_and_types_travel_in_the_wheel(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    assert not any("solutions" in name for name in names)
    for folder, pattern in [("notebooks", "*.ipynb"), ("assignments", "*.ipynb"), ("tests", "**/*.py")]:
        for file in (ROOT / folder).glob(pattern):
            assert f"hdrlab/course/{folder}/{file.relative_to(ROOT / folder).as_posix()}" in names
    for file in (ROOT / "hdrlab").rglob("*"):
        if file.is_file() and file.suffix != ".pyc":
            assert file.relative_to(ROOT).as_posix() in names


def installed(wheel, tmp_path, words):
    """Run a command of an environment that holds the wheel alone, and return the folder it ran in.

    What hdrlab depends on is lent by the environment of the tests.
    """
    venv.create(tmp_path / "env", with_pip=False, symlinks=True)
    python = next((tmp_path / "env").glob("[bS]*/python*"))
    site = next((tmp_path / "env").rglob("site-packages"))
    zipfile.ZipFile(wheel).extractall(site)
    lent = [path for path in sys.path if path.endswith("site-packages")]
    code = (
        f"import sys; sys.path += {lent!r}\n"
        "import hdrlab; from hdrlab import cli; from hdrlab.course import materials\n"
        f"assert hdrlab.__file__.startswith({str(site)!r}), hdrlab.__file__\n"
        "assert list(materials.folder('notebooks').glob('*.ipynb'))\n"
        "assert (materials.folder('tests') / 'laws.py').exists()\n"
        f"cli.run({words!r})"
    )
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    ran = subprocess.run(
        [python, "-I", "-c", code], cwd=elsewhere, env=environment, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    return elsewhere


def test_the_installed_wheel_runs_the_demo_from_another_folder(wheel, tmp_path):
    elsewhere = installed(wheel, tmp_path, ["demo", "--out", "results"])
    assert (elsewhere / "results" / "report.html").exists()


def test_the_installed_wheel_makes_the_toy_class_from_another_folder(wheel, tmp_path):
    elsewhere = installed(wheel, tmp_path, ["course", "toy", "class"])
    assert len(list((elsewhere / "class" / "submissions").iterdir())) == 12
