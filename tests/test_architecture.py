"""ARCHITECTURE.md names only files that exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "ARCHITECTURE.md"
pytestmark = pytest.mark.skipif(
    not PAGE.exists(), reason="reads a clone, and this is an installed package"
)


def named():
    """Return the files and folders that the page names from the top of the repository."""
    text = PAGE.read_text(encoding="utf8")
    return sorted(set(re.findall(r"\b(?:hdrlab|tests|solutions|scenes)/[\w/]+(?:\.\w+)?", text)))


@pytest.mark.parametrize("name", named() if PAGE.exists() else [])
def test_a_file_that_the_page_names_is_there(name):
    assert (ROOT / name).exists()


def test_both_walks_through_the_code_name_more_than_a_dozen_files():
    walks = re.findall(r"## Follow.*?\n```\n(.*?)```", PAGE.read_text(encoding="utf8"), re.DOTALL)
    assert [len(set(re.findall(r"[\w/]+\.py", text))) > 12 for text in walks] == [True, True]


def test_every_folder_of_the_package_is_on_the_page():
    text = PAGE.read_text(encoding="utf8")
    rooms = [path.name for path in (ROOT / "hdrlab").iterdir() if (path / "__init__.py").exists()]
    assert not [room for room in rooms if not re.search(rf"\b{room}\b", text)]


def test_the_map_of_the_package_fits_one_screen_with_the_lectures_of_the_course_first():
    import hdrlab

    lines = hdrlab.__doc__.splitlines()
    first, second = [number for number, line in enumerate(lines) if line.startswith("---")]
    assert len(lines) <= 36 and second - first > 12
    course = "\n".join(lines[first:second])
    for paper in (
        "mtb",
        "debevec",
        "robertson",
        "mitsunaga",
        "merge",
        "ward",
        "chiu",
        "durand",
        "reinhard",
        "fattal",
    ):
        assert f".{paper}." in course
