"""The slides in a browser: all fit, players play, nothing comes from a network."""

import base64
import io
import shutil

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output
from PIL import Image

from mocap.course.opening import stored
from mocap.course.teaching.slides import build_slides
from mocap.widgets.player import play
from tests.browser.conftest import wait_until
from tests.conftest import SWEEP
from tests.strategies import wave

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
