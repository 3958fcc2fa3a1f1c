"""The small experiments of the course's pages: their numbers are those of Python, and they answer."""

import itertools
import shutil

import nbformat
import numpy as np
import pytest

from mocap.body import rotations
from mocap.course import live_bodies, live_experiments
from mocap.course.live_experiments import LIVE, numbers_of
from mocap.course.opening import stored
from tests.browser.conftest import PHONE, watched_page
from tests.conftest import SWEEP
from tests.course.test_site import build_small

SCRIPT = live_experiments.__file__.replace("live_experiments.py", "live.js")
MOST = 5_000 if SWEEP else 150  # settings of each experiment


@pytest.fixture(scope="module")
def blank(browser):
    page = browser.new_page()
    page.set_content("<!doctype html>")
    page.add_script_tag(path=SCRIPT)
    yield page
    page.close()


def settings(controls, most=MOST):
    """All settings of the controls, or as many at random, with the corners."""
    grids = [
        np.linspace(low, high, round((high - low) / step) + 1) for low, high, step, _ in controls.values()
    ]
    if np.prod([len(grid) for grid in grids]) <= most:
        return [dict(zip(controls, values, strict=True)) for values in itertools.product(*grids)]
    rng = np.random.default_rng(0)
    corners = itertools.product(*(grid[[0, -1]] for grid in grids))
    chosen = [*corners, *([rng.choice(grid) for grid in grids] for _ in range(most))]
    return [dict(zip(controls, map(float, values), strict=True)) for values in chosen]


def has_directions(found):
    """Whether all angles of this result are determined: none jumps by a whole turn, none is of no direction.

    The homework's heading is that of the root's x axis on the floor, which is one point where
    the x axis is vertical; `heading` fails where the body is upside down.
    """
    if "homework" not in found:
        return True
    jumps = any(abs(abs(found[name]) - 180) < 1e-6 for name in ("heading", "homework"))
    x_axis = rotations.rotate(found["root"], [1.0, 0.0, 0.0])
    w, _, y, _ = found["root"]
    return not jumps and min(np.hypot(x_axis[0], x_axis[2]), np.hypot(w, y)) > 1e-6


@pytest.mark.parametrize("name", LIVE)
def test_the_page_computes_what_python_computes(blank, name):
    experiment = LIVE[name]
    chosen = settings(experiment.controls)
    script = "([name, chosen, data]) => chosen.map((values) => liveExperiments[name].compute(values, data))"
    for values, found in zip(chosen, blank.evaluate(script, [name, chosen, experiment.data()]), strict=True):
        wanted = experiment.compute(**values)
        if not has_directions(wanted):
            continue
        same = {key: found[key] for key in wanted}
        assert same.get("message") == wanted.get("message")
        assert np.abs(numbers_of(same) - numbers_of(wanted)).max() < 1e-9, values


@pytest.mark.parametrize("name", LIVE)
def test_controls_are_those_of_the_notebook(name):
    stem, _, experiment = name.partition(":")
    cells = nbformat.read(stored() / f"{stem}.ipynb", 4).cells
    tag = f"experiment:{experiment}"
    source = next(cell.source for cell in cells if tag in cell.metadata.get("tags", ()))
    for control, (low, high, step, initial) in LIVE[name].controls.items():
        shown = [f"{control}=({low}", f"{control}=({float(low)}"]
        assert any(text in source for text in shown), control
        assert any(
            text in source for text in (f"{high}", "len(states) - 1", "len(events)", "len(skeleton) - 1")
        )
        assert f"{step}" in source
        assert f"{control}={initial}" in source


def test_a_leg_reaches_as_the_notebooks_does():
    found = live_bodies.leg(ahead=0.2, height=0.25)
    thigh, shank = (live_bodies.leg_data()[name] for name in ("thigh", "shank"))
    hip = np.array([0, live_bodies.HIP])
    assert np.linalg.norm(found["knee"] - hip) == pytest.approx(thigh)
    assert np.linalg.norm(found["ankle"] - found["knee"]) == pytest.approx(shank)
    assert found["ankle"] == pytest.approx([0.2, 0.25])


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Make the pages of the notebooks that have small experiments."""
    pytest.importorskip("myst_nb", reason="pip install '.[site]'")
    folder = tmp_path_factory.mktemp("live")
    (folder / "teaching").mkdir()
    for stem in {name.partition(":")[0] for name in LIVE}:
        shutil.copy(stored() / f"{stem}.ipynb", folder)
    build_small(folder, folder / "out")
    return folder / "out"


DRAWN = """(canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return data.reduce((sum, value, k) => (sum + value * (k % 9973)) % 1e9, 0);
}"""


@pytest.mark.parametrize("screen", [{"viewport": {"width": 1200, "height": 900}}, PHONE])
def test_sliders_move_the_drawings(browser, site, screen):
    with watched_page(browser, **screen) as (page, faults):
        for name, experiment in LIVE.items():
            stem, _, tag = name.partition(":")
            page.goto((site / f"{stem}.html").as_uri())
            place = page.locator(f"[data-live='{name}']")
            assert place.get_attribute("id") == f"experiment-{tag}"
            assert place.locator(".mocap-still").count() == 0
            assert place.locator("canvas").get_attribute("aria-label")
            sliders = place.locator("input")
            assert sliders.count() == len(experiment.controls)
            canvas = place.locator("canvas")
            for number in range(sliders.count()):
                before = canvas.evaluate(DRAWN)
                is_last = sliders.nth(number).evaluate("(slider) => slider.value === slider.max")
                sliders.nth(number).press("ArrowLeft" if is_last else "ArrowRight")
                assert canvas.evaluate(DRAWN) != before
            assert sliders.first.bounding_box()["height"] >= 44
            assert page.evaluate("document.documentElement.scrollWidth") <= screen["viewport"]["width"]
    assert faults == []
