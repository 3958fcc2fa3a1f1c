"""Time of pictures of experiments, figures and the player, as ratios within one run; sizes of pages.

A picture in Python is compared with drawing a figure of empty axes, a picture in a browser with one of an
empty page. In a browser time is measured by the clock, so the machine should do nothing else meanwhile.

See the ratios: pytest -m benchmark -n 0 tests/benchmarks/test_seeing.py
"""

import statistics
from functools import partial

import matplotlib

matplotlib.use("agg")

import matplotlib.pyplot as plt
import numpy as np
import psutil
import pytest
from nbformat.v4 import new_code_cell
from walking import generate_walk

from mocap.body import PlanarTransform, joint_positions
from mocap.datasets.samples import sample
from mocap.graphs.motion_graph import from_transitions
from mocap.matching.transitions import Transition
from mocap.plotting import graph_drawing, grids, stick_figures
from mocap.widgets import explore, play
from tests.benchmarks.timing import draw_empty_axes, fastest, hold, ratio
from tests.browser.conftest import browser, lab, page, run_notebook, shaded, wait_until  # noqa: F401
from tests.browser.test_lab import written
from tests.browser.test_page import PLAYER, twelve
from tests.strategies import wave

pytestmark = pytest.mark.benchmark
PICTURES_BOUND = 1.1  # pictures of an empty page for each of ours: 55 beside 60 in a second


@pytest.fixture(scope="module")
def minute():
    """Return three characters of 38 joints, 60 s at 120 Hz."""
    return [generate_walk([[x, 0], [x, 55]], speed=0.85)[: 60 * 120] for x in (-1, 0, 1)]


def median_change(experiment):
    """Return the median CPU seconds of a change of an experiment's frame."""
    slider = experiment.controls["frame"]
    return statistics.median(
        fastest(partial(setattr, slider, "value", frame), repeats=1)[0] for frame in range(0, 800, 40)
    )


def test_an_experiment_changes_in_the_time_of_a_few_empty_pictures():
    motion = sample("walk_circle")[:1200]
    points = joint_positions(motion)
    body = stick_figures.StickFigure(motion.skeleton, stick_figures.ground_axes((0, 0), 3.0))
    blitted = explore(lambda frame: body.pose(points[frame]), alt="A pose.", frame=(0, 1199))

    def new_figure(frame):
        ax = stick_figures.ground_axes((0, 0), 3.0)
        stick_figures.StickFigure(motion.skeleton, ax).pose(points[frame])
        return ax.figure

    whole = explore(new_figure, alt="A pose.", frame=(0, 1199))
    blitted_seconds = median_change(blitted)
    empty_seconds = fastest(draw_empty_axes)[0]
    hold("a change of an experiment, in empty axes", blitted_seconds / empty_seconds, 0.5)
    hold("a change, in one with a new figure", blitted_seconds / median_change(whole), 1 / 3)


def draw(make):
    """Draw the pixels of the figure that a function makes, and close it."""
    make()
    plt.gcf().canvas.draw()
    plt.close()


def test_a_grid_is_drawn_in_the_time_of_a_few_empty_pictures():
    grid = np.random.default_rng(0).random((1000, 1000))
    image = partial(draw, lambda: grids.distance_image(grid, fps=30))
    hold("a grid of 1000 by 1000, in empty axes", ratio(image, draw_empty_axes), 8)


@pytest.mark.parametrize(("count", "bound"), [(1000, 12), (5000, 18)])
def test_a_timeline_of_5000_transitions_is_drawn_in_the_time_of_some_empty_pictures(count, bound):
    random = np.random.default_rng(0)
    clips = [wave(900, name=f"clip{k}") for k in range(8)]
    ends = random.integers(0, [8, 880, 8, 880], size=(5000, 4)).tolist()
    transitions = [Transition(a, i, b, j, random.random(), PlanarTransform(0, 0, 0)) for a, i, b, j in ends]
    graph = from_transitions(clips, transitions, window=10)
    timeline = partial(draw, lambda: graph_drawing.timeline(graph, most=count))
    hold(f"a timeline of {count} transitions, in empty axes", ratio(timeline, draw_empty_axes, 3), bound)


def test_a_minute_of_three_characters_is_sent_in_2_mb(minute):
    hold("megabytes of a page, three characters for a minute", len(play(*minute).page()) / 1e6, 2)


EMPTY_PAGE = """() => {
  window.empty = { pictures: 0 };
  const count = () => { window.empty.pictures += 1; requestAnimationFrame(count); };
  requestAnimationFrame(count);
}"""


def pictures_per_second(page, counter, times=4):  # noqa: F811
    """Count the pictures in two seconds, several times, and return the highest rate."""
    rates = []
    for _ in range(times):
        page.wait_for_timeout(500)
        first, start = page.evaluate(f"[{counter}.pictures, performance.now()]")
        page.wait_for_timeout(2000)
        last, end = page.evaluate(f"[{counter}.pictures, performance.now()]")
        rates.append(1000 * (last - first) / (end - start))
    return max(rates)


def empty_pictures_per_second(page):  # noqa: F811
    """Return the rate of an empty page, the highest that this browser has."""
    page.goto("about:blank")
    page.evaluate(EMPTY_PAGE)
    return pictures_per_second(page, "window.empty", times=2)


def open_player(page, address):  # noqa: F811
    """Open a player's file at 1200 by 800, and wait for its first picture."""
    page.set_viewport_size({"width": 1200, "height": 800})
    page.goto(address)
    wait_until(lambda: page.evaluate(f"{PLAYER}?.pictures > 0"))


