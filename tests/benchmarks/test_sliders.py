"""Whether all sliders of all notebooks answer the hand.

Each notebook runs once. Then each slider is dragged from its low end to its high end in a dozen steps, in the
notebook's own kernel; the time is CPU milliseconds for a picture, the median of the steps.
"""

import json
from pathlib import Path

import pytest
from nbformat.v4 import new_code_cell

from mocap.course.notebooks import execute, read
from mocap.course.opening import stored

pytestmark = pytest.mark.benchmark
PICTURES = 12  # a second
ROOT = Path(__file__).parents[2]
DRAG = """import json, time
from statistics import median
from tests.course.driving import displayed
from mocap.widgets.experiments import Experiment
dragged = {}
for name, shown in displayed.items():
    for slider, control in shown.controls.items() if isinstance(shown, Experiment) else ():
        if not hasattr(control, "min"):
            continue
        rest, took = control.value, []
        for step in range(12):
            value = type(rest)(control.min + (control.max - control.min) * step / 11)
            start = time.process_time()
            control.value = value
            took.append(1000 * (time.process_time() - start))
        shown.set(**{slider: rest})
        dragged[f"{name}, {slider}"] = median(took)
print(json.dumps(dragged))"""


@pytest.mark.parametrize("name", sorted(file.name for file in stored().glob("*.ipynb")))
def test_each_slider_shows_twelve_pictures_a_second(name):
    notebook = read(stored() / name)
    tags = [(cell.source, tag) for cell in notebook.cells for tag in cell.metadata.get("tags", ())]
    names = {source: tag for source, tag in tags if tag.startswith("experiment:")}
    driving = f"import sys; sys.path.append({str(ROOT)!r}); from tests.course import driving"
    notebook.cells = [
        new_code_cell(f"{driving}; driving.watch({names!r})"),
        *notebook.cells,
        new_code_cell(DRAG),
    ]
    execute(notebook, stored() / name, 600)
    dragged = json.loads(notebook.cells[-1].outputs[-1].text)
    print(name, *(f"\n  {slider}: {took:.0f} ms" for slider, took in dragged.items()))
    assert {slider: took for slider, took in dragged.items() if took > 1000 / PICTURES} == {}
