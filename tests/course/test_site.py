"""`hdrlab site`: the pages that it makes of notebooks, and its messages about notebooks that fail."""

import ast
import base64
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from html.parser import HTMLParser
from importlib.util import find_spec
from itertools import combinations
from pathlib import Path

import nbformat
import numpy as np
import pytest
from support.missing_environment import ENVIRONMENTS, turn_clock_back

from hdrlab import pipeline, scenes
from hdrlab.course.site import live, pages as build, reference
from hdrlab.diagnostics import causes, warning_texts
from hdrlab.io import web
from hdrlab.io.photos import read_bracket, write_picture
from hdrlab.io.web import decode_picture
from hdrlab.show import pictures
from hdrlab.show.plots import curves, tones

NEEDS = ("sphinx", "myst_nb", "numpydoc", "ziamath")
pytestmark = [
    pytest.mark.notebooks,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in NEEDS),
        reason='the site needs pip install ".[site]"',
    ),
]
REFUSED = ("one photograph", "times the other way round", "two sizes")
ADDRESS = "https://example.org/course"
NOTEBOOKS = Path(__file__).parents[2] / "notebooks"
PATIENCE = 1800  # seconds: what hangs ends; a machine may be as busy as it likes

PLAYED = """import numpy as np
from hdrlab.show import widgets
from hdrlab.tonemap import ward
squares = [np.full((40, 60), 50 * k, np.uint8) for k in range(5)]
widgets.play(squares, lambda square: square, alt="A square, ever lighter")"""
BRUSHED = """import numpy as np
from hdrlab.show import pictures, widgets
E = np.geomspace(1, 1e6, 320)[None] * np.ones((240, 1))
widgets.brush(E, alt="A wedge, ever brighter", size=64)"""
SHOWN = """pictures.radiance(E, alt="The wedge in false colour")"""


