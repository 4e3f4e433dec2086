"""Which module may import which: the layers of hdrlab, read from its source."""

import ast
import sys
from functools import cache
from pathlib import Path

import hdrlab

HOME = Path(hdrlab.__file__).parent
CHAPTERS = (
    "io",
    "capture",
    "align",
    "response",
    "calibration",
    "radiance",
    "tonemap",
    "enhance",
    "beyond",
)
BELOW = {"core": set(), "errors": set()}  # the folders that each folder may import
BELOW |= {chapter: {"core"} for chapter in CHAPTERS}
BELOW["fast"] = {"core", *CHAPTERS}
BELOW["diagnostics"] = {"core", *CHAPTERS}
BELOW["pipeline"] = {"core", *CHAPTERS, "fast", "diagnostics"}
BELOW["scenes"] = {"core", "io", "capture"}
BELOW["show"] = BELOW["pipeline"] | {"pipeline", "scenes"}
BELOW["course"] = BELOW["show"] | {"show"}
BELOW["demo"] = BELOW["show"] | {"show"}
BELOW["cli"] = BELOW["course"] | {"course", "demo"}
BELOW["__main__"] = {"cli"}
BELOW["__init__"] = set()

# the parts of the course: each imports only those before it; the extras may be left out
COURSE_PARTS = (
    "sanitize",
    "limits",
    "scratch",
    "materials",
    "jupyter",
    "source_code",
    "variants",
    "due_dates",
    "plan",
    "students",
    "sandbox",
    "checks",
    "submissions",
    "grading",
    "reports",
    "tutor",
    "notebook",
    "classroom",
    "authoring",
)
COURSE_EXTRAS = {  # extra -> the extras that it may use
    "projects": set(),
    "gallery": {"projects"},
    "similarity": set(),
    "viva": set(),
    "site": set(),
    "slides": {"site"},
    "question_bank": {"site", "slides"},
}
DEPRECATED_NAMES = {"code", "material"}  # they import the new names, and nothing imports them

ONLY_IN = {  # package -> rooms
    **dict.fromkeys(
        [
            "PIL",
            "imageio",
            "tifffile",
            "imagecodecs",
            "simplejpeg",
            "OpenEXR",
            "Imath",
            "rawpy",
            "gphoto2",
            "pillow",
        ],
        {"io"},
    ),
    **dict.fromkeys(["matplotlib", "ipywidgets", "anywidget", "traitlets"], {"show"}),
    "IPython": {"show", "course"},
    **dict.fromkeys(["click", "tqdm"], {"cli", "demo"}),
    **dict.fromkeys(["jupyterlab", "jupyterlab_server"], {"cli"}),
    **dict.fromkeys(
        ["nbformat", "nbclient", "sphinx", "numpydoc", "docutils", "ziamath", "latex2mathml"],
        {"course"},
    ),  # the site
    **dict.fromkeys(
        ["jupyterlite_pyodide_kernel", "jupyter_core", "packaging"], {"course"}
    ),  # notebooks that run on the site
    "pyseccomp": {"course"},  # the sandbox
    **dict.fromkeys(["pytest", "jupytext"], {"course"}),  # the checks, and the handouts
    "jinja2": {"show", "course"},
    **dict.fromkeys(["dask", "distributed"], {"course"}),  # a class on many machines
    "filelock": {"course"},  # one run at a time in a folder
    "cryptography": {"course"},  # signed receipts
    "copydetect": {"course"},  # what submissions have in common
    **dict.fromkeys(
        ["starlette", "uvicorn", "markupsafe", "markdown_it", "mdit_py_plugins"], {"course"}
    ),
    "threadpoolctl": {"show"},
}
OPTIONAL = ("hdrlab", "core", "optional")  # imports from it are imports of other packages
EVERYWHERE = {"numpy", "scipy", "skimage"}
NOWHERE = {"cv2", "colour_hdri", "hypothesis"}  # oracles and tools of the tests

# without the templates of an instructor's own task, which are no part of the package
FILES = sorted(path for path in HOME.rglob("*.py") if "new_task" not in path.parts)


def module(path):
    """Return the dotted parts of a file's module: ("hdrlab", "core", "arrays")."""
    parts = path.relative_to(HOME.parent).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" and len(parts) > 2 else parts


def is_module(parts):
    """Return whether these parts name a module of hdrlab, and not something inside one."""
    path = HOME.parent.joinpath(*parts)
    return path.is_dir() or path.with_suffix(".py").is_file()


@cache
def nodes_of(path):
    """Return what a file's tree consists of, read once for all promises."""
    return tuple(ast.walk(ast.parse(path.read_text(encoding="utf8"))))


def imports(path):
    """Yield (line, level, dotted parts) of every import of a file, those inside functions too."""
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, 0, tuple(alias.name.split("."))) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = tuple((node.module or "").split("."))
            for alias in node.names:
                if base == OPTIONAL:  # skimage_transform stands for skimage.transform
                    yield node.lineno, node.level, tuple(alias.name.split("_"))
                inner = (*base, alias.name)
                yield (
                    node.lineno,
                    node.level,
                    inner if base[0] == "hdrlab" and is_module(inner) else base,
                )


