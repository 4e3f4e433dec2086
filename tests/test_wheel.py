"""An installed wheel can do all that a clone can."""

import os
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
pytestmark = [
    pytest.mark.wheel,
    pytest.mark.skipif(
        not (ROOT / "pyproject.toml").exists(),
        reason="builds the wheel from a clone, and this is an installed package",
    ),
]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    out = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", out, ROOT]
    subprocess.run(command, check=True, capture_output=True)
    return next(out.glob("hdrlab-*.whl"))


IN = (
    "hdrlab/py.typed",
    "hdrlab/scenes/chapel.exr",
    "hdrlab/scenes/tripod/LICENSE",
    "hdrlab/scenes/tripod/img-1.jpeg",
    "hdrlab/scenes/window/LICENSE",
    "hdrlab/scenes/window/README.md",
    "hdrlab/scenes/window/window-01.jpeg",
    "hdrlab/course/plan.toml",
    "hdrlab/course/checks/specification/test_gsolve.py",
    "hdrlab/course/checks/mistakes/gsolve.py",
    "hdrlab/course/variants/parameters/shift.toml",
    "hdrlab/course/gallery/web/templates/base.html",
    "hdrlab/course/slides/deck.html",
    "hdrlab/course/slides/reveal/LICENSE",
    "hdrlab/course/slides/reveal/reveal.js",
    "hdrlab/show/widgets/blink.js",
)
OUT = ("tests", "attacks", "equivalent", "solutions", "benchmarks", "models", ".ci")


def test_the_wheel_holds_the_package_notebooks_and_handouts_and_nothing_else(wheel):
    held = [name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name]
    files = [
        path for path in (ROOT / "hdrlab").rglob("*") if path.is_file() and path.suffix != ".pyc"
    ]
    expected = {path.relative_to(ROOT).as_posix() for path in files}
    for folder in ("notebooks", "assignments"):
        expected |= {
            f"hdrlab/course/{folder}/{path.name}" for path in (ROOT / folder).glob("*.ipynb")
        }
    assert set(held) == expected and expected.issuperset(IN)
    parts = {part for name in held for part in name.split("/")}
    assert not parts.intersection(OUT)


def test_the_wheel_carries_no_attack_and_no_full_answer(wheel):
    """No file of it is one of the tests' own, under whatever name."""
    kept = [ROOT / "tests/attacks", ROOT / "tests/equivalent", ROOT / "scenes"]
    foreign = {path.read_bytes() for folder in kept for path in folder.rglob("*.py")} - {b""}
    opened = zipfile.ZipFile(wheel)
    assert not [name for name in opened.namelist() if opened.read(name) in foreign]


def test_neither_the_wheel_nor_the_source_distribution_holds_a_model_solution(wheel, tmp_path):
    """The worked sheets are in the clone; a pack of them is written on asking, by `hdrlab course pack`."""
    command = [
        sys.executable,
        "-m",
        "build",
        "--sdist",
        "--no-isolation",
        "--outdir",
        tmp_path,
        ROOT,
    ]
    subprocess.run(command, check=True, capture_output=True)
    with tarfile.open(next(tmp_path.glob("hdrlab-*.tar.gz"))) as sdist:
        held = sdist.getnames() + zipfile.ZipFile(wheel).namelist()
    assert any(name.endswith("course/authoring/solutions.py") for name in held)
    answers = ("/solutions/", "/exercises/", "/fairness/right/", "/tests/equivalent/")
    assert not [name for name in held if any(folder in name for folder in answers)]


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
        "assert list(materials.folder('assignments').glob('*.ipynb'))\n"
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
