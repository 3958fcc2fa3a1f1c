"""The course in JupyterLab, as a reader meets it: most tests share one notebook that is run once.

All notebooks of the course, in five minutes: pytest -m "exhaustive or not exhaustive" -n 0 -k all_its_sliders
"""

from textwrap import dedent

import nbformat
import numpy as np
import pytest

from mocap.blending import register
from mocap.datasets import sample
from mocap.widgets import Mixer
from tests.browser import test_questions as questions
from tests.browser.conftest import drag, keep, run_notebook, wait_until, watched_page
from tests.browser.test_blind import take
from tests.course.stored_notebooks import FOLDER

CELLS = {
    "start": """
        import ipywidgets, matplotlib.pyplot as plt, numpy as np, time, warnings
        from mocap import MocapWarning
        from mocap import blending, datasets, matching, plotting, resample
        from mocap.body import joint_positions
        from mocap.plotting import show
        from mocap.widgets import Mixer, draw_path, explore, play
        walk = resample(datasets.sample("walk_circle"), 30)[:240]
        points = joint_positions(walk)
""",
    "explore": """
        body = plotting.StickFigure(walk.skeleton, plotting.ground_axes((0, 0), 3.0))
        def pose(frame=0):
            if frame == 239:
                raise ValueError("here the clip ends")
            return body.pose(points[frame])
        explore(pose, alt="A stick figure at a frame.", frame=(0, 239))""",
    "choose": """
        def steps(side="left", count=60, seam=False):
            colour = plotting.COLOURS[side]
            drawn = plotting.path_from_above(walk[:count], colour=colour)
            drawn[0].set_linestyle(":" if seam else "-")
            return drawn
        count = ipywidgets.SelectionSlider(options=[60, 120, 240], value=60)
        explore(steps, alt="A path from above.", side=["left", "right"], count=count, seam=False)""",
    "show": 'show(plotting.path_from_above(walk), alt="The path of a walk.")',
    "drag": """
        from mocap.widgets import handles
        ax = plt.figure(figsize=(5, 5)).add_subplot(xlim=(3, -3), ylim=(0, 6), xlabel="x (m)", ylabel="z (m)")
        (bent,) = ax.plot([], [])
        def bend(way):
            bent.set_data(*zip(*way))
            return [bent]
        explore(bend, alt="A line through handles.", way=handles(ax, [[0, 1], [0, 3], [0, 5]]))""",
    "wide": """
        wide = plt.figure(figsize=(12, 2))
        (dot,) = wide.add_subplot(xlim=(0, 1)).plot([0], [0], "o")
        drawn_at = ipywidgets.Label("")
        def slow(share=0.0):
            time.sleep(0.3)
            drawn_at.value += f" {share:.2f}"
            dot.set_xdata([share])
            return wide
        explore(slow, alt="A dot on a wide picture.", share=(0.0, 1.0, 0.01))""",
    "drawn_at": "drawn_at",
    "play": "play(walk)",
    "draw": """
        def follow(path):
            length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
            if length < 1:
                raise ValueError("a path of less than a metre")
            drawn.value = f"Python was asked for {length:.1f} m"
            warnings.warn("The walk leaves the path once.", MocapWarning)
            return walk[: 60 + 10 * len(path)]
        drawn = ipywidgets.Label()
        canvas = draw_path(follow, [[0, 0], [1, 2], [0, 4]])
        canvas""",
    "drawn": "drawn",
    "blind": """
        from mocap.course.lab.blind_tests import BlindTest, choose, make_pairs
        whole = [datasets.sample("walk_curve_1")[:2400:4]]
        four = choose(whole, matching.find_transitions(whole, window=10, below=0.06), 0.06, seed=0, count=4)
        BlindTest(make_pairs(whole, four, 2, seed=0), 2, 0.06, 0)""",
    "mix": """
        both = blending.register([datasets.sample(f"walk_5m_1.1_{turn}") for turn in (-120, 120)])
        mixer = Mixer(both, [1, 0])
        mixer""",
    "steer": """
        import math
        from mocap.widgets import steered
        from mocap.widgets.embedding import joined
        from tests.widgets.steerable import Dot
        steered({"quick": Dot(), "slow": Dot(0.7)})""",
}
PLAYER = ".mocap-player:visible"


def written(cells):
    """Write a notebook of cells."""
    kernel = {"name": "python3", "display_name": "Python 3"}
    return nbformat.writes(nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel}))


@pytest.fixture(scope="module")
def ran(browser, lab):
    """Run a notebook of all cells; yield the page and its faults."""
    notebook = written([nbformat.v4.new_code_cell(dedent(text).strip()) for text in CELLS.values()])
    with watched_page(browser) as (page, faults):
        run_notebook(lab, page, notebook, "all.ipynb")
        yield page, faults


