"""The report on a wide screen and on a phone."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline
from hdrlab.core.bracket import bracket
from hdrlab.show.pages.report import write_report

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    ramp = np.linspace(2, 110, 200 * 300).reshape(200, 300).astype(np.uint8)
    names = [
        "a_long_name_of_a_photograph_" * 3 + ".jpg",
        "averylongnamewithoutanyplacetobreakit" * 3 + ".jpg",
    ]
    assembly = pipeline.assemble(
        bracket([ramp, 2 * ramp], [1 / 8000, 1 / 4000], names), align="none", response="linear"
    )
    assembly = replace(
        assembly, warnings=(f"{names[1]} may be wrong",), notes=(f"{names[0]} is dark",)
    )
    return write_report(tmp_path_factory.mktemp("report"), assembly, pipeline.develop(assembly.E))


@pytest.mark.parametrize("width", [1280, 400])
def test_the_report_fits_the_screen_and_asks_for_nothing(report, page, width):
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(report.as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert [request for request in page.requests if not request.startswith("data:")] == [
        report.as_uri()
    ]
    assert page.problems == []


def test_every_picture_of_the_report_is_decoded(report, page):
    page.goto(report.as_uri())
    sizes = page.evaluate(
        "[...document.images].map((image) => image.complete && image.naturalWidth)"
    )
    assert len(sizes) == 5 and all(sizes)


def test_no_text_of_the_report_is_smaller_than_a_telephone_can_show(report, page):
    page.set_viewport_size({"width": 400, "height": 900})
    page.goto(report.as_uri())
    smallest = page.evaluate(
        """Math.min(...[...document.body.querySelectorAll('*')]
            .filter((el) => [...el.childNodes].some((node) => node.nodeType === 3 && node.data.trim()))
            .map((el) => parseFloat(getComputedStyle(el).fontSize)))"""
    )
    assert smallest >= 13


def test_the_report_is_dark_where_its_reader_likes_it_dark_and_axe_finds_nothing_wrong(
    report, page, axe
):
    page.emulate_media(color_scheme="dark")
    page.goto(report.as_uri())
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(20, 24, 30)"
    assert axe(page, "html") == []
