"""Moves all controls of a notebook's experiments to their low and to their high ends, in its own kernel.

`conftest.py` adds a first cell and a last one to every notebook that nbval runs. The first keeps what the
experiments show; the last drives them after all cells, as a reader would: names may have been used again.
So no notebook has to run a second time. With MOCAP_SWEEP, each control moves over its whole range.
"""

import os
import warnings

import numpy as np
from IPython import get_ipython

from mocap.widgets.experiments import Experiment
from mocap.widgets.player import Player

displayed = {}


def watch(names):
    """Keep what the experiments show; `names` has the name of each by the source of its cell."""
    displayed.update(dict.fromkeys(names.values()))

    def keep(result):
        if result.info.raw_cell in names:
            displayed[names[result.info.raw_cell]] = result.result

    get_ipython().events.register("post_run_cell", keep)


def drive_all():
    warnings.filterwarnings("error", module="mocap", append=True)  # as in pyproject.toml
    for name, experiment in displayed.items():
        try:
            drive(experiment)
        except Exception as error:
            error.add_note(f"in {name}")
            raise


def drive(shown):
    if isinstance(shown, Experiment):
        for values in {repr(values): values for values in settings(shown)}.values():  # each once
            shown.set(**values)
    elif isinstance(shown, Player):
        assert shown.scene["frames"] > 1
    elif hasattr(shown, "pairs"):  # a blind test, whose films play in the page
        assert all(len(pair.seam) == len(pair.control) > 1 for pair in shown.pairs)
    elif hasattr(shown, "company"):  # characters that are steered
        for heading, speed in ((2.0, shown.scene["speeds"][0]), (-1.0, shown.scene["speeds"][1])):
            shown.command = [heading, speed, ""]
            walked = shown.company.walk(tuple(shown.command), 2.0)
            assert not any(member.report["fault"] for member in walked)
    elif hasattr(shown, "picture"):  # an inspector, which runs in the page
        assert shown.picture
    else:  # a canvas to draw on
        if shown.scene.get("drawable"):
            shown.path = [[0, 0], [1, 0.2], [2, 1], [2.5, 2], [2.5, 3]]
            assert shown.error is None, shown.message


def settings(experiment):
    """Give all low ends and all high ends; in a sweep, also each control's ends and middle alone."""
    ends, rest = {}, experiment.values()
    for name, control in experiment.controls.items():
        if hasattr(control, "options"):
            ends[name] = [value for _, value in control._options_full]
        elif hasattr(control, "min"):
            middle = type(control.value)((control.min + control.max) / 2)
            ends[name] = [control.min, middle, control.max]
        elif hasattr(control, "limits"):  # handles: as they are, one in the middle, another at a corner
            points = np.tile(np.array(control.value), (3, 1, 1))
            points[1, 0], points[2, -1] = np.mean(control.limits, axis=1), np.array(control.limits)[:, 1]
            ends[name] = [tuple(map(tuple, some)) for some in points.tolist()]
        else:
            ends[name] = [False, True]
    yield {name: values[0] for name, values in ends.items()}
    yield {name: values[-1] for name, values in ends.items()}
    if os.environ.get("MOCAP_SWEEP"):
        yield from (rest | {name: value} for name, values in ends.items() for value in values)
