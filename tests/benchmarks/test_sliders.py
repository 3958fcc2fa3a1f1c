"""Time of a picture while each slider of each notebook is dragged, in drawings of empty axes.

Each notebook runs once. Then each slider is dragged from its low end to its high end in a dozen steps, in
the notebook's own kernel. The time of a picture is the median of the steps in CPU seconds. The slowest slider
of a notebook is held to the bound.

See the ratios: pytest -m benchmark -n 0 -s tests/benchmarks/test_sliders.py
"""

import json
from pathlib import Path

import pytest
from nbformat.v4 import new_code_cell

from mocap.course.notebooks import execute, read
from mocap.course.opening import stored
from tests.benchmarks.timing import hold

pytestmark = pytest.mark.benchmark
BOUND = 3  # drawings of empty axes
ROOT = Path(__file__).parents[2]
DRAG = """import json, time
from statistics import median
from tests.benchmarks.timing import draw_empty_axes, fastest
from tests.course.driving import displayed
from mocap.widgets.experiments import Experiment
empty = fastest(draw_empty_axes, repeats=9)[0]
dragged = {}
for name, shown in displayed.items():
    for slider, control in shown.controls.items() if isinstance(shown, Experiment) else ():
        if not hasattr(control, "min"):
            continue
        initial, seconds = control.value, []
        for step in range(12):
            value = type(initial)(control.min + (control.max - control.min) * step / 11)
            start = time.process_time()
            control.value = value
            seconds.append(time.process_time() - start)
        shown.set(**{slider: initial})
        dragged[f"{name}, {slider}"] = median(seconds) / empty
print(json.dumps(dragged))"""


def experiments(notebook):
    """Return the names of a notebook's experiments by the sources of their cells."""
    tags = [(cell.source, tag) for cell in notebook.cells for tag in cell.metadata.get("tags", ())]
    return {source: tag for source, tag in tags if tag.startswith("experiment:")}


@pytest.mark.parametrize("name", sorted(file.name for file in stored().glob("*.ipynb")))
def test_each_slider_shows_a_picture_in_the_time_of_a_few_empty_ones(name):
    notebook = read(stored() / name)
    names = experiments(notebook)
    if not names:
        pytest.skip(f"{name} has no experiment")
    driving = f"import sys; sys.path.append({str(ROOT)!r}); from tests.course import driving"
    watch = new_code_cell(f"{driving}; driving.watch({names!r})")
    notebook.cells = [watch, *notebook.cells, new_code_cell(DRAG)]
    execute(notebook, stored() / name, 600)
    dragged = json.loads(notebook.cells[-1].outputs[-1].text)
    print(name, *(f"\n  {slider}: {ratio:.2f}" for slider, ratio in dragged.items()))
    if dragged:
        hold(f"slowest slider of {name}, in empty axes", max(dragged.values()), BOUND)
