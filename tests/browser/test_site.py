"""The course's site and its slides, opened as files: they load nothing, all fits, and players play."""

import base64
import io
import re
import shutil

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from PIL import Image

from mocap.course.opening import stored
from mocap.course.teaching import board
from mocap.course.teaching.slides import build_slides
from mocap.widgets.player import play
from tests.browser.conftest import on_a_phone, wait_until
from tests.conftest import SWEEP
from tests.course.test_site import EXPERIMENT, build_small, course_site
from tests.strategies import wave


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return course_site(tmp_path_factory)


@pytest.fixture
def first(site):
    """Give the address of the first page."""
    return (site / "00-quickstart.html").as_uri()


def test_a_page_plays_and_folds(page, first):
    page.goto(first)
    players = page.locator(".mocap-player")
    assert players.count() >= 3
    players.first.scroll_into_view_if_needed()
    wait_until(lambda: page.evaluate("document.querySelector('.mocap-player').player?.pictures > 3"))
    folded = page.locator("details").first
    assert folded.locator("p, pre").first.is_hidden()
    folded.locator("summary").click()
    wait_until(folded.locator("p, pre").first.is_visible)
    formula = page.locator("math[display=block]").first
    assert formula.bounding_box()["height"] > 15  # the browser itself draws it


def test_the_search_answers(page, first):
    page.goto(first)
    page.locator("input[name=q]").fill("footskate")
    page.locator("input[name=q]").press("Enter")
    results = page.locator("#search-results li a")

    def are_all_there():
        count = results.count()
        page.wait_for_timeout(300)  # results come one by one, and move those below them
        return 1 < count == results.count()

    wait_until(are_all_there)
    results.first.click()
    wait_until(lambda: "search.html" not in page.url)


@pytest.mark.parametrize("term", ["foot sliding", "branch and bound", "motion graph"])
def test_the_search_finds_a_term_where_it_is_taught(page, first, term):
    page.goto(first.replace("00-quickstart.html", f"search.html?q={term.replace(' ', '+')}"))
    results = page.locator("#search-results li a")
    wait_until(lambda: "finished" in page.locator("#search-results").inner_text())
    taught = {"foot sliding": "04b", "branch and bound": "07", "motion graph": "05"}[term]
    assert results.first.get_attribute("href").startswith(taught)


def test_the_search_shows_a_page_once_and_an_excerpt_with_the_words(page, first):
    page.goto(first.replace("00-quickstart.html", "search.html?q=foot+sliding"))
    wait_until(lambda: "finished" in page.locator("#search-results").inner_text())
    shown = page.locator("#search-results li:visible")
    wait_until(lambda: shown.locator(".excerpt").count() > 5)
    marks = shown.first.locator(".excerpt mark").all_inner_texts()
    assert {"foot", "sliding"} <= {mark.lower() for mark in marks}
    pages = [link.get_attribute("href").partition("#")[0] for link in shown.locator("a").all()]
    courses = [name for name in pages if not name.startswith("reference/")]
    assert len(courses) == len(set(courses))


def test_the_search_knows_words_near_what_was_typed(page, first):
    page.goto(first.replace("00-quickstart.html", "search.html?q=footskete"))
    wait_until(lambda: page.locator("#search-results .note").count())
    assert page.locator("#search-results .note").inner_text().startswith("No page has “footskete”. These")
    assert "(footskat…)" in page.locator("#search-results").inner_text()


def test_code_can_be_hidden_and_stays_hidden(page, first):
    page.goto(first)
    page.get_by_role("button", name="hide code").click()
    assert page.locator(".cell_input").first.is_hidden()
    page.reload()
    assert page.locator(".cell_input").first.is_hidden()
    page.get_by_role("button", name="show code").click()
    assert page.locator(".cell_input").first.is_visible()


def test_pages_are_dark_where_the_reader_wants_it(page, first):
    page.emulate_media(color_scheme="dark")
    page.goto(first)
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert max(map(int, re.findall(r"\d+", paper))) < 60
    figure = "getComputedStyle(document.querySelector('article img')).backgroundColor"
    assert page.evaluate(figure).endswith("(255, 255, 255)")


def test_a_recorded_experiment_moves(page, tmp_path):
    still = new_output("display_data", {"text/html": '<div class="mocap-still"></div>'})
    cells = [
        new_markdown_cell("# One"),
        new_code_cell(EXPERIMENT, outputs=[still], metadata={"tags": ["experiment:steps"]}),
    ]
    nbformat.write(new_notebook(cells=cells), tmp_path / "00-one.ipynb")
    (tmp_path / "teaching").mkdir()
    index = build_small(tmp_path, tmp_path / "out", moving=True)
    assert index.name == "index.html"
    address = index.with_name("00-one.html").as_uri()
    page.goto(address)
    slider, picture = page.get_by_label("steps taken"), page.locator(".moving img")
    shape = "picture => picture.naturalWidth / picture.naturalHeight"  # each is shown equally wide
    wide = picture.evaluate(shape)
    slider.press("ArrowRight")
    wait_until(lambda: picture.evaluate(shape) > wide)
    assert page.locator(".moving output").inner_text() == "3"
    assert slider.get_attribute("aria-valuetext") == "3"
    slider.press("Home")
    wait_until(lambda: picture.evaluate(shape) < wide)
    assert slider.bounding_box()["height"] >= 44
    assert page.url == f"{address}#experiment-steps=0"
    page.goto("about:blank")
    page.goto(f"{address}#experiment-steps=3")
    wait_until(lambda: page.locator(".moving output").inner_text() == "3")


