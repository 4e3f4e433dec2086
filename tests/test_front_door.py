"""Commands, options, files, versions and tiers that README, guides and workflows name exist."""

import re
import shlex
import tomllib
from pathlib import Path

import click
import pytest
import yaml
from PIL import Image
from tiers import QUICK, TIERS

import hdrlab
from hdrlab import cli

ROOT = Path(__file__).resolve().parents[1]
PAGES = ROOT / "hdrlab/course/site/pages"
README = ROOT / "README.md"
GUIDES = [README, ROOT / "CONTRIBUTING.md", *sorted(PAGES.glob("*.md"))]
WORKFLOWS = sorted((ROOT / ".github").rglob("*.yml")) if README.exists() else []
pytestmark = pytest.mark.skipif(
    not README.exists(), reason="reads a clone, and this is an installed package"
)


def text_of(path):
    return path.read_text(encoding="utf8")


def typed(path):
    """Return the hdrlab commands of a page, those of its listings and those in running text, as words."""
    text = text_of(path)
    lines = [
        line for block in re.findall(r"```sh\n(.*?)```", text, re.S) for line in block.splitlines()
    ]
    lines += re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.S))
    parts = [part for line in lines for part in re.split(r"&&|#", line)]
    pattern = r"\s*(?:[$] )?(?:env/bin/|uvx --from \. )?hdrlab (.+)"
    matches = [re.match(pattern, part) for part in parts]
    return [shlex.split(match[1].split(" -- ")[0].replace("...", "")) for match in matches if match]


def command_of(words):
    """Return the command of these words, and those that are left for it."""
    command = cli.main
    while isinstance(command, click.Group) and words and not words[0].startswith("-"):
        assert words[0] in command.commands, f"there is no command {words[0]!r}"
        command = command.commands[words[0]]
        words = words[1:]
    return command, words


def options_of(command):
    return {option for knob in command.params for option in (*knob.opts, *knob.secondary_opts)} | {
        "--help",
        "--version",
    }


@pytest.mark.parametrize("path", GUIDES, ids=lambda path: path.name)
def test_each_command_and_option_that_a_page_names_is_there(path):
    for words in typed(path):
        command, rest = command_of(words)
        unknown = {
            word.partition("=")[0] for word in rest if re.match(r"--?[a-z]", word)
        } - options_of(command)
        assert not unknown, f"hdrlab {' '.join(words)}"


def test_commands_are_read_from_listings_and_from_running_text():
    assert [
        "assemble",
        "photos/",
        "-o",
        "room.hdr",
        "--picture",
        "room.png",
        "--report",
        "room/",
    ] in typed(README)
    assert len(typed(PAGES / "grading.md")) > 5


def test_the_table_of_commands_names_every_one_once():
    table = re.findall(r"^\| (`hdrlab .*?) \|", text_of(PAGES / "commands.md"), re.M)
    named = [
        re.match(r"hdrlab (\w+)", code)[1]
        for row in table
        for code in re.findall(r"`([^`]+)`", row)
    ]
    hidden = {"doctor", "course"}  # in a row of grade, and in the section for those who teach
    assert sorted(named) == sorted(set(cli.main.commands) - hidden)


def test_the_table_of_promises_names_tests_that_there_are():
    there = {path.name for path in (ROOT / "tests").rglob("*")}
    rows = "".join(re.findall(r"^\|.*$", text_of(ROOT / "SECURITY.md"), re.MULTILINE))
    named = set(re.findall(r"`(?:tests/)?(?:\w+/)*(test_\w+\.py)`", rows))
    assert len(named) > 20 and not named - there


def test_every_function_on_the_map_is_there():
    names = [
        name
        for line in hdrlab.__doc__.splitlines()
        if "  " in line
        for name in re.split(r"[,;] ", line[39:])
    ]
    names = [name for name in names if re.fullmatch(r"[\w.]+", name) and "." in name]
    assert len(names) > 40
    for name in names:
        place = ROOT.joinpath("hdrlab", *name.split("."))
        if not (place.is_dir() or place.with_suffix(".py").is_file()):
            assert re.search(rf"\b{place.name}\b", text_of(module_file(place.parent))), name


def module_file(place):
    return place.with_suffix(".py") if place.with_suffix(".py").is_file() else place / "__init__.py"


def test_links_between_the_pages_of_the_repository_lead_somewhere():
    for path in (README, ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", ROOT / "CHANGELOG.md"):
        links = re.findall(r"\]\(([^)#:]+)\)", text_of(path))
        local = [link for link in links if not link.startswith("../../actions/")]
        assert not [link for link in local if not (path.parent / link).exists()]
        named = {
            link.split("/")[4] for link in links if link.startswith("../../actions/workflows/")
        }
        assert named <= {workflow.name for workflow in WORKFLOWS}


def test_one_version_stands_in_the_package_the_changes_and_the_citation():
    citation = yaml.safe_load(text_of(ROOT / "CITATION.cff"))
    newest = re.search(r"^## (\d.+)$", text_of(ROOT / "CHANGELOG.md"), re.M)[1]
    assert hdrlab.__version__ == newest == citation["version"]
    licenses = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]["license"].split(" AND ")
    assert citation["license"] == licenses[0]  # the code's; others are those of photos


def test_the_moving_picture_of_the_readme_moves_and_is_small():
    path = ROOT / "README.webp"
    with Image.open(path) as film:
        assert (
            path.name in text_of(README) and film.n_frames > 20 and path.stat().st_size < 1_000_000
        )


def test_the_workflows_run_every_tier_and_the_quick_one_on_three_systems():
    jobs = yaml.safe_load(text_of(ROOT / ".github/workflows/ci.yml"))["jobs"]
    assert set(jobs["tiers"]["strategy"]["matrix"]["tier"]) == set(TIERS) - {QUICK}
    systems = {job.partition("-")[0] for job in jobs["quick"]["strategy"]["matrix"]["os"]}
    assert (
        systems == {"ubuntu", "windows", "macos"}
        and {"run": f"nox -s {QUICK}"} in jobs["quick"]["steps"]
    )


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_may_do_no_more_than_it_needs(path):
    read = yaml.safe_load(text_of(path))
    if path.parent.name == "workflows":
        assert read["permissions"] == {"contents": "read"}
        assert all("timeout-minutes" in job for job in read["jobs"].values())
        assert "secrets." not in text_of(path)
