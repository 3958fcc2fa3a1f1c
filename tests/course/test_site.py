"""The course as pages."""

import json
import re
from html.parser import HTMLParser

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from mocap.cli.main import main
from mocap.course.opening import stored
from mocap.course.site import PAGES, STILL, build_site
from mocap.errors import MocapError


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    out = tmp_path_factory.mktemp("site") / "course"
    assert main(["course", "site", "-o", str(out)]) == 0
    return out


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
    return {path.name: Page(path.read_text("utf-8")) for path in site.glob("*.html")}


def sections(site):
    text = (site / "search.js").read_text("utf-8")
    return json.loads(text.removeprefix("const sections = ").rstrip(";\n"))


def dead(found):
    """Follow all links of all pages, and list those that lead to no page or to no place in it."""
    for name, page in found.items():
        for link in page.links:
            file, _, anchor = link.partition("#")
            if not re.match("(https?|mailto):", link) and (
                (file or name) not in found or (anchor and anchor not in found[file or name].ids)
            ):
                yield f"{name}: {link}"


def test_every_notebook_is_a_page_and_all_links_and_anchors_lead_somewhere(site):
    found = pages(site)
    assert {f"{path.stem}.html" for path in stored().glob("*.ipynb")} <= set(found)
    assert sum(link.startswith("#") for page in found.values() for link in page.links) > 150
    assert list(dead(found)) == []
    for name, page in found.items():
        ids = [id for id in page.ids if id]
        assert len(set(ids)) == len(ids), name


def test_the_menu_lists_the_sections_of_its_page(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    menu = text.partition('<ul id="menu">')[2].partition("</nav>")[0]
    assert '<li><a href="#the-clips">The clips</a></li>' in menu
    assert menu.count("<ul>") == 1  # of this page alone
    assert menu.count(".html") == len(list(site.glob("*.html"))) - 1  # index.html leads on


def test_each_page_says_what_is_live_and_how_to_run_it(site):
    for path in site.glob("[0-9A-Z]*.html"):
        note = re.search(r'<main[^>]*>\s*<p class="note">(.*?)</p>', path.read_text("utf-8"))[1]
        assert "pip install '.[notebooks]'" in note
        assert "mocap lab" in note
        assert len(re.findall(r"[.] ", note)) == 1
    text = (site / "00-quickstart.html").read_text("utf-8")
    live = "the players play, quizzes and bets answer you and seams can be looked into"
    assert f"On this page {live}; code and other controls are still." in text
    blind = (site / "09-discussion.html").read_text("utf-8")
    assert "quizzes and bets answer you and the blind test can be taken;" in blind
    assert live.STILL == STILL
    stills = [part[:200] for part in text.split('<div class="mocap-still">')[1:]]
    assert stills
    assert all(part.startswith('<p class="note">A ') for part in stills)


def test_nothing_is_loaded_from_elsewhere_and_every_picture_is_told(site):
    for name, page in pages(site).items():
        assert all(not re.match("(https?:)?//", load) for load in page.loads), name
        assert all(len(picture.get("alt", "")) >= 20 for picture in page.pictures), name


def test_formulas_are_drawn_by_the_browser_itself(site):
    text = (site / "00-quickstart.html").read_text("utf-8")
    assert '<math xmlns="http://www.w3.org/1998/Math/MathML" display="block">' in text
    for page in site.glob("*.html"):
        shown = re.sub(r"(?s)<(script|pre|code|style).*?</\1>", "", page.read_text("utf-8"))
        assert not re.search(r"\$\$|FORMULA\d|\\[a-zA-Z]+", shown), page


def test_the_search_finds_text_code_and_formulas_under_their_heading(site):
    index = sections(site)
    text = " ".join(s["text"] for s in index)
    assert "explore(" in text
    assert re.search(r"\bsin [αθ]", text)
    assert not any("base64" in s["text"] for s in index)
    pages_found = pages(site)
    for section in index:
        page, anchor = section["at"].split("#")
        assert anchor in pages_found[page].ids, section["at"]


def write_course(folder, *cells):
    """Write a course of one notebook, and its pages."""
    folder.mkdir()
    for name in PAGES:
        (folder / f"{name}.md").write_text(f"# {name.title()}\n")
    made = new_notebook(cells=list(cells))
    nbformat.write(made, folder / "00-one.ipynb")
    return folder


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        (r"i\sin\alpha", "<mi>i</mi>{}<mi>sin</mi>{}<mi>&#x003B1;</mi>"),
        (r"\cos(\alpha)", "<mrow><mi>cos</mi><mo"),
        (r"\sin^2\alpha", "<msup><mi>sin</mi><mn>2</mn></msup>{}<mi>"),
        (r"\operatorname{atan2}(y, x)", "<mtext>atan2</mtext><mo"),
        (r"\big\lVert a\big\rVert", ">‖</mo><mi>a</mi>"),
        (r"\mathrm{d}t", "<mtext>d</mtext><mi>t</mi>"),
    ],
)
def test_names_of_functions_stand_apart_in_formulas(tmp_path, formula, expected):
    cells = [new_markdown_cell(f"# One\n\n${formula}$")]
    text = build_site(write_course(tmp_path / "in", *cells), tmp_path / "out").read_text("utf-8")
    assert expected.replace("{}", '<mspace width="0.167em" />') in text


