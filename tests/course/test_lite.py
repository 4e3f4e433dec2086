"""JupyterLite in the site: the files of its folder and their names.

`tests/wasm/test_lite_in_chromium.py` opens it in a browser.
"""

import json
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from hdrlab.course.site.lite import build, wheels
from hdrlab.errors import InputError

pytestmark = pytest.mark.skipif(
    any(find_spec(name) is None for name in ("jupyterlite_core", "jupyterlite_pyodide_kernel")),
    reason='JupyterLite needs pip install ".[lite]"',
)
ROOT = Path(__file__).parents[2]
ADDRESS = "https://example.org/pyodide"
SHEET = ROOT / "assignments" / "hw2.ipynb"
KERNEL_SETTINGS = "@jupyterlite/pyodide-kernel-extension:kernel"


@pytest.fixture(scope="module")
def wheels_by_name(tmp_path_factory):
    """The wheels for the browser, by the name of the package."""
    written = wheels.write_wheels(tmp_path_factory.mktemp("wheels"))
    return {path.name.partition("-")[0]: path for path in written}


def test_a_notebook_that_changes_is_in_another_edition(tmp_path):
    notebook = tmp_path / "one.ipynb"
    notebook.write_text("{}")
    first = build.edition_of([notebook], [])
    assert build.edition_of([notebook], []) == first
    notebook.write_text('{"cells": []}')
    assert build.edition_of([notebook], []) != first


def test_wheels_have_all_that_check_needs_and_nothing_that_is_compiled(wheels_by_name):
    assert {"hdrlab", "pytest", "ipywidgets", "anywidget", "jinja2"} <= set(wheels_by_name)
    assert not {"numpy", "scipy", "jupyterlab", "imagecodecs", "openexr"} & set(wheels_by_name)
    for path in wheels_by_name.values():
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
        assert not [name for name in names if name.endswith((".so", ".pyd", ".pyc"))]
        assert [name for name in names if name.endswith(".dist-info/METADATA")], path.name
    with zipfile.ZipFile(wheels_by_name["hdrlab"]) as archive:
        assert "hdrlab/course/assignments/hw2.ipynb" in archive.namelist()


def test_a_wheel_whose_content_changes_has_another_digest_and_otherwise_the_same(
    wheels_by_name, tmp_path
):
    before = wheels.digest_of(list(wheels_by_name.values()))
    again = wheels.write_wheels(tmp_path)
    assert wheels.digest_of(again) == before
    with zipfile.ZipFile(again[0], "a") as archive:
        archive.writestr("hdrlab/new.py", "")
    assert wheels.digest_of(again) != before


def write_pyodide(folder, version="0.27.7", **changes):
    """Write a folder with the files of Pyodide, of which one package needs another."""
    packages = {
        "numpy": {"file_name": "numpy.whl", "depends": ["Open_Blas"]},
        "open-blas": {"file_name": "blas.zip", "depends": []},
        "pandas": {"file_name": "pandas.whl", "depends": ["numpy"]},
    }
    folder.mkdir()
    for package in packages.values():
        # the SHA-256 of an empty file
        package["sha256"] = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
        (folder / package["file_name"]).touch()
    for name in build.CORE_FILES:
        (folder / name).touch()
    lock = {"info": {"version": version}, "packages": packages}
    (folder / "pyodide-lock.json").write_text(json.dumps(lock))
    return folder


def test_a_folder_without_pyodide_or_with_another_version_is_refused_with_a_message(tmp_path):
    with pytest.raises(InputError, match=r"no Pyodide in .*pyodide\.js"):
        build.find_pyodide(str(tmp_path))
    other = write_pyodide(tmp_path / "other", version="0.29.0")
    with pytest.raises(InputError, match=r"needs Pyodide 0\.27.* has 0\.29\.0"):
        build.find_pyodide(str(other))


def test_pyodide_may_be_at_an_address():
    pyodide = build.find_pyodide(ADDRESS)
    assert (pyodide.url, pyodide.folder) == (f"{ADDRESS}/pyodide.js", None)


@pytest.mark.notebooks
@pytest.mark.skipif(find_spec("myst_nb") is None, reason='the site needs pip install ".[site]"')
def test_a_page_of_a_notebook_opens_it_in_jupyterlite_and_other_pages_have_no_button(tmp_path):
    from sphinx.application import Sphinx

    from hdrlab.course.site.sphinx import SETTINGS

    source = tmp_path / "source"
    (source / "assignments").mkdir(parents=True)
    (source / "assignments" / "hw2.ipynb").write_bytes(SHEET.read_bytes())
    toctree = "```{toctree}\nassignments/hw2\n```\n"
    (source / "index.md").write_text(f"# First page\n\nA text.\n\n{toctree}")
    html = tmp_path / "html"
    settings = SETTINGS | {"html_context": {"edition": "0123abcd"}}
    Sphinx(source, None, html, tmp_path / "notes", "html", settings, status=None).build()
    page = (html / "assignments" / "hw2.html").read_text("utf-8")
    path = "0123abcd/assignments/hw2.ipynb"
    assert f'href="../lite/notebooks/index.html?path={path}"' in page
    assert f'href="../lite/files/{path}" download' in page
    assert 'src="../_static/lite.js' in page
    assert "Run this page" not in (html / "index.html").read_text("utf-8")


@pytest.mark.notebooks
def test_a_site_without_requests_elsewhere_has_its_notebooks_packages_and_pyodide(tmp_path):
    out = tmp_path / "site"
    out.mkdir()
    pyodide = build.find_pyodide(str(write_pyodide(tmp_path / "pyodide")))
    assert "scikit-image" in pyodide.lacking, "what notebooks may miss is reported"
    build.build(out, tmp_path, [], [SHEET], pyodide)
    lite = out / "lite"
    edition = build.edition_of([], [SHEET])
    copy = lite / "files" / edition / "assignments" / "hw2.ipynb"
    assert copy.read_bytes() == SHEET.read_bytes()
    listing = lite / "api" / "contents" / edition / "assignments" / "all.json"
    assert [file["name"] for file in json.loads(listing.read_text())["content"]] == ["hw2.ipynb"]

    config = json.loads((lite / "jupyter-lite.json").read_text())["jupyter-config-data"]
    kernel = config["litePluginSettings"][KERNEL_SETTINGS]
    assert kernel["disablePyPIFallback"]
    assert "://" not in json.dumps([kernel, config["federated_extensions"]])
    assert (lite / kernel["pyodideUrl"]).is_file()
    worker = lite / "extensions" / "@jupyterlite" / "pyodide-kernel-extension" / "static"
    packages = kernel["loadPyodideOptions"]["packages"]
    wheel_paths = [worker / name for name in packages if name.endswith(".whl")]
    assert len(wheel_paths) > 10
    assert all(path.resolve().is_file() for path in wheel_paths)
    # what notebooks need, and nothing else
    assert {path.name for path in (lite / "pyodide").glob("*.*")} == {
        *build.CORE_FILES,
        "pyodide-lock.json",
        "numpy.whl",
        "blas.zip",
    }

    before = copy.stat().st_mtime_ns
    build.build(out, tmp_path, [], [SHEET], pyodide)
    assert copy.stat().st_mtime_ns == before, "what is unchanged is not built again"
