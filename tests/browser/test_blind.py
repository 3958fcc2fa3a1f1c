"""The blind test as a viewer takes it: by keys, by touch; test_lab.py takes it in JupyterLab."""

import numpy as np
import pytest

from mocap import datasets
from mocap.course.lab.blind_tests import BlindTest, choose, make_pairs
from mocap.course.lab.sensitivity import class_curve, d_prime, read_answers
from mocap.matching import find_transitions
from tests.browser.conftest import wait_until

TEST = "document.querySelector('.mocap-blindtest').blindtest"


@pytest.fixture(scope="module")
def blind():
    clips = [datasets.sample("walk_curve_1")[:2400:4]]
    four = choose(clips, find_transitions(clips, window=10, below=0.06), 0.06, seed=0, count=4)
    return BlindTest(make_pairs(clips, four, 2, seed=0), 2, 0.06, 0)


@pytest.fixture
def opened(page, blind, tmp_path):
    file = tmp_path / "blind.html"
    file.write_text(blind.page(), "utf-8")
    page.goto(file.as_uri())
    return page


def take(page, choose):
    """Start, and answer each pair once it plays: `choose` gets a pair's number and the side of the seam."""
    page.get_by_role("button", name="Start the test").click()
    for number, on_left in enumerate(page.evaluate(f"{TEST}.spec.onLeft")):
        wait_until(
            lambda n=number: f"Pair {n + 1} of" in page.locator(".mocap-blindtest [role=status]").inner_text()
        )
        wait_until(lambda: page.evaluate(f"{TEST}.since && performance.now() - {TEST}.since > 450"))
        choose(number, "left" if on_left else "right")
    return page.locator(".mocap-blindtest [role=status]").inner_text()


def test_a_perfect_eye_is_said_so_and_its_file_is_read(opened, tmp_path):
    said = take(opened, lambda _, side: opened.keyboard.press(f"Arrow{side.title()}"))
    assert said.startswith("You chose right in 4 of 4 pairs")
    opened.get_by_role("textbox", name="a name or number for the file").fill("Ada, 1st")
    with opened.expect_download() as download:
        opened.get_by_role("button", name="Save my answers").click()
    assert download.value.suggested_filename == "blind-Ada-1st-6cm-2.csv"
    download.value.save_as(tmp_path / "ada.csv")
    assert class_curve(read_answers([tmp_path / "ada.csv"]), "window") == {2.0: d_prime(4, 4)}


def test_the_films_move_and_touch_answers(opened):
    seen = []

    def wrong(number, side):
        if number == 0:
            for _ in range(2):
                seen.append(opened.locator("canvas").first.screenshot())
                opened.wait_for_timeout(200)
        other = {"left": "right", "right": "left"}[side]
        opened.get_by_role("button", name=f"the {other} one").click()

    assert take(opened, wrong).startswith("You chose right in 0 of 4 pairs: d′ = −")
    assert seen[0] != seen[1]


# In each picture of 0.3 s, by the page's own clock: on a busy machine, each key of Playwright's takes long.
HELD = f"""async () => {{
    for (const start = performance.now(); performance.now() - start < 300; ) {{
        {TEST}.root.dispatchEvent(new KeyboardEvent("keydown", {{ key: "ArrowLeft" }}));
        await new Promise(requestAnimationFrame);
    }}
}}"""


def test_a_key_held_down_does_not_answer_two_pairs(opened):
    opened.get_by_role("button", name="Start the test").click()
    wait_until(lambda: opened.evaluate(f"{TEST}.since && performance.now() - {TEST}.since > 450"))
    opened.evaluate(HELD)
    assert opened.evaluate(f"{TEST}.answers.length") == 1


def test_the_browser_draws_the_films_that_python_made(opened, blind):
    opened.get_by_role("button", name="Start the test").click()
    wait_until(lambda: opened.evaluate(f"{TEST}.films?.length === 8"))
    root = opened.evaluate(f"{TEST}.films.map((film) => Array.from(film.pose(1).subarray(0, 3)))")
    films = [film for pair in blind.pairs for film in (pair.seam, pair.control)]
    assert np.allclose(root, [film.root_positions[30] for film in films], atol=0.002)