def browser_seconds():
    """Sum the CPU seconds of the browser's processes."""
    return sum(sum(process.cpu_times()[:2]) for process in psutil.Process().children(recursive=True))


def cost_of_a_picture(page):  # noqa: F811
    """Return the CPU seconds of the whole browser for a picture of the player."""
    page.wait_for_timeout(2500)
    first = page.evaluate(f"{PLAYER}.pictures")
    start = browser_seconds()
    page.wait_for_timeout(5000)
    return (browser_seconds() - start) / (page.evaluate(f"{PLAYER}.pictures") - first)


@shaded
@pytest.mark.parametrize(("count", "bound"), [(1, 4), (12, 9)])
def test_shaded_bodies_cost_a_few_times_what_strokes_do(page, tmp_path, count, bound):  # noqa: F811
    """WebGL is done in software here; where that is slow, the player lowers its resolution."""
    file = tmp_path / "bodies.html"
    file.write_text(twelve(count).page(), "utf-8")
    open_player(page, file.as_uri())
    shaded = cost_of_a_picture(page)
    open_player(page, f"{file.as_uri()}?flat")
    hold(f"a shaded picture of {count}, in one of strokes", shaded / cost_of_a_picture(page), bound)


@pytest.mark.parametrize("view", ["perspective", "above"])
def test_the_player_shows_twelve_as_lines_as_often_as_an_empty_page(page, tmp_path, view):  # noqa: F811
    file = tmp_path / "twelve.html"
    file.write_text(twelve().page(), "utf-8")
    empty = empty_pictures_per_second(page)
    open_player(page, f"{file.as_uri()}?flat")
    page.evaluate(f"{PLAYER}.camera.pitch = {0.25 if view == 'perspective' else 1.5}")
    player = pictures_per_second(page, PLAYER)
    hold(f"a picture of twelve in {view}, in empty pages", empty / player, PICTURES_BOUND)


WITHOUT_WEBGL = """const { prototype } = HTMLCanvasElement;
prototype.getContext = new Proxy(prototype.getContext, {
  apply: (get, canvas, args) => (args[0].startsWith("webgl") ? null : Reflect.apply(get, canvas, args)),
})"""
STEERED = """
from mocap.methods import motion_matching, parametric_graphs
from mocap.steering import Controller
from mocap.widgets import steered
from tests.bundled import clips, walking
from tests.methods.parametric_graphs.built import stepping
page = steered({
    "motion graph": Controller(walking()),
    "steps": parametric_graphs.ParametricController(stepping()),
    "matching": motion_matching.MotionMatcher(motion_matching.tabulate(clips())),
})
page
"""
KEYS = ("ArrowUp", "ArrowLeft", "ArrowDown", "ArrowRight", "ArrowUp", "ArrowLeft")


def test_three_steered_characters_are_shown_as_often_as_an_empty_page_and_obey_within_nine(lab, page):  # noqa: F811
    """The delay is that from a key to the first picture of its answer: nine pictures of 60 Hz are 150 ms."""
    empty = empty_pictures_per_second(page)
    page.add_init_script(WITHOUT_WEBGL)
    run_notebook(lab, page, written([new_code_cell(STEERED.strip())]), "steered.ipynb")
    steering = "document.querySelector('.mocap-steering')?.steering"
    wait_until(lambda: page.evaluate(f"{steering}?.pictures > 0"), 120)
    page.locator(".mocap-steering .panels").focus()
    rates = []
    delays = []
    for key in KEYS:
        page.keyboard.press(key)
        rates.append(pictures_per_second(page, steering, times=1))
        delays.append(page.evaluate(f"{steering}.ways.at(-1)") / 1000)
    hold("a picture of three steered, in empty pages", empty / max(rates), PICTURES_BOUND)
    hold("the delay of a key, in pictures of an empty page", statistics.median(delays) * empty, 9)


HEAVY_PAGE = """<!DOCTYPE html><meta charset="utf-8"><script type="text/plain">{text}</script><script>
window.heavy = {{ pictures: 0 }};
requestAnimationFrame(() => {{ window.heavy.firstPicture = performance.now(); window.heavy.pictures = 1; }});
</script>"""


def first_picture(page, address, counter):  # noqa: F811
    """Open a page five times, and return the fewest milliseconds until its first picture."""
    milliseconds = []
    for _ in range(5):
        page.goto(address)
        wait_until(lambda: page.evaluate(f"{counter}?.pictures > 0"))
        milliseconds.append(page.evaluate(f"{counter}.firstPicture"))
    return min(milliseconds)


def test_the_player_of_a_minute_soon_shows_as_many_pictures_as_an_empty_page(minute, page, tmp_path):  # noqa: F811
    """Its first picture is compared with that of a page of as many bytes that draws nothing."""
    player = tmp_path / "three.html"
    heavy = tmp_path / "heavy.html"
    player.write_text(play(*minute).page(), "utf-8")
    heavy.write_text(HEAVY_PAGE.format(text="A" * player.stat().st_size), "utf-8")
    page.set_viewport_size({"width": 1200, "height": 800})
    heavy_picture = first_picture(page, heavy.as_uri(), "window.heavy")
    player_picture = first_picture(page, player.as_uri(), PLAYER)
    hold("the first picture, in that of as heavy a page", player_picture / heavy_picture, 4)
    empty = empty_pictures_per_second(page)
    open_player(page, f"{player.as_uri()}?flat")
    rate = pictures_per_second(page, PLAYER)
    hold("a picture of three as lines, in empty pages", empty / rate, PICTURES_BOUND)