@pytest.fixture
def notebook(ran, request):
    """Yield the page, and a function that finds a cell's output; afterwards there must be no faults."""
    page, faults = ran
    order = list(CELLS)

    def cell(name):
        found = page.locator(".jp-Notebook .jp-CodeCell").nth(order.index(name))
        found.scroll_into_view_if_needed()
        return found

    yield page, cell
    keep(page, request.node.name)
    assert faults == []


def state(place):
    """Return the frame that a player shows, or -1 before it has drawn one."""
    frame = "root => root.player?.pictures ? root.player.frame() : -1"
    return place.locator(PLAYER).evaluate(frame)


def test_a_slider_moves_the_picture_and_an_error_takes_its_place(notebook):
    page, cell = notebook
    experiment = cell("explore")
    picture = experiment.locator(".mocap-picture")
    wait_until(lambda: picture.is_visible())
    first = picture.get_attribute("src")
    experiment.locator(".noUi-handle").focus()
    page.keyboard.press("ArrowRight")
    wait_until(lambda: picture.get_attribute("src") != first)
    page.keyboard.press("End")
    error = experiment.get_by_text("ValueError: here the clip ends")
    wait_until(lambda: error.is_visible())
    assert not picture.is_visible()
    page.keyboard.press("Home")
    wait_until(lambda: picture.is_visible())
    wait_until(lambda: not error.is_visible())


def test_a_choice_a_slider_of_choices_and_a_box_change_the_picture(notebook):
    _, cell = notebook
    place = cell("choose")
    picture = place.locator(".mocap-picture")
    for move in (
        lambda: place.locator("select").select_option("right"),
        lambda: place.locator(".noUi-handle").press("End"),
        lambda: place.get_by_role("checkbox").check(),
    ):
        before = picture.get_attribute("src")
        move()
        wait_until(lambda before=before: picture.get_attribute("src") != before)
    assert place.locator(".widget-readout").inner_text() == "240"


def test_a_shown_picture_has_its_alt_text_and_is_dimmed_in_the_dark_theme(notebook):
    page, cell = notebook
    picture = cell("show").get_by_role("img", name="The path of a walk.")
    wait_until(picture.is_visible)
    assert picture.evaluate("img => img.naturalWidth") > 400
    for light, seen in (("false", "brightness(0.8)"), ("true", "none")):
        page.evaluate(f"document.body.dataset.jpThemeLight = '{light}'")
        assert picture.evaluate("img => getComputedStyle(img).filter") == seen


@pytest.mark.parametrize("width", [600, 1280])
def test_pictures_fit_the_width_that_there_is(notebook, width):
    page, cell = notebook
    page.set_viewport_size({"width": width, "height": 900})
    try:
        for name in ("wide", "explore", "drag", "choose", "draw"):
            place = cell(name)
            output = place.locator(".jp-OutputArea-output:visible").last.bounding_box()
            for part in place.locator(":is(.mocap-picture, canvas):visible").all():
                box = part.bounding_box()
                assert box["x"] + box["width"] <= output["x"] + output["width"] + 1, name
                assert box["width"] > 200, name
    finally:
        page.set_viewport_size({"width": 1200, "height": 900})


