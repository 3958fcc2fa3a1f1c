"""The course as pages."""

import json
import os
import posixpath
import re
import subprocess
import sys
from html.parser import HTMLParser

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from mocap.course.formulas import to_mathml
from mocap.course.opening import stored
from mocap.course.site import STILL, build_site, prepared
from mocap.datasets.samples import SAMPLES
from mocap.widgets import live
from tests.bundled import bundled

NAMES = ("00-quickstart", "09b-blend-window")
PAGES = ("COMMANDS", "GLOSSARY", "FORMULAS", "HOMEWORK", "PAPERS", "PROJECT", "README", "RECIPES")


def course_site(tmp_path_factory):
    """Make the pages of the whole course, once for all workers."""
    pytest.importorskip("myst_nb", reason="pip install '.[site]'")
    base = tmp_path_factory.getbasetemp()
    base = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    fcntl = pytest.importorskip("fcntl", reason="workers wait for the site by a lock that Windows lacks")
    with (base / "site.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (base / "site").exists():
            # In a process of its own, which no coverage slows down.
            build = [sys.executable, "-m", "mocap", "course", "site", "-o", str(base / "site")]
            subprocess.run(build, check=True, capture_output=True)
    return base / "site"


def build_small(notebooks, out, **settings):
    """Build pages without the package's reference, the first of which walks through one clip."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mocap.course.site._write_reference", lambda folder: [])
        patch.setattr("mocap.course.site.bundled_graph", lambda: bundled(SAMPLES[0]))
        return build_site(notebooks, out, **settings)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return course_site(tmp_path_factory)


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.pictures, self.loads = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids.append(attributes.get("id"))
        if tag == "a":
            self.links.append(attributes.get("href"))
        elif tag == "img":
            self.pictures.append(attributes)
        if tag in ("script", "link", "img", "iframe"):
            self.loads.append(attributes.get("src") or attributes.get("href") or "")


def pages(site):
    found = (*site.glob("[0-9A-Z]*.html"), *site.glob("teaching/*.html"))
    return {path.relative_to(site).as_posix(): Page(path.read_text("utf-8")) for path in found}


def dead(found):
    """Follow all links between the pages, and list those that lead to no page or to no place in it."""
    for name, page in found.items():
        for link in page.links:
            if re.match(
                r"(https?|mailto):|[./]*(reference/|_downloads/|(index|search|genindex|py-modindex)\.html)",
                link,
            ):
                continue
            file, _, anchor = link.partition("#")
            file = posixpath.normpath(posixpath.join(posixpath.dirname(name), file)) if file else name
            if file not in found or (anchor and anchor not in found[file].ids):
                yield f"{name}: {link}"


def test_every_notebook_is_a_page_beside_the_reference_and_links_lead_somewhere(site):
    found = pages(site)
    assert {f"{name}.html" for name in (*NAMES, *PAGES)} <= set(found)
    assert sum(link.startswith("#") for page in found.values() for link in page.links) > 50
    assert list(dead(found)) == []
    reference = (site / "reference" / "mocap.blending.html").read_text("utf-8")
    assert 'id="mocap.blending.join"' in reference and "Examples" in reference
    assert "L. Kovar, M. Gleicher" in reference
    assert {"teaching/exam.html", "teaching/syllabus.html", "teaching/sample-report.html"} <= set(found)
    assert not [path for path in site.rglob("*") if "answers" in path.name]  # they are the teachers'


def test_the_menu_lists_the_pages_and_the_sections_of_its_own(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert '<a class="reference internal" href="#the-clips">The clips</a>' in text
    assert '<a class="reference internal" href="09b-blend-window.html">09b ' in text


def test_each_page_says_what_is_live_and_how_to_run_it(site):
    for name in NAMES:
        note = re.search(r'<p class="note">(.*?)</p>', (site / f"{name}.html").read_text("utf-8"))[1]
        assert 'pip install ".[notebooks]"' in note and "mocap lab" in note
        assert len(re.findall(r"[.] ", note)) == 1
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert "answer you on these pages; code and some controls are still." in text
    assert live.STILL == STILL
    stills = [part[:200] for part in re.split('<div class="mocap-still"[^>]*>', text)[1:]]
    assert stills
    assert all(part.startswith('<p class="note">A ') for part in stills)


def test_nothing_is_loaded_from_elsewhere_and_every_picture_is_told(site):
    for name, page in pages(site).items():
        assert all(not re.match("(https?:)?//", load) for load in page.loads), name
        assert all(len(picture.get("alt", "")) >= 20 for picture in page.pictures), name


def test_the_first_page_has_a_start_and_three_groups_of_cards(site):
    text = (site / "index.html").read_text("utf-8")
    first = Page(text)
    assert '<a class="start" href="00-quickstart.html">Start here: 00</a>' in text
    cards = re.findall(r'<a class="card" href="([^"]+)"><img src="([^"]+)"', text)
    assert [page for page, _ in cards] == sorted(path.name for path in site.glob("[0-9]*.html"))
    assert all((site / page).exists() and (site / picture).exists() for page, picture in cards)
    assert [part.count('class="card"') > 5 for part in text.split('<div class="cards">')[1:]] == [True] * 3
    assert 'src="walk.html"' in text
    assert '<meta content="walk.png" property="og:image"' in text
    assert all(not re.match("(https?:)?//", load) for load in first.loads)


def test_links_to_a_published_site_show_a_picture(tmp_path):
    (tmp_path / "teaching").mkdir()
    nbformat.write(new_notebook(cells=[new_markdown_cell("# One")]), tmp_path / "00-one.ipynb")
    build_small(tmp_path, tmp_path / "out", address="https://example.org/course/")
    for name in ("index.html", "walk.html"):
        text = (tmp_path / "out" / name).read_text("utf-8")
        assert "https://example.org/course/walk.png" in text


def test_an_unsolved_exercise_invites(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert "not there yet" not in text
    assert "stands in until yours passes" not in text
    assert "Your turn: write speed where the notebook runs. It must return the speed over the ground" in text


def test_recordings_of_the_release_are_those_of_the_cells_of_today():
    files = sorted((stored() / "recordings").glob("*.json"))
    assert files
    for file in files:
        cells = nbformat.read(stored() / f"{file.stem}.ipynb", 4).cells
        sources = {cell.source for cell in cells}
        assert {recording["source"] for recording in json.loads(file.read_text("utf-8"))} <= sources, file


def test_the_site_is_small(site):
    assert sum(path.stat().st_size for path in site.rglob("*") if path.is_file()) < 20_000_000


def test_pages_hold_nothing_that_changes_nothing(site):
    assert not list(site.rglob("*.map"))
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert '<span class="kn">' in text and '<span class="n">' not in text


def test_attached_pictures_are_as_wide_as_their_letters_need(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    (width,) = re.findall(r'<img alt="[^"]+" width="(\d+)" src="_shared/\w+\.(?:webp|png)">\s*</p>', text)[:1]
    assert 400 < int(width) < 736


def test_formulas_are_drawn_by_the_browser_itself(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert '<math xmlns="http://www.w3.org/1998/Math/MathML" display="block">' in text
    for name in (*NAMES, *PAGES):
        text = re.sub(r"(?s)<(script|pre|code|style).*?</\1>", "", (site / f"{name}.html").read_text("utf-8"))
        assert not re.search(r"\$\$|\\[a-zA-Z]+", text), name


def test_the_search_knows_text_and_code(site):
    text = (site / "searchindex.js").read_text("utf-8")
    assert "vermilion" in text and "heading" in text
    assert "base64" not in text


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (r"i\sin\alpha", "<mi>i</mi>{}<mi>sin</mi>{}<mi>α</mi>"),
        (r"\cos(\alpha)", "<mi>cos</mi><mo>&ApplyFunction;</mo><mo"),
        (r"\operatorname{atan2}(y, x)", ">atan2</mi><mo>&ApplyFunction;</mo><mo"),
        (r"\big\lVert a\big\rVert", ">‖</mo><mi>a</mi><mo>‖</mo>"),
        (r"\dot x_a", '<msub><mover><mi>x</mi><mo stretchy="false">˙</mo></mover><mi>a</mi></msub>'),
        (r"60° \dots", "<msup><mn>60</mn><mo>∘</mo></msup><mi>…</mi>"),
    ],
)
def test_names_of_functions_stand_apart_in_formulas(formula, expected):
    assert expected.replace("{}", '<mspace width="0.167em"/>') in re.sub(r"\n *", "", to_mathml(formula))


EXPERIMENT = """import matplotlib.pyplot as plt
from mocap.widgets import explore

def draw(steps_taken=2):
    return plt.figure(figsize=(steps_taken + 1, 1))

explore(draw, alt="A white picture, as wide as the slider says.", steps_taken=(0, 3))"""


def test_experiments_move_through_recorded_positions(tmp_path):
    still = {"text/html": '<div class="mocap-still"><img alt="Still."></div>', "text/plain": "Still."}
    cell = new_code_cell(EXPERIMENT, outputs=[new_output("display_data", still)])
    alone = new_code_cell("import os\nassert os.environ['MOCAP_MINE'] == ''  # nobody's functions are shown")
    file = tmp_path / "00-one.ipynb"
    nbformat.write(new_notebook(cells=[new_markdown_cell("# One"), alone, cell]), file)
    title, notebook = prepared(file, moving=False)
    assert title == "00 One" and "its controls move where the notebook runs" in str(notebook)
    _, notebook = prepared(file, moving=True)
    text = notebook.cells[2].outputs[0].data["text/html"]
    label = re.search(r"<label>steps taken <input(.*?)><output>2</output></label>", text)[1]
    assert {'type="range"', 'min="0"', 'max="3"', 'value="2"', 'aria-valuetext="2"'} <= set(label.split())
    assert 'alt="A white picture, as wide as the slider says."' in text
    recorded = json.loads(re.search(r'<script type="application/json">(.*?)</script>', text)[1])
    assert recorded["labels"] == ["0", "1", "2", "3"]
    assert len(set(recorded["pictures"])) == 4