def notebook(path, title, *cells):
    """Write a notebook with a title, a formula, a link to another notebook, and cells of code."""
    words = (
        f"# {title}\n\nRun the cells from the top. So $g(Z) = \\ln E$, see [one](01_one.ipynb) and "
        "[three](03_three.ipynb). Read the guide *Installing*, and the guide *Unknown*.\n\n$$x^2$$"
    )
    made = nbformat.v4.new_notebook(
        metadata={"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    )
    made.cells = [nbformat.v4.new_markdown_cell(words, id="title")]
    made.cells += [nbformat.v4.new_code_cell(cell, id=f"cell-{k}") for k, cell in enumerate(cells)]
    for cell in made.cells:
        cell.metadata = {"jupyter": {"source_hidden": True}} if cell.source == SHOWN else {}
    nbformat.write(made, path)
    return path


def command(out, *notebooks):
    return [
        *(sys.executable, "-m", "hdrlab", "site", "--out", str(out), "--address", ADDRESS),
        *(word for notebook in notebooks for word in ("--notebooks", str(notebook))),
    ]


def run(out, *notebooks, folder, **environment):
    words = command(out, *notebooks)
    env = os.environ | environment
    return subprocess.run(
        words, cwd=folder, env=env, capture_output=True, text=True, timeout=PATIENCE
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A site of four notebooks, one without a title and pictures: (folder, site, notebooks, output). It
    is made in an environment in which much is missing.
    """
    folder = tmp_path_factory.mktemp("made") / "site"
    folder.mkdir()
    notebooks = [
        notebook(folder / "01_one.ipynb", "01 · Steps", PLAYED),
        notebook(folder / "02_two.ipynb", "02 · Light", BRUSHED, SHOWN),
        notebook(folder / "03_gone.ipynb", "03 · Gone", PLAYED),
        notebook(folder / "plain.ipynb", "Plain", "%matplotlib inline", "1 + 1"),
    ]
    text = notebooks[-1].read_text("utf-8")
    notebooks[-1].write_text(text.replace("# Plain", "Plain & simple"), "utf-8")
    poor = (
        ENVIRONMENTS["no caches"] | ENVIRONMENTS["LANG=C"] | {"PYTHONPATH": turn_clock_back(folder)}
    )
    ran = run("site", *notebooks, folder=folder, **poor)
    assert ran.returncode == 0, ran.stderr
    return folder, folder / "site", notebooks, ran


@pytest.fixture(scope="module")
def page_addresses(made):
    """The addresses in each page of the site."""
    return pages(made[1])


def test_a_link_leads_to_what_the_site_has_and_is_plain_text_otherwise():
    text = (
        "[a](../assignments/hw1.ipynb) [b](04_x.ipynb) [c](05_y.ipynb) [d](../assignments/x.ipynb)"
    )
    assert (
        build.unlink_missing_notebooks(text, {"hw1", "04_x"})
        == "[a](../assignments/hw1.ipynb) [b](04_x.ipynb) c d"
    )


class Addresses(HTMLParser):
    """The resources and links of a page, and its pictures without alt text."""

    def __init__(self, text):
        super().__init__()
        self.asked = []
        self.links = []
        self.silent = []
        self.headings = []
        self.anchors = set()
        self.told = {}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if tag in ("img", "script", "iframe", "source", "video", "audio") and "src" in attributes:
            self.asked.append(attributes["src"])
        if tag == "link" and attributes["rel"] not in ("next", "prev"):
            self.asked.append(attributes["href"])
        if "id" in attributes:
            self.anchors.add(attributes["id"])
        if tag == "meta" and "content" in attributes:
            self.told[attributes.get("name") or attributes.get("property")] = attributes["content"]
        if tag == "a" and "href" in attributes:
            self.links.append(attributes["href"])
        if tag == "img" and "alt" not in attributes:
            self.silent.append(attrs)
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))


def pages(site):
    return {page: Addresses(page.read_text("utf-8")) for page in site.rglob("*.html")}


def test_a_site_is_made_in_its_folder_and_its_cache_also_where_caches_signs_and_a_clock_are_lacking(
    made,
):
    folder, site, notebooks, ran = made
    # on what they lack
    of_others = (
        "mkdir -p failed",
        "Matplotlib created",
        "IPython parent",
        "warn(",
    )
    assert [
        line for line in ran.stderr.splitlines() if not any(word in line for word in of_others)
    ] == []
    assert "4 notebooks; run now: 5" in ran.stdout, "the story is run, too"
    assert sorted(folder.iterdir()) == sorted([site, folder / ".site.cache", *notebooks])
    assert not list((folder / ".site.cache" / "kernels").iterdir())
    assert not [path for path in folder.rglob("*") if path.name.startswith((".hdrlab-", "tmp"))]
    assert all(notebook.stat().st_mtime == 4e9 for notebook in notebooks), "a notebook was written"


def test_the_folder_of_a_site_holds_the_site_alone_and_is_served_as_it_is(made):
    site = made[1]
    parts = {path.name for path in site.iterdir()} - {page.name for page in site.glob("*.html")}
    folders = {"notebooks", "reference", "teachers_sheets"}
    folders |= {"_images", "_modules", "_static", "_widgets"}
    assert parts == folders | {"searchindex.js", "objects.inv", ".nojekyll"}
    assert {path.name for path in site.rglob(".*")} == {".nojekyll"}
    kinds = [".html", ".js", ".css", ".svg", ".png", ".jpg", ".jpeg", ".webp", ".inv"]
    assert {path.suffix for path in site.rglob("*") if path.is_file()} <= {*kinds, ""}


def test_a_page_has_a_description_and_an_image_for_link_previews(made):
    site = made[1]
    metadata = Addresses((site / "index.html").read_text("utf-8")).told
    assert len(metadata["description"]) > 40
    assert metadata["og:image"] == f"{ADDRESS}/_static/preview.jpg"
    preview = decode_picture((site / "_static" / "preview.jpg").read_bytes())
    middle = preview.shape[1] // 2
    above = preview[int(0.08 * len(preview)) : int(0.2 * len(preview))]
    sky = above[:, middle - 60 : middle - 10], above[:, middle + 10 : middle + 60]
    assert preview.shape[1] >= 600
    assert sky[0].mean() > 245, "the photo at the left is clipped in the window"
    assert sky[1][..., 0].mean() < 215, "the image at the right shows a blue sky"
    for page in ("verdicts", "commands", "reference/tonemap.chiu"):
        metadata = Addresses((site / f"{page}.html").read_text("utf-8")).told
        assert 40 < len(metadata["description"]) <= 200, page


def test_no_page_asks_for_anything_outside_and_what_it_asks_for_is_there(page_addresses):
    assert len(page_addresses) > 100
    for page, addresses in page_addresses.items():
        for address in addresses.asked:
            if not address.startswith("data:"):
                assert not re.match(r"\w+:|//", address), f"{page.name}: {address}"
                assert (page.parent / address.partition("?")[0]).is_file(), (
                    f"{page.name}: {address}"
                )


def test_style_sheets_and_scripts_name_no_address_outside(made):
    codes = set((made[1] / "_widgets").glob("code-*.js"))
    for file in [*(made[1] / "_static").glob("*.css"), *(made[1] / "_widgets").glob("*.js")]:
        text = file.read_text(
            "utf-16" if file.parent.name == "_widgets" and file not in codes else "utf-8"
        )
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
        # a name, which nothing is fetched from
        text = text.replace("http://www.w3.org/2000/svg", "")
        assert not re.search(r"@import|url\(\s*['\"]?(?!data:)|https?://", text), file.name


def test_every_link_within_the_site_leads_to_a_page_and_a_place_on_it(page_addresses):
    for page, addresses in page_addresses.items():
        for link in addresses.links:
            path, _, anchor = link.partition("#")
            path = path.partition("?")[0]
            if re.match(r"\w+:", path):
                continue
            target = (page.parent / path).resolve() if path else page
            assert target.is_file(), f"{page.name}: {link}"
            assert not anchor or anchor in page_addresses[target].anchors, f"{page.name}: {link}"


def test_every_picture_has_alt_text_and_headings_go_down_one_by_one(page_addresses):
    for page, addresses in page_addresses.items():
        assert not addresses.silent, page.name
        assert addresses.headings.count(1) == 1, page.name
        steps = zip(addresses.headings, addresses.headings[1:], strict=False)
        assert all(after - before <= 1 for before, after in steps), page.name


def test_the_first_page_begins_with_the_story_and_shows_its_finished_image(made):
    first = (made[1] / "index.html").read_text("utf-8")
    assert 'href="story.html">Start here (10 minutes)</a>' in first
    (shown,) = re.findall(r'data-name="([^"]+)"', first)
    assert shown == re.findall(r'data-name="([^"]+)"', story_of(made))[-1]


def story_of(made):
    return (made[1] / "story.html").read_text("utf-8")


def test_without_scripts_the_story_has_a_picture_for_each_figure_and_no_code(made):
    text = story_of(made)
    places = re.findall(r'<div class="live"[^>]*>(.*?)</div>', text)
    assert len(places) >= 10
    assert all(re.match(r'<img [^>]*alt="[^"]+"', place) for place in places)
    assert "<pre" not in text


def test_the_story_is_readable_after_300_kB_and_has_less_than_4_MB_in_all(made):
    """Its words, its style and the images that stand in the figures' places; then the figures."""
    page = made[1] / "story.html"
    addresses = {
        page,
        *(page.parent / address.partition("?")[0] for address in Addresses(story_of(made)).asked),
    }
    figures = re.findall(r'data-(?:code|from)="([^"]+)"', story_of(made))
    everything = addresses | {page.parent / name for name in figures}
    assert sum(file.stat().st_size for file in addresses) < 300_000
    assert sum(file.stat().st_size for file in everything) < 4_000_000


def test_formulas_are_drawn_and_spoken(made):
    text = (made[1] / "notebooks" / "01_one.html").read_text("utf-8")
    assert text.count("<svg") == text.count("<math") == 2
    drawn = re.findall('<symbol id="([^"]+)"', text)
    assert drawn and len(drawn) == len(set(drawn)) < text.count("<use ")
    assert set(re.findall('<use href="#([^"]+)"', text)) == set(drawn)
    assert "\\ln" not in text


def test_a_page_does_not_say_how_to_run_what_has_been_run(made):
    text = (made[1] / "notebooks" / "01_one.html").read_text("utf-8")
    assert "<p>So " in text and "Run the cells" not in text
    welcome = json.loads((NOTEBOOKS / "00_welcome.ipynb").read_text("utf-8"))["cells"][0]["source"]
    left = build.SENTENCES_ON_RUNNING.sub("", "".join(welcome))
    assert "Run All Cells" in "".join(welcome) and "Run All Cells" not in left
    assert "Shift and Enter" in "".join(welcome) and "Shift and Enter" not in left
    assert "arrow keys" in left


def test_a_link_to_a_notebook_that_the_site_lacks_is_text(made):
    text = (made[1] / "notebooks" / "02_two.html").read_text("utf-8")
    assert 'href="01_one.html"' in text
    assert "and three." in text and "03_three" not in text


def test_a_guide_that_a_notebook_names_is_a_link_on_its_page(made):
    text = (made[1] / "notebooks" / "02_two.html").read_text("utf-8")
    assert 'href="../installing.html"' in text
    assert "the guide <em>Unknown</em>" in text


def test_the_guide_to_the_screen_stays_readable_without_the_notebook_that_has_its_figure(made):
    text = (made[1] / "screen.html").read_text("utf-8")
    assert "screen-match" not in text and "The same figure is in notebook 25." in text


def test_the_map_leads_to_the_functions_and_to_the_notebooks_that_import_them(made, page_addresses):
    links = page_addresses[made[1] / "map.html"].links
    assert "reference/tonemap.ward.html#hdrlab.tonemap.ward.tonemap" in links
    assert "reference/core.filters.bilateral.html#module-hdrlab.core.filters.bilateral" in links
    assert "notebooks/01_one.html" in links
    functions = [link for link in links if "#hdrlab." in link]
    assert len(functions) > 20
    assert "reference/pipeline.stages.html#hdrlab.pipeline.stages.assemble" in links


def test_a_name_in_a_table_breaks_after_a_dot_alone(made):
    text = (made[1] / "map.html").read_text("utf-8")
    assert "tonemap.<wbr>ward" in text and "read_<wbr>bracket" in text
    assert "<wbr>" not in text.partition("<table")[0] + text.rpartition("</table>")[2]


def test_a_page_of_the_reference_has_the_legend_the_parameters_and_the_source(made):
    text = (made[1] / "reference" / "tonemap.chiu.html").read_text("utf-8")
    assert re.search('<dl class="[^"]*legend', text)
    for expected in ("headroom", "Parameters", "Raises", "Examples", "[source]"):
        assert expected in text


def test_a_cell_that_is_folded_in_jupyterlab_is_folded_on_its_page_with_its_picture_below(made):
    page_without = (made[1] / "notebooks/01_one.html").read_text("utf-8")
    page_with = (made[1] / "notebooks/02_two.html").read_text("utf-8")
    assert "<details" not in page_without and page_with.count("<details") == 1
    before, _, folded = page_with.partition("<details")
    code, _, after = folded.partition("</details>")
    assert "widgets" in before
    assert "Show the code" in code
    assert "pictures" in code
    assert "<img" in after


def test_a_widget_lies_in_a_file_of_its_own_with_a_picture_in_its_place(made):
    page = (made[1] / "notebooks" / "01_one.html").read_text("utf-8")
    assert 'data-from="../_widgets/01_one-1.js"' in page
    assert 'alt="A square, ever lighter, step 1"' in page
    text = (made[1] / "_widgets" / "01_one-1.js").read_text("utf-16")
    name, content = json.loads("[" + text.removeprefix("hdrlab.take(").removesuffix(");\n") + "]")
    assert name == "01_one-1" and len(content["state"]["frames"]) == 5
    assert content["state"]["frames"][0] == {"shown": True}, "the page has it already"
    (code,) = set(re.findall('data-code="../_widgets/([^"]+)"', page))
    assert code == f"{content['code']}.js"
    text = (made[1] / "_widgets" / code).read_text("utf-8")
    assert text.startswith(f'hdrlab.take("{content["code"]}", {{"script": ')


def test_an_unchanged_notebook_is_not_built_again(made):
    folder, site, notebooks, _ = made
    before = {page: page.stat().st_mtime_ns for page in site.rglob("*.html")}
    ran = run("site", *notebooks, folder=folder)
    assert "run now: 0" in ran.stdout
    assert {page: page.stat().st_mtime_ns for page in site.rglob("*.html")} == before


def test_the_pages_of_a_notebook_that_is_gone_are_removed(made, tmp_path):
    """The test uses the shared folder, so that Sphinx need not read all pages again, and restores it."""
    folder, site, (first, second, _, plain), _ = made
    assert (site / "notebooks" / "03_gone.html").exists()
    assert list((site / "_widgets").glob("03_gone*"))
    whole = shutil.copytree(folder, tmp_path / "whole")
    try:
        ran = run("site", first, second, plain, folder=folder)
        assert ran.returncode == 0 and "run now: 0" in ran.stdout and ran.stderr == ""
        assert not (site / "notebooks" / "03_gone.html").exists()
        assert not list((site / "_widgets").glob("03_gone*"))
        assert (site / "notebooks" / "01_one.html").exists()
    finally:
        shutil.rmtree(folder)
        shutil.copytree(whole, folder)


def test_a_build_that_was_killed_is_made_again_from_the_executed_notebooks(made, tmp_path):
    """The test leaves the folder as a kill does: half of a file of Sphinx, and no record of a complete
    build.
    """
    folder, site, notebooks, _ = made
    cache = folder / ".site.cache"
    whole = shutil.copytree(folder, tmp_path / "whole")
    before = {page: page.read_bytes() for page in site.rglob("*.html")}
    try:
        (cache / "made.json").unlink()
        for file in (cache / "doctrees").iterdir():
            if file.is_file():
                file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        (cache / "html" / "searchindex.js.tmp").write_text("half")
        ran = run("site", *notebooks, folder=folder)
        assert ran.returncode == 0, ran.stderr
        assert "run now: 0" in ran.stdout
        assert {page: page.read_bytes() for page in site.rglob("*.html")} == before
        assert not list(folder.rglob("searchindex.js.tmp"))
    finally:
        shutil.rmtree(folder)
        shutil.copytree(whole, folder)


def test_a_notebook_that_fails_is_named_with_its_cell(tmp_path):
    bad = notebook(tmp_path / "bad.ipynb", "Bad", "x = 1", "light = x / 0")
    ran = run(tmp_path / "site", bad, folder=tmp_path)
    assert ran.returncode == 1
    expected = (
        "hdrlab: bad.ipynb, cell 3 ('cell-1', 'light = x / 0'): ZeroDivisionError: division by zero"
    )
    assert ran.stderr.strip().splitlines() == [expected]
    assert not (tmp_path / "site" / "index.html").exists()


def test_a_notebook_of_ones_own_may_lack_a_title_and_pictures_and_speak_ipython(
    made, page_addresses
):
    front = page_addresses[made[1] / "index.html"]
    assert "notebooks/plain.html" in front.links
    assert "Plain &amp; simple" in (made[1] / "notebooks" / "plain.html").read_text("utf-8")


def test_the_pictures_of_a_page_are_files_that_are_fetched_as_they_come_into_view(made):
    page = made[1] / "notebooks" / "02_two.html"
    shown, still = re.findall(r"<img [^>]+>", page.read_text("utf-8"))
    assert 'loading="lazy"' in shown and 'loading="lazy"' in still
    attributes = dict(re.findall(r'(\w+)="([^"]*)"', shown))
    height, width = decode_picture((page.parent / attributes["src"]).read_bytes()).shape[:2]
    assert (attributes["width"], attributes["height"]) == (str(width), str(height))
    assert attributes["alt"]
    assert "data:image" not in page.read_text("utf-8")


def test_a_photograph_in_a_cells_html_is_a_file_to_the_byte(tmp_path):
    """Otherwise a photo with a gain map would lose the map."""
    taken = web.encode_jpeg(np.full((8, 12), 90, np.uint8)) + b"and its gain map"
    shown = {"text/html": f'<img alt="A room" src="{web.data_uri(taken, "jpeg")}">'}
    output = nbformat.v4.new_output("display_data", data=shown)
    cells = [nbformat.v4.new_code_cell("room", outputs=[output])]
    notebook = nbformat.v4.new_notebook(cells=cells)
    live.extract_images(notebook, "room", tmp_path, "../apart")
    assert (tmp_path / "room-p1.jpeg").read_bytes() == taken
    assert (
        'src="../apart/room-p1.jpeg" width="12" height="8"'
        in notebook.cells[0].outputs[0]["data"]["text/html"]
    )


def test_photographs_that_are_compared_are_light_on_a_page_and_bitmaps_stay_as_they_are():
    photograph = pipeline.develop(scenes.workshop((128, 192)))
    bitmap = np.uint8(255) * (photograph.mean(axis=-1) > 128)
    exact = [web.encode_webp(picture, lossless=True) for picture in (photograph, bitmap)]
    apart = [
        {"path": ["pictures", k], "data": base64.b64encode(pixels).decode()}
        for k, pixels in enumerate(exact)
    ]
    state = {"_esm": "", "scales": [], "pictures": [None, None], "alt": "A room"}
    shown = live.export_widget({"state": state, "buffers": apart}, "room-1").state["pictures"]
    light = [base64.b64decode(pixels["base64"]) for pixels in shown]
    assert len(light[0]) < len(exact[0]) * 2 / 3
    assert np.abs(web.decode_picture(light[0]).astype(int) - photograph).mean() < 2
    assert light[1] == exact[1]


def test_a_dark_page_turns_plots_about_and_leaves_photographs_and_maps_their_colours():
    photograph = pipeline.develop(scenes.workshop((64, 96)))
    line = curves.lines(np.arange(9), {"nine": np.arange(9)}, across="place", up="light")
    slope = tones.maps({"": np.indices((64, 96))[0] - 32}, label="stops", signed=True)
    shown = [
        live.ExportedWidget("", "", "", {}, pictures.encode(picture), "").as_html("")
        for picture in (line, slope, photograph)
    ]
    assert ["data-ink" in picture for picture in shown] == [True, False, False]


def test_notebooks_of_one_name_are_refused(tmp_path):
    (tmp_path / "more").mkdir()
    both = [notebook(folder / "one.ipynb", "One", "1") for folder in (tmp_path, tmp_path / "more")]
    ran = run("site", *both, folder=tmp_path)
    assert ran.returncode == 2 and "different names" in ran.stderr
    assert not (tmp_path / "site").exists()


def test_a_folder_with_something_else_in_it_is_left_alone(tmp_path):
    (tmp_path / "precious.html").write_text("mine")
    ran = run(tmp_path, folder=tmp_path)
    assert ran.returncode == 2 and str(tmp_path) in ran.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["precious.html"]


@pytest.mark.skipif(os.name == "nt", reason="there is no SIGINT to send")
def test_ctrl_c_ends_the_kernels_and_leaves_no_half_notebook(tmp_path):
    file = tmp_path / "kernel"
    slow = f"import os, time\nopen({str(file)!r}, 'w').write(str(os.getpid()))\ntime.sleep(600)"
    process = subprocess.Popen(
        command(tmp_path / "site", notebook(tmp_path / "slow.ipynb", "Slow", slow)),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + PATIENCE
        while not (file.exists() and file.read_text()) and time.monotonic() < deadline:
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    assert process.returncode == 130 and errors.strip() == "hdrlab: interrupted"
    assert not _alive(int(file.read_text()))
    assert not [path.name for path in (tmp_path / "site").rglob("*.ipynb") if "slow" in path.name]


def _alive(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return False
    return True


def test_the_words_of_a_docstring_stay_as_they_are():
    lines = [
        "L   luminance   (H, W)",
        "    any unit",
        "s*  scale",
        "",
        "Then |x| * 2.",
        "",
        ">>> 2 * 3",
        "6",
    ]
    text = "\n".join(reference.format_docstring(lines, module=True))
    assert "``L``\n   luminance · (H, W)\n   any unit" in text
    assert "Then \\|x\\| \\* 2." in text
    assert ">>> 2 * 3\n6" in text


def test_every_row_of_the_lecture_names_what_there_is():
    """Each name in the map is a module of the library, or is defined in one."""
    import importlib

    for lecture, where in reference.read_lecture_map():
        for name in reference.DOTTED_NAME.findall(where):
            parts = f"hdrlab.{name}".split(".")
            try:
                importlib.import_module(".".join(parts))
            except ModuleNotFoundError:
                assert hasattr(importlib.import_module(".".join(parts[:-1])), parts[-1]), (
                    lecture,
                    name,
                )


def test_the_sources_of_the_site_travel_with_the_package():
    folder = Path(live.__file__).parent
    for name in (
        "pages/index.md",
        "pages/story.ipynb",
        "theme/layout.html",
        "theme/static/live.js",
    ):
        assert (folder / name).is_file()


def test_every_case_that_a_guide_names_is_pictured_with_alt_text():
    pages = Path(live.__file__).parent / "pages"
    named = dict(
        re.findall(r"!\[(.+)\]\((cases/\w+\.webp)\)", (pages / "verdicts.md").read_text("utf-8"))
    )
    assert set(named.values()) == {f"cases/{file.name}" for file in pages.glob("cases/*")}
    assert all(alt.startswith("Three photographs of the ") for alt in named)


def quotes_of_the_page_on_warnings():
    page = (Path(live.__file__).parent / "pages" / "verdicts.md").read_text("utf-8")
    quotes = re.findall(r"(?:^> .*\n)+", page, flags=re.MULTILINE)
    return [" ".join(quote.replace("> ", "").split()) for quote in quotes]


def test_the_page_on_warnings_quotes_them_as_they_are_printed():
    package = Path(live.__file__).parents[2]
    printed = ""
    for file in (
        file
        for room in ("diagnostics", "pipeline", "radiance", "io")
        for file in (package / room).rglob("*.py")
    ):
        nodes = list(ast.walk(ast.parse(file.read_text("utf-8"))))
        strings = []
        for node in nodes:
            if isinstance(node, ast.JoinedStr):
                strings.append(node.values)
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                strings.append([node])
        for parts in strings:
            printed += (
                "".join(part.value if isinstance(part, ast.Constant) else "%" for part in parts)
                + "\n"
            )
    sentences = warning_texts.SENTENCES.values()
    printed += "\n".join(re.sub(r"\{.*?\}", "%", sentence) for sentence in sentences)
    for pair in combinations(causes.CAUSES, 2):
        named = " or ".join(warning_texts.SENTENCES[f"{cause}_cause"] for cause in pair)
        printed += "\n" + warning_texts.warning_text("either", causes=named, evidence="", advice="")
    quotes = quotes_of_the_page_on_warnings()[: -len(REFUSED)]
    assert len(quotes) >= 12
    for quote in quotes:
        for part in re.split(r"frame\d\.jpg|[+-]?\d+(?:\.\d+)?", quote.removeprefix("note: ")):
            assert part.strip(" ,:;") in printed, quote


# Errors and parts of sentences, which the page does not explain one by one.
UNEXPLAINED = {
    *(f"{cause}_{part}" for cause in causes.CAUSES for part in ("cause", "evidence", "advice")),
    "either",
    "order",
    "in_common",
    "darker",
    "steep",
    "wide",
    "few",
    "of_three",
    "relative",
    "replaced_immeasurable",
    "kept_times_advice",
    "parts_advice",
    "photo_parts_follows",
    "instead",
    "dark_parts_advice",
    "widespread_advice",
    "ghosts_advice",
    "unresolved_ghosts_advice",
}


@pytest.mark.parametrize("name", sorted(set(warning_texts.SENTENCES) - UNEXPLAINED))
def test_the_page_on_warnings_quotes_each_warning(name):
    quotes = " ".join(quotes_of_the_page_on_warnings())
    parts = [part.strip(" :;,(") for part in re.split(r"\{.*?\}", warning_texts.SENTENCES[name])]
    opening = next(part for part in parts if len(part) > 12)
    assert opening[:40] in quotes


def refusal(read, *arguments):
    with pytest.raises(ValueError, match=".") as refused:
        read(*arguments)
    return str(refused.value)


@pytest.mark.parametrize("what", REFUSED)
def test_the_page_quotes_the_messages_about_photos_word_for_word(what, tmp_path):
    taken = scenes.photographs((160, 120))
    stated = [1 / 4, 1 / 8, 1 / 15, 1 / 60, 1 / 120, 1 / 1000]
    for j, Z in enumerate(taken.images[::-1], 1):
        halved = j % 2 == 0 and what == "two sizes"  # a half of them: fewer would be left out
        write_picture(tmp_path / f"frame{j}.jpg", Z[::2, ::2] if halved else Z)
    if what == "one photograph":
        message = refusal(read_bracket, tmp_path / "frame1.jpg")
    elif what == "times the other way round":
        taken_backwards = read_bracket(tmp_path, stated[::-1])
        message = refusal(partial(pipeline.assemble, times="stated"), taken_backwards)
    else:
        message = refusal(read_bracket, tmp_path, stated)
    assert message.replace(f"{tmp_path}/", "") in quotes_of_the_page_on_warnings()[-len(REFUSED) :]


def test_the_page_quotes_the_warning_about_the_times_of_the_packaged_photos():
    taken = replace(scenes.photographs((320, 240)), times=1 / np.array([1000, 120, 60, 15, 8, 4]))
    warning = pipeline.assemble(taken).warnings[0].partition(", but")[0]
    quotes = quotes_of_the_page_on_warnings()
    (quote,) = [
        quote for quote in quotes if quote.startswith("the stated times") and "not used" in quote
    ]
    assert re.sub(r"[\d.]+", "", warning) == re.sub(r"[\d.]+", "", quote)
    printed_error = float(re.search(r"[\d.]+", warning)[0])
    quoted_error = float(re.search(r"[\d.]+", quote)[0])
    assert printed_error == pytest.approx(quoted_error, abs=0.02)  # 1.06 with all pixels
