"""The slides in a browser: all fit, players play, nothing comes from a network."""

import shutil

import pytest

from mocap.course.opening import stored
from mocap.course.teaching import build_slides
from tests.browser.conftest import wait_until
from tests.conftest import SWEEP

TOO_FULL = """() => {
  const section = Reveal.getCurrentSlide(), parts = [...section.querySelectorAll(".inner, .inner *")];
  const seen = parts.map(part => part.getBoundingClientRect()).filter(box => box.width && box.height);
  return [Math.max(0, ...seen.map(box => box.bottom)), Math.max(0, ...seen.map(box => box.right))];
}"""


NAMES = ("00-quickstart", *(["06-pruning"] if SWEEP else []))


@pytest.fixture(scope="module")
def decks(tmp_path_factory):
    folder, out = tmp_path_factory.mktemp("notebooks"), tmp_path_factory.mktemp("slides")
    for name in NAMES:
        shutil.copy(stored() / f"{name}.ipynb", folder)
    build_slides(folder, out)
    return out


@pytest.mark.parametrize("name", NAMES)
def test_every_slide_fits(name, decks, page):
    page.set_viewport_size({"width": 1280, "height": 720})
    page.goto((decks / f"{name}.html").as_uri())
    page.wait_for_function("window.Reveal && Reveal.isReady()")
    for number in range(page.evaluate("Reveal.getTotalSlides()")):
        page.evaluate(f"Reveal.slide({number})")
        bottom, right = page.evaluate(TOO_FULL)
        assert (bottom, right) <= (720, 1280) and right <= 1280, f"slide {number} of {name}"


def test_a_player_plays_and_keeps_its_keys(decks, page):
    page.goto((decks / "00-quickstart.html").as_uri())
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
