"""The reading list of the site: each paper once, with a DOI and a sentence. No test asks the network."""

import re
from pathlib import Path

import pytest

import hdrlab

PAGE = Path(hdrlab.__file__).parent / "course/site/pages/reading.md"
TEXT = PAGE.read_text(encoding="utf8")
DOI = re.compile(r"10\.\d{4,9}/[-._;()/:A-Za-z0-9]+")
PAPERS = [" ".join(item.split()) for item in re.findall(r"^- ((?:.+\n)(?:  .+\n)*)", TEXT, re.M)]


def test_the_list_has_some_thirty_papers():
    assert 25 <= len(PAPERS) <= 40


@pytest.mark.parametrize("paper", PAPERS, ids=lambda paper: paper[:40])
def test_a_paper_has_authors_a_linked_title_a_year_and_a_sentence(paper):
    match = re.fullmatch(
        r"[A-Z].*?, \[[^\]]+\]\(https://doi\.org/(\S+)\),(?: .*?)? (?:19|20)\d\d\. ([A-Z].*\.)",
        paper,
    )
    assert match and DOI.fullmatch(match[1])
    assert len(match[2].split()) >= 5


def test_each_doi_is_written_in_full_and_stands_once():
    addresses = re.findall(r"\]\((http[^)]*)\)", TEXT)
    assert all(re.fullmatch(r"https://doi\.org/" + DOI.pattern, address) for address in addresses)
    assert len(addresses) == len({address.lower() for address in addresses}) == len(PAPERS) + 1


def test_each_section_says_which_notebooks_come_before_it():
    sections = re.split(r"^## ", TEXT, flags=re.M)[1:]
    assert len(sections) >= 6
    root = Path(hdrlab.__file__).parents[1]
    for section in sections:
        names = re.findall(r"\]\((notebooks/\w+\.ipynb)\)", section)
        assert names, section.splitlines()[0]
        if (root / "notebooks").is_dir():
            assert all((root / name).exists() for name in names)