def test_a_slow_picture_moves_while_a_slider_is_dragged_and_ends_where_it_ends(notebook):
    page, cell = notebook
    label = cell("drawn_at").locator(".widget-label")

    def drawn():
        return [float(text) for text in label.text_content().split()]

    box = cell("wide").locator(".noUi-handle").bounding_box()
    page.mouse.move(box["x"] + 5, box["y"] + 5)
    page.mouse.down()
    for step in range(1, 21):
        page.mouse.move(box["x"] + 5 + 6 * step, box["y"] + 5)
        if step % 4 == 0:  # however slow the machine is, pictures follow while the mouse is held
            wait_until(lambda step=step: len(drawn()) >= step // 4)
    page.mouse.up()
    share = float(cell("wide").locator(".widget-readout").inner_text())
    wait_until(lambda: drawn()[-1] == pytest.approx(share, abs=0.006))
    assert drawn() == sorted(drawn())


def test_sliders_and_pictures_have_names(notebook):
    _, cell = notebook
    assert cell("explore").get_by_role("slider", name="frame").is_visible()
    assert cell("wide").get_by_role("slider", name="share").is_visible()
    assert cell("explore").locator(".mocap-picture").get_attribute("alt") == "A stick figure at a frame."


def test_a_handle_is_dragged_by_the_mouse_and_moved_by_keys_and_the_line_follows(notebook):
    page, cell = notebook
    place = cell("drag")
    handle, status = place.get_by_role("button", name="handle 2"), place.get_by_role("status")
    drawn = place.locator(".mocap-dragging img")
    before, box = drawn.get_attribute("src"), handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    drag(page, (x, y), (x + 40, y - 30), steps=4)
    wait_until(lambda: drawn.get_attribute("src") != before)
    across, up = (float(part.split()[-1]) for part in status.inner_text().split(", "))
    assert -1.0 < across < -0.3  # the axis of x points to the left
    assert 3.2 < up < 4.0
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Shift+ArrowLeft")
    wait_until(lambda: f"x {across + 0.5:.2f}, z {up + 0.05:.2f}" in status.inner_text())
    for _ in range(20):
        page.keyboard.press("Shift+ArrowUp")
    wait_until(lambda: "z 6.00" in status.inner_text())  # no handle leaves the axes


def test_a_player_plays_in_an_output_and_takes_its_keys(notebook):
    page, cell = notebook
    place = cell("play")
    wait_until(lambda: state(place) > 5)
    place.locator("canvas:visible").focus()
    page.keyboard.press(" ")
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    assert state(place) == 1
    place.get_by_role("slider").focus()
    page.keyboard.press("ArrowRight")
    assert state(place) == 2


def test_a_slider_changes_a_blend_while_it_plays_and_the_body_walks_on(notebook):
    page, cell = notebook
    place = cell("mix")
    player = place.locator(PLAYER)
    wait_until(lambda: state(place) >= 0)
    place.locator("canvas:visible").focus()
    page.keyboard.press("Home")
    player.evaluate("root => { root.player.speed = 0.2; }")  # so that no wait takes the body round
    place.get_by_role("button", name="play").click()
    wait_until(lambda: state(place) > 30)
    number = player.evaluate("root => root.player.scene.number")
    place.locator(".noUi-handle").nth(1).focus()
    page.keyboard.press("End")
    wait_until(lambda: player.evaluate("root => root.player.scene.number") > number)
    wait_until(lambda: player.get_attribute("data-playing") == "true")
    frame = player.evaluate("root => root.player.model.get('move')[1]")
    assert frame >= 25  # it goes on from where it was
    mixer = Mixer(register([sample(f"walk_5m_1.1_{turn}") for turn in (-120, 120)]), [1, 0])
    mixer.player.at = [mixer.player.scene["number"], frame]
    mixer.sliders[1].value = 1.0
    end = player.evaluate("root => root.player.characters[0].path.at(-1).slice(1)")
    assert end == pytest.approx(mixer.player.player.motions[0].root_positions[-1, [0, 2]], abs=2e-3)


def test_a_path_that_is_drawn_is_walked(notebook):
    page, cell = notebook
    place = cell("draw")
    wait_until(lambda: state(place) >= 0)
    box = place.locator("canvas:visible").bounding_box()

    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.6
    drag(page, (x, y), (x + 100, y + 10), (x + 160, y + 60), (x + 60, y + 90))
    wait_until(lambda: place.locator(PLAYER).get_attribute("data-playing") == "true")
    wait_until(lambda: cell("drawn").get_by_text("Python was asked for").is_visible())
    cell("draw")
    asked = place.locator(PLAYER).evaluate("root => root.player.scene.asked.length")
    assert asked > 5
    assert "The walk leaves the path once." in place.locator(".message:visible").inner_text()
    drag(page, (x, y), (x + 3, y))
    wait_until(lambda: place.get_by_text("Drag over the ground for at least 0.5 m.").is_visible())
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    wait_until(lambda: place.get_by_text("That is 0.0 m.").is_visible())


# The page itself looks at which frame the next scene begins: on a busy machine, asking takes seconds.
SETS_OUT = """(root) => {
    const { player } = root, { number } = player.scene;
    root.first = new Promise((done) => {
        const look = () => player.scene.number > number ? done(player.frame()) : requestAnimationFrame(look);
        look();
    });
    return number;
}"""


def test_each_new_drawing_sets_out_while_the_last_walk_plays(notebook):
    page, cell = notebook
    place = cell("draw")
    wait_until(lambda: state(place) >= 0)
    box = place.locator("canvas:visible").bounding_box()
    player = place.locator(PLAYER)
    for redraw in range(3):
        number = player.evaluate(SETS_OUT)
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.6
        drag(page, *((x + (15 + redraw) * k, y + 8 * k) for k in range(8)), steps=1)
        frame = player.evaluate("root => root.first")
        assert player.evaluate("root => root.player.scene.number") == number + 1
        assert frame < 40, redraw
        wait_until(lambda: player.get_attribute("data-playing") == "true")
        start = state(place)
        wait_until(lambda start=start: state(place) > start + 2)


def test_a_path_is_drawn_by_the_keys(notebook):
    page, cell = notebook
    place = cell("draw")
    wait_until(lambda: state(place) >= 0)
    player = place.locator(PLAYER)
    number = player.evaluate("root => root.player.scene.number")
    place.locator("canvas:visible").focus()
    for key in ("p", *["ArrowUp"] * 6, *["ArrowRight"] * 5, "Backspace"):
        page.keyboard.press(key)
    drawn = player.evaluate("root => root.player.hand.drawn")
    assert len(drawn) == 11
    assert player.evaluate("root => root.player.hand.metres") == pytest.approx(10 * 0.25, abs=0.01)
    page.keyboard.press("Enter")
    wait_until(lambda: player.evaluate("root => root.player.scene.number") == number + 1)
    assert np.allclose(player.evaluate("root => root.player.scene.asked"), drawn, atol=1e-3)
    page.keyboard.press("p")
    page.keyboard.press("Escape")
    assert player.evaluate("root => root.player.hand.pen") is False


def test_a_blind_test_is_answered_by_keys(notebook):
    page, cell = notebook
    cell("blind")
    said = take(page, lambda _, side: page.keyboard.press(f"Arrow{side.title()}"))
    assert said.startswith("You chose right in 4 of 4 pairs")


def test_keys_steer_and_nothing_else(notebook):
    page, cell = notebook
    root = cell("steer").locator(".mocap-steering:visible")
    wait_until(lambda: root.evaluate("root => root.steering?.pictures > 0"))
    count = page.locator(".jp-CodeCell").count()
    root.locator(".panels").focus()
    for key in ("a", "s", "d", "d", "w", "a"):  # in JupyterLab: cell above, save, delete this cell
        page.keyboard.press(key)
    assert page.locator(".jp-CodeCell").count() == count
    wait_until(lambda: root.evaluate("root => root.steering.latencies.length"))
    wait_until(lambda: "mean of" in root.locator("figcaption").first.inner_text())


def test_a_notebook_that_is_opened_again_shows_pictures(ran):
    page, _ = ran
    run = "jupyterapp.commands.execute"
    page.evaluate(f"{run}('docmanager:save')")
    page.evaluate("jupyterapp.shell.currentWidget.sessionContext.shutdown()")
    page.reload()
    wait_until(lambda: page.locator(".jp-CodeCell").count() >= len(CELLS), 60)
    order = list(CELLS)
    for name in ("explore", "choose", "drag", "draw", "steer"):
        place = page.locator(".jp-Notebook .jp-CodeCell").nth(order.index(name))
        place.scroll_into_view_if_needed()
        still = place.locator(".mocap-still")
        wait_until(still.is_visible)
        assert "Error displaying widget" not in place.inner_text()
        assert still.locator("img, canvas").first.is_visible()
    assert "Run the cell to steer" in still.inner_text()


@pytest.fixture(scope="module")
def opened(browser, lab):
    cells = written([questions.cell(text) for text in questions.CELLS])
    with questions.asking(browser, lambda page: run_notebook(lab, page, cells, "questions.ipynb")) as asked:
        yield asked


test_an_answer_opens_when_a_bet_is_kept = (
    questions.test_an_answer_opens_when_a_bet_is_kept_and_the_page_remembers
)
test_quizzes_mark_themselves = questions.test_quizzes_mark_themselves


# The first has players, sliders, choices and a canvas to draw on.
# The experiments of all notebooks are driven without a browser, by tests/course/driving.py.
NOTEBOOKS = [
    pytest.param(path, id=path.stem, marks=[pytest.mark.exhaustive] * (path.stem != "00-quickstart"))
    for path in sorted(FOLDER.glob("*.ipynb"))
]
FAILED = ".jp-OutputArea-output[data-mime-type='application/vnd.jupyter.error']"


@pytest.mark.parametrize("file", NOTEBOOKS)
def test_it_runs_and_all_its_sliders_move(file, run, page, request):
    if file.stem == "10-real-data":
        request.getfixturevalue("real_data")
    page.emulate_media(reduced_motion="reduce")  # no player plays while sliders are moved
    run(file.read_text("utf-8"), file.name)
    assert page.locator(FAILED).count() == 0
    for number in range(page.locator(".noUi-handle").count()):
        handle = page.locator(".noUi-handle").nth(number)
        handle.scroll_into_view_if_needed()
        handle.focus()
        box = handle.locator("xpath=ancestor::*[contains(@class, 'widget-vbox')]").first
        for key, end in (("End", "aria-valuemax"), ("Home", "aria-valuemin")):
            page.keyboard.press(key)
            wait_until(lambda h=handle, e=end: h.get_attribute("aria-valuenow") == h.get_attribute(e))
            page.wait_for_timeout(300)
            assert "Error:" not in box.inner_text()
