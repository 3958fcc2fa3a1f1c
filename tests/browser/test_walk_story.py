"""The story below the walking page: four steps that show how the walk on the reader's line is made."""

import re

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mocap.widgets.walking_page import walk_page
from tests.browser.conftest import watched_page
from tests.browser.test_walk_page import wanderers
from tests.bundled import WALKS, bundled

PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
BLOCKS = {"viewport": {"width": 844, "height": 390}}


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """Write the page of the bundled clips that only walk, as the site has it."""
    path = tmp_path_factory.mktemp("story") / "walk.html"
    path.write_text(walk_page(bundled(*WALKS), course="00-quickstart.html"), "utf-8")
    return path


def open_step(page, file, step):
    """Open the page without a moving clock, search all of its walk, and scroll to a step of the story."""
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("page.play(false); page.finish()")
    page.evaluate(f"document.querySelectorAll('.step')[{step - 1}].scrollIntoView({{ behavior: 'instant' }})")
    page.wait_for_function(f"page.story.step === {step} && page.story.pieces.length > 0")


def test_a_button_leads_to_the_story_and_another_back(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    assert page.locator("header").is_visible()
    page.get_by_role("button", name="How does it work?").click()
    page.wait_for_function("page.story.step === 1")
    assert page.get_by_role("heading", name="Pieces of clips").is_visible()
    page.get_by_role("button", name="Draw another line").click()
    page.wait_for_function("page.story.step === 0 && scrollY === 0")
    page.wait_for_function("getComputedStyle(document.querySelector('header')).visibility === 'visible'")


def test_each_step_has_at_most_three_sentences_and_a_thing_to_do(page, file):
    page.goto(f"file://{file}?flat")
    cards = page.locator(".step .card")
    assert cards.count() == 4
    for number in range(4):
        told = cards.nth(number).locator("h2 + p").first.inner_text()
        sentences = re.findall(r"[.?!](?=\s|$)", told)
        assert len(sentences) <= 4, told  # three, and the question that the thing to do answers
        assert cards.nth(number).locator("button, input").count()
    assert page.get_by_role("link", name="Notebook 00").get_attribute("href") == "00-quickstart.html"


def test_a_page_without_a_course_names_the_command(page, tmp_path):
    (tmp_path / "walk.html").write_text(walk_page(bundled(WALKS[0])), "utf-8")
    page.goto(f"file://{tmp_path}/walk.html?flat")
    assert page.locator("#story code").inner_text() == "mocap lab"


def test_a_wheel_scrolls_and_draws_nothing_in_the_story(page, file):
    open_step(page, file, 1)
    line = page.evaluate("page.line.z.length")
    yaw = page.evaluate("page.camera.hand.yaw")
    page.mouse.move(300, 300)
    page.mouse.down()
    page.mouse.move(500, 320, steps=5)
    page.mouse.up()
    assert page.evaluate("page.line.z.length") == line
    assert page.evaluate("page.camera.hand.yaw") != yaw  # the hand turns the view instead
    page.mouse.wheel(0, -3000)
    page.wait_for_function("page.story.step === 0")


def test_the_pieces_are_those_of_the_walk(page, file):
    open_step(page, file, 1)
    pieces = page.evaluate("page.story.pieces")
    owners = page.evaluate(
        """() => page.walk.edges.flatMap((edge) => Array.from({ length: edge.frames }, (_, i) =>
        edge.seam && i >= edge.frames / 2 ? edge.end.clip : edge.start.clip))"""
    )
    assert [piece["begin"] for piece in pieces[1:]] == [piece["end"] for piece in pieces[:-1]]
    for piece in pieces:
        assert set(owners[piece["begin"] : piece["end"]]) == {piece["clip"]}
    buttons = page.locator("#clips button")
    used = sorted({piece["clip"] for piece in pieces})
    assert buttons.count() == len(page.evaluate("page.about.clips"))
    buttons.nth(used[-1]).click()
    assert page.evaluate("page.time") == next(p["begin"] for p in pieces if p["clip"] == used[-1])
    assert buttons.nth(used[-1]).get_attribute("aria-pressed") == "true"
    stripes = buttons.nth(used[-1]).locator("b").count()
    assert stripes == sum(piece["clip"] == used[-1] for piece in pieces)


JUMPS = """() => {
  const seam = page.story.currentSeam();
  const positions = [seam.frame - 1, seam.frame].map((time) => {
    page.time = time;
    return page.story.bodies()[0].positions;
  });
  return positions;
}"""


def test_holding_cuts_and_the_body_jumps(page, file):
    open_step(page, file, 2)
    assert page.evaluate("page.story.bodies().length") == 3
    blended = np.array(page.evaluate(JUMPS))
    page.locator("#cut").hover()
    page.mouse.down()
    assert page.evaluate("page.cut")
    page.evaluate("page.play(false)")
    cut = np.array(page.evaluate(JUMPS))
    page.mouse.up()
    assert not page.evaluate("page.cut")
    assert page.evaluate(JUMPS) == blended.tolist()
    told = int(re.search(r"jumps here by (\d+) cm", page.locator("#jump").inner_text())[1]) / 100

    def largest_step(positions):
        return np.linalg.norm(np.diff(positions, axis=0), axis=-1).max()

    assert largest_step(cut) > largest_step(blended)
    # The jump that is named is that of one instant. In a frame, a swinging foot also moves by 15 cm.
    assert abs(largest_step(cut) - told) < 0.2
    page.keyboard.down("c")
    assert page.evaluate("page.cut")
    page.keyboard.up("c")
    assert not page.evaluate("page.cut")


def test_walks_at_random_follow_the_graph_and_miss_the_line(page, file):
    open_step(page, file, 3)
    for _ in range(10):
        page.click("#chance")
    tracks = page.evaluate("page.story.wandering")
    assert len(tracks) == 8  # the last ones
    start = page.evaluate("page.positionAt(page.walk.since)")
    for track in tracks:
        assert np.hypot(*np.subtract(track[-1], start)) < 0.3  # tracks run from their ends to their starts
        steps = np.hypot(*np.diff(track, axis=0).T)
        assert steps.max() < 0.3  # metres in four frames
    told = page.locator("#strayed").inner_text()
    off = float(re.search(r"This one is (\d+\.\d) m", told)[1])
    line = page.evaluate("page.points.slice(0, 1200)")
    missed, _ = cKDTree(tracks[-1]).query(line)
    assert off == pytest.approx(missed.mean(), abs=0.1)


def test_the_slow_search_keeps_as_many_walks_as_it_says(page, file):
    open_step(page, file, 4)
    kept = """(beam) => {
      const slider = document.querySelector("#beam");
      slider.value = String(beam);
      slider.dispatchEvent(new Event("input"));
      page.play(false);
      const { search } = page.story;
      const counts = [];
      for (search.step(); !search.done; search.step()) counts.push(search.kept);
      page.story.result.textContent = page.story.foundWords(search);
      return counts;
    }"""
    widths = [1, 3, 10, 30, 150]
    offs = []
    for number, width in enumerate(widths):
        counts = page.evaluate(kept, number)
        assert max(counts) <= width
        words = page.locator("#kept").inner_text()
        offs.append(np.inf if "none" in words else int(words.split()[0]))
    assert max(counts) > 30
    assert offs[-1] <= offs[0]
    assert offs[-1] <= 15  # centimetres, of a walk that is not bent onto the line
    assert page.locator("#beam").get_attribute("aria-valuetext") == "150 walks kept"


def test_the_walk_that_the_slow_search_finds_follows_the_line(page, file):
    open_step(page, file, 4)
    best = page.evaluate("""() => {
      const { search } = page.story;
      while (!search.done) search.step();
      return search.found;
    }""")
    line = page.evaluate("page.points.slice(0, 601)")
    missed, _ = cKDTree(best).query(line)
    assert missed.mean() < 0.2


def test_the_map_has_words_and_pointing_at_a_seam_shows_both_moments(page, file):
    page.goto(f"file://{file}?flat")
    page.wait_for_function("window.page?.walk.frames")
    page.evaluate("page.play(false); page.finish(); page.view(true); page.aim(0, true)")
    page.wait_for_function("page.ticks > 8 && document.querySelector('#now').textContent")
    assert page.locator("#now").inner_text() in {name.replace("_", " ") for name in WALKS}
    assert "seams as arcs" in page.locator("#map").inner_text()
    before = page.evaluate("[page.time, page.bodies().length]")
    seam = page.evaluate("""() => {
      const m = page.camera.view(page.width, page.height).view;
      const [z, x] = page.positionAt(page.seams()[1].frame);
      const w = m[3] * x + m[11] * z + m[15];
      return [(1 + (m[0] * x + m[8] * z + m[12]) / w) * page.width / 2,
        (1 - (m[1] * x + m[9] * z + m[13]) / w) * page.height / 2];
    }""")
    page.mouse.move(*seam)
    assert "Two similar moments" in page.locator("#moments").inner_text()
    assert page.evaluate("page.bodies().length") == before[1] + 2
    assert page.evaluate("page.shown") is None  # the walk goes on
    page.mouse.move(2, 2)
    assert not page.locator("#moments").is_visible()
    assert page.evaluate("page.bodies().length") == before[1]


@pytest.mark.parametrize("screen", [PHONE, BLOCKS, {"viewport": {"width": 1600, "height": 900}}])
def test_cards_and_figure_have_room(browser, file, screen):
    with watched_page(browser, **screen) as (page, faults):
        for step in range(1, 5):
            open_step(page, file, step)
            page.evaluate("page.aim(0, true)")
            assert page.evaluate("document.documentElement.scrollWidth") <= screen["viewport"]["width"]
            card = page.locator(".step .card").nth(step - 1).bounding_box()
            assert card["width"] >= 280
            assert card["x"] + card["width"] <= screen["viewport"]["width"] + 1
            middle = page.evaluate("""() => {
              const { at } = page.camera;
              return [(1 - at.aside) / 2 * page.width, (1 - at.below) / 2 * page.height];
            }""")
            inside = card["x"] <= middle[0] <= card["x"] + card["width"] and card["y"] <= middle[1]
            assert not inside, step
    assert faults == []


def test_the_steps_refer_to_a_new_line(page, file):
    open_step(page, file, 3)
    page.click("#chance")
    pieces = page.evaluate("page.story.pieces")
    page.evaluate("page.set(Array.from({ length: 400 }, (_, i) => [0.01 * i, 0]), { anew: true })")
    page.evaluate("page.finish()")
    page.wait_for_function("page.story.wandering.length === 0")
    assert page.evaluate("page.story.pieces") != pieces
    assert page.evaluate("page.story.pieces.at(-1).end") == page.evaluate("page.walk.frames")


def test_a_walk_of_any_clips_has_a_story(page, tmp_path):
    (tmp_path / "walk.html").write_text(walk_page(wanderers(3)), "utf-8")
    open_step(page, tmp_path / "walk.html", 2)
    assert page.evaluate("page.story.bodies().length") in (1, 3)