def test_the_search_knows_what_stands_under_each_heading(tmp_path):
    cells = [
        new_markdown_cell("# One\n\nA [walk](GLOSSARY.md) is *long*.\n\n## Two\n\n- a turn\n- of $\\theta$"),
        new_code_cell("print(draw_path(graph))"),
    ]
    first = build_site(write_course(tmp_path / "in", *cells), tmp_path / "out")
    one, two = sections(first.parent)[:2]
    assert one == {"page": "00 One", "heading": "One", "at": "00-one.html#one", "text": "A walk is long."}
    assert two["text"].startswith("a turn of θ ")
    assert "print(draw_path(graph))" in two["text"]


def test_headings_of_one_name_have_places_of_their_own(tmp_path):
    cells = [new_markdown_cell("# One\n\n## Why *not* `x`?\n\n## Why not x?\n\n[there](#why-not-x-1)")]
    first = build_site(write_course(tmp_path / "in", *cells), tmp_path / "out")
    assert first.read_text("utf-8").count('id="why-not-x') == 2
    assert list(dead(pages(first.parent))) == []


EXPERIMENT = """import matplotlib.pyplot as plt
from mocap.widgets import explore

def draw(steps_taken=2):
    return plt.figure(figsize=(steps_taken + 1, 1))

explore(draw, alt="A white picture, as wide as the slider says.", steps_taken=(0, 3))"""


def test_experiments_move_through_recorded_positions(tmp_path):
    still = {"text/html": '<div class="mocap-still"><img alt="Still."></div>', "text/plain": "Still."}
    cell = new_code_cell(EXPERIMENT, outputs=[new_output("display_data", still)])
    alone = new_code_cell("import os\nassert os.environ['MOCAP_MINE'] == ''  # nobody's functions are shown")
    folder = write_course(tmp_path / "in", new_markdown_cell("# One"), alone, cell)
    text = build_site(folder, tmp_path / "still").read_text("utf-8")
    assert "its controls move where the notebook runs" in text
    text = build_site(folder, tmp_path / "moving", moving=True).read_text("utf-8")
    assert "On this page the sliders show recorded positions" in text
    label = re.search(r"<label>steps taken <input(.*?)/?><output>2</output></label>", text)[1]
    assert {'type="range"', 'min="0"', 'max="3"', 'value="2"', 'aria-valuetext="2"'} <= set(label.split())
    assert 'alt="A white picture, as wide as the slider says."' in text
    recorded = json.loads(re.search(r'<script type="application/json">(.*?)</script>', text)[1])
    assert recorded["labels"] == ["0", "1", "2", "3"]
    assert len(set(recorded["pictures"])) == 4


def test_a_notebook_that_does_not_run_is_not_recorded(tmp_path):
    folder = write_course(tmp_path / "in", new_markdown_cell("# One"), new_code_cell("1 / 0"))
    with pytest.raises(MocapError, match=r"00-one.ipynb: a cell fails with ZeroDivisionError"):
        build_site(folder, tmp_path / "out", moving=True)


def test_a_folder_without_notebooks_is_told(tmp_path):
    with pytest.raises(MocapError, match="holds no notebooks"):
        build_site(tmp_path, tmp_path / "out")