CUT_OR_SMALL = """() => {
  const box = part => part.getBoundingClientRect();
  const slides = part => part && part.tagName !== "ARTICLE" &&
    (/auto|scroll/.test(getComputedStyle(part).overflowX) || slides(part.parentElement));
  const all = document.querySelectorAll("article *:not(math *, svg *, .headerlink)");
  const seen = [...all].filter(part => box(part).width);
  const cut = seen.filter(part => box(part).right > innerWidth + 1 && !slides(part.parentElement));
  const small = seen.filter(part => part.matches("button, select, summary") && box(part).height < 40);
  const one = part => part.matches("td > code") && /^\\w+$/.test(part.textContent);
  const broken = seen.filter(part => one(part) && part.getClientRects().length > 1);
  return [...cut, ...small, ...broken].map(part => `${part.tagName} ${part.textContent}`.slice(0, 60));
}"""


@on_a_phone
def test_every_page_fits_a_phone(page, site):
    page.emulate_media(reduced_motion="reduce")  # players that play change no place
    for file in sorted(site.glob("[0-9]*.html")):
        page.goto(file.as_uri())
        assert page.evaluate("document.documentElement.scrollWidth") <= 390, file.name
        assert page.evaluate(CUT_OR_SMALL) == [], file.name


FAULTS = """() => {
  const section = Reveal.getCurrentSlide(), parts = [...section.querySelectorAll("h1, h2, .inner, .inner *")];
  const box = part => part.getBoundingClientRect();
  const seen = parts.filter(part => box(part).width && box(part).height);
  const cut = seen.filter(part => box(part).bottom > 720 || box(part).right > 1280);
  const words = part => [...part.childNodes].some(node => node.nodeType === 3 && node.textContent.trim());
  const size = part => parseFloat(getComputedStyle(part).fontSize);
  const small = seen.filter(part => words(part) && !part.closest("canvas") && size(part) < 20);
  const faults = [...cut, ...small].map(part => `${part.tagName} ${part.textContent}`.slice(0, 60));
  const scale = img => Math.min(box(img).width / img.naturalWidth, box(img).height / img.naturalHeight);
  return [faults, [...section.querySelectorAll(".inner img")].map(img => [img.src, scale(img)])];
}"""
NAMES = [file.stem for file in sorted((stored() / "slides").glob("*.md"))][: None if SWEEP else 1]
DECK = """# Walks

A body walks.

---

## It plays

{show play(}

---

## It ends

So.
"""


@pytest.fixture(scope="module")
def decks(tmp_path_factory):
    folder, out = tmp_path_factory.mktemp("notebooks"), tmp_path_factory.mktemp("slides")
    shutil.copytree(stored() / "slides", folder / "slides")
    for name in NAMES:
        shutil.copy(stored() / f"{name}.ipynb", folder)
    player = play(wave(60)).html()
    cells = [
        new_markdown_cell("# Walks"),
        new_code_cell("play(x)", outputs=[new_output("display_data", {"text/html": player})]),
    ]
    nbformat.write(new_notebook(cells=cells), folder / "99-walks.ipynb")
    (folder / "slides" / "99-walks.md").write_text(DECK, "utf-8")
    build_slides(folder, out)
    return out


@pytest.mark.sweep
def test_all_drawings_for_the_board_are_drawn():
    assert {len(board.pictures_of(name)) for name in board.BOARD} <= {1, 3, 4, 6}  # once for the decks, too


@pytest.mark.parametrize("name", NAMES)
def test_every_slide_fits_and_can_be_read(name, decks, page):
    page.set_viewport_size({"width": 1280, "height": 720})
    page.goto((decks / f"{name}.html").as_uri())
    page.wait_for_function("window.Reveal && Reveal.isReady()")
    for number in range(page.evaluate("Reveal.getTotalSlides()")):
        page.evaluate(f"Reveal.slide({number})")
        faults, pictures = page.evaluate(FAULTS)
        assert faults == [], f"slide {number} of {name}"
        for source, scale in pictures:
            drawn = Image.open(io.BytesIO(base64.b64decode(source.partition(",")[2])))
            assert scale * float(drawn.info["letters"]) >= 20, f"a picture on slide {number} of {name}"


def test_a_player_plays_and_keeps_its_keys(decks, page):
    page.goto((decks / "99-walks.html").as_uri())
    page.wait_for_function("window.Reveal && Reveal.isReady()")
    numbers = page.evaluate(
        "[...document.querySelectorAll('.slides > section')]"
        ".flatMap((slide, number) => (slide.querySelector('.mocap-player') ? [number] : []))"
    )
    page.evaluate(f"Reveal.slide({numbers[0]})")
    clock = page.locator("section.present .mocap-player .clock")
    first = clock.inner_text()
    wait_until(lambda: clock.inner_text() != first)
    page.locator("section.present .mocap-player canvas").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("Reveal.getIndices().h") == numbers[0]
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("Reveal.getIndices().h") == numbers[0] + 1
