"""Write what the pages load in a browser: only what checks and photos need, so that they start fast.

The boxes "Try it" and the page for a reader's own photos load it with `theme/static/python_loader.js`.

lite/try.json              where Pyodide and the checks are, and how many bytes each part has
lite/try/checks-DIGEST.zip hdrlab without its photos, with pytest and Jinja for checks and feedback
"""

import hashlib
import io
import json
import zipfile
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement

from hdrlab.course.site.lite import wheels

# of Pyodide: what each check needs, and what draws the differences between two answers
PACKAGES = ("numpy", "pillow")
FIGURES = "matplotlib"
# packages of PyPI that run checks and write the feedback
RUNNERS = ("pytest", "jinja2")
# of scenes, guides and cards, which no check reads
MEDIA_SUFFIXES = (".exr", ".jpeg", ".webp", ".hdr", ".js", ".css", ".md")


def write(folder: Path, pyodide_url: str, sizes: dict[str, int]) -> None:
    """Write try.json and the checks into the folder lite."""
    archive = pack()
    digest = hashlib.sha256(archive).hexdigest()[:12]
    name = f"try/checks-{digest}.zip"
    (folder / "try").mkdir()
    (folder / name).write_bytes(archive)
    if sizes:
        sizes = sizes | {"start": sizes["start"] + len(archive)}
    manifest = {
        "pyodide": pyodide_url,
        "code": name,
        "packages": PACKAGES,
        "figures": FIGURES,
        "bytes": sizes,
    }
    (folder / "try.json").write_text(json.dumps(manifest, indent=1), "utf8")


def pack() -> bytes:
    """Return a ZIP file with the modules that check a function and write the feedback."""
    files = {
        name: content
        for name, content in wheels.files_of_hdrlab().items()
        if not name.endswith(MEDIA_SUFFIXES) and not name.startswith("hdrlab/course/notebooks/")
    }
    for distribution in _runners():
        files |= wheels.files_of_distribution(distribution)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in sorted(files.items()):
            info = zipfile.ZipInfo(name, wheels.DATE)
            archive.writestr(info, content, zipfile.ZIP_DEFLATED, compresslevel=9)
    return packed.getvalue()


def _runners() -> list[metadata.Distribution]:
    """Return the installed distributions that run checks, with those that they need."""
    found: dict[str, metadata.Distribution] = {}
    names = list(RUNNERS)
    while names:
        name = names.pop()
        if name in found:
            continue
        found[name] = metadata.distribution(name)
        for text in found[name].requires or ():
            requirement = Requirement(text)
            if requirement.marker is None or requirement.marker.evaluate(wheels.BROWSER):
                names.append(requirement.name.lower())
    return list(found.values())