def wrong_in(path, level, target):
    """Return what is wrong with an import of a file, or nothing."""
    room = module(path)[1]
    if level:
        return "relatively"
    if target[0] == "hdrlab":
        used = target[1] if len(target) > 1 else "__init__"
        stands_on = f"but {room} stands on {', '.join(sorted(BELOW[room])) or 'nothing'}"
        return "" if used in BELOW[room] | {room, "__init__", "errors"} else stands_on
    if target[0] in ONLY_IN:
        belongs = f"which belongs to {', '.join(ONLY_IN[target[0]])}"
        return "" if room in ONLY_IN[target[0]] else belongs
    known = target[0] in EVERYWHERE or target[0] in sys.stdlib_module_names
    return "" if known and target[0] not in NOWHERE else "which nobody allowed"


def test_a_module_uses_the_layers_below_it_alone():
    assert {module(path)[1] for path in FILES} <= set(BELOW), "no room of the house"
    wrong_imports = [
        f"{path.relative_to(HOME)}:{line} imports {'.'.join(target)}, {wrong}"
        for path in FILES
        for line, level, target in imports(path)
        if (wrong := wrong_in(path, level, target))
    ]
    assert wrong_imports == []


def wrong_in_course(path, target):
    """Return what is wrong with an import of one part of the course by another, or nothing."""
    part = module(path)[2] if len(module(path)) > 2 else "__init__"
    if target[:2] != ("hdrlab", "course") or len(target) < 3 or part in DEPRECATED_NAMES:
        return ""
    used = target[2]
    if used == part:
        return ""
    if part in COURSE_EXTRAS:
        may_use = {*COURSE_PARTS, *COURSE_EXTRAS[part]}
    elif part in COURSE_PARTS:
        may_use = {*COURSE_PARTS[: COURSE_PARTS.index(part)]}
    else:
        return f"{part} is no part of the course"
    return "" if used in may_use else f"{part} comes before {used}"


def test_a_part_of_the_course_imports_only_the_parts_before_it():
    wrong_imports = [
        f"{path.relative_to(HOME)}:{line} imports {'.'.join(target)}: {wrong}"
        for path in FILES
        if module(path)[1] == "course"
        for line, _, target in imports(path)
        if (wrong := wrong_in_course(path, target))
    ]
    assert wrong_imports == []


def test_an_import_of_a_later_part_of_the_course_is_found():
    plan = HOME / "course/plan.py"
    assert wrong_in_course(plan, ("hdrlab", "course", "classroom", "jobs"))
    assert wrong_in_course(plan, ("hdrlab", "course", "gallery"))
    assert wrong_in_course(HOME / "course/viva/pages.py", ("hdrlab", "course", "site", "pages"))
    assert not wrong_in_course(plan, ("hdrlab", "course", "variants", "rewording"))


def test_an_import_of_another_layer_is_found():
    """What the promise above stands on: a file in a lower room, and what is wrong with its imports."""
    path = HOME / "radiance/merge.py"
    wrong = [
        ("hdrlab", "fast"),
        ("hdrlab", "tonemap", "durand"),
        ("matplotlib",),
        ("cv2",),
        ("torch",),
    ]
    assert all(wrong_in(path, 0, target) for target in wrong) and wrong_in(path, 1, ("core",))
    allowed = [("hdrlab", "core", "arrays"), ("hdrlab",), ("numpy",), ("functools",)]
    assert not any(wrong_in(path, 0, target) for target in allowed)


def test_the_reader_of_imports_finds_all_kinds_of_imports():
    """The reader of imports sees plain ones, those from a package, and those inside functions."""
    targets = {target for _, _, target in imports(HOME / "pipeline/corrections.py")}
    assert {
        ("numpy",),
        ("hdrlab", "radiance", "deghosting", "ghosts"),
        ("hdrlab", "radiance", "merge"),
    } <= targets
    assert ("imagecodecs",) in {target for _, _, target in imports(HOME / "io/codecs.py")}
    assert len(FILES) > 30


def test_a_module_below_the_screen_does_not_print():
    calls = [
        (path, node)
        for path in FILES
        if module(path)[1] not in ("cli", "__main__")
        for node in nodes_of(path)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    ]
    lines = [
        f"{path.relative_to(HOME)}:{node.lineno}" for path, node in calls if node.func.id == "print"
    ]
    assert lines == []
    assert len(calls) > 1000


def paths_into(nodes, folder):
    """Return the lines that name a folder as a path: an operand of `/`, an argument, or "folder/..."."""
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    operands = [
        part for node in nodes if isinstance(node, ast.BinOp) for part in (node.left, node.right)
    ]
    arguments = [part for node in nodes if isinstance(node, ast.Call) for part in node.args]
    parts = {id(part) for part in (*operands, *arguments)}
    texts = [
        node for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    return [
        text.lineno
        for text in texts
        if id(text) not in docstrings
        and (f"{folder}/" in text.value or text.value == folder and id(text) in parts)
    ]


def test_no_module_reads_the_tests():
    lines = [
        f"{path.relative_to(HOME)}:{line}"
        for path in FILES
        for line in paths_into(nodes_of(path), "tests")
    ]
    assert lines == []


def test_a_path_into_the_tests_is_found_however_it_is_written():
    for code in (
        'HERE / "tests"',
        'folder("tests")',
        'open("../tests/laws.py")',
        'f"{x}/tests/{y}"',
    ):
        assert paths_into(list(ast.walk(ast.parse(code))), "tests"), code
    assert not paths_into(list(ast.walk(ast.parse('{"tests": 3}'))), "tests")
