"""Each known mistake of two notebooks changes what they show next, in pictures and players."""

import contextlib
import hashlib
import io
import re
import warnings

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import mocap
from mocap.course import checks, notebooks
from mocap.course.lab import adopting
from tests.course.lab.students import wrong as stub
from tests.course.stored_notebooks import NAMES, read

WAY = [name for name in NAMES if name[:3] in {"01-", "03-"}]
TOLD = re.compile("this fails|the package's stands in from here on")
"""An answer of another form can be neither drawn nor played: a sentence says so."""


class Stage:
    """What a notebook shows, as digests, in place of players and pictures."""

    def __init__(self):
        self.shown = []

    def play(self, *motions, positions=None, **_):
        places = positions or [mocap.body.joint_positions(motion) for motion in motions]
        self.shown.append(("play", *(self.digest(np.round(np.asarray(p, float), 4)) for p in places)))

    def show(self, drawn, alt=""):
        del alt
        figure = drawn if isinstance(drawn, Figure) else figure_of(drawn)
        pixels = io.BytesIO()
        figure.savefig(pixels, format="raw", dpi=40)
        self.shown.append(("show", self.digest(np.frombuffer(pixels.getvalue(), np.uint8))))
        plt.close("all")

    def explore(self, draw, **_):
        self.show(draw())

    def digest(self, array):
        return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()


def figure_of(drawn):
    first = drawn[0] if isinstance(drawn, list | tuple) else drawn
    return first.figure if hasattr(first, "figure") else plt.gcf()


@pytest.fixture
def stage(monkeypatch):
    made = Stage()
    monkeypatch.setattr(mocap.widgets, "play", made.play)
    monkeypatch.setattr(mocap.widgets, "explore", made.explore)
    monkeypatch.setattr(mocap.widgets, "draw_path", lambda *_: None)
    monkeypatch.setattr(mocap.plotting, "show", made.show)
    for module in ("mocap.course.real_clips", "mocap.course.lab.seam_of_one", "mocap.course"):
        monkeypatch.setattr(f"{module}.people", lambda *_: [])
    return made


def run(cells, space, stage, until=None):
    """Run cells, and return what they show; stop as soon as that differs from `until`."""
    stage.shown = []
    for cell in cells:
        said = io.StringIO()
        with contextlib.redirect_stdout(said), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            exec(compile(cell.source, cell.id, "exec"), space)
        stage.shown += [("told",)] * bool(TOLD.search(said.getvalue()))
        if until is not None and stage.shown != until[: len(stage.shown)]:
            break
    return stage.shown


def set_in(name, mistake):
    """Return a mistake as a function that a student has written."""

    def function(*arguments):
        return mistake(*arguments)

    function.__name__ = name
    return function


def unseen_mistakes(name, stage):
    """Return the mistakes of a notebook that change nothing that it shows, by their exercises."""
    cells = [cell for cell in read(name).cells if cell.cell_type == "code"]
    cells = [cell for cell in cells if not cell.source.startswith(("lab.bet", "lab.inspector", "lab.quiz"))]
    exercises = [tag for tag, _ in notebooks.tagged(read(name), "exercise")]
    space = {"display": lambda *_: None, "__name__": "__main__"}
    spaces, places = {}, {}
    for number, cell in enumerate(cells):
        for tag in cell.metadata.get("tags", ()):
            if tag.startswith("exercise:"):
                exercise = tag.partition(":")[2]
                spaces[exercise] = dict(space)
                places[exercise] = number + 1
        run([cell], space, stage)
    found = {}
    for exercise in exercises:
        rest = cells[places[exercise] :]
        right = {**spaces[exercise], exercise: stub(exercise)}
        expected = run(rest, right, stage)
        for mistake, function in checks.all_checks()[exercise].answers.mistakes.items():
            wrong = {**spaces[exercise], exercise: set_in(exercise, function)}
            if run(rest, wrong, stage, until=expected) == expected:
                found.setdefault(exercise, set()).add(mistake)
            adopting._slots.cache_clear()
    return found


@pytest.mark.sweep
@pytest.mark.parametrize("name", WAY)
def test_each_mistake_changes_what_is_shown_next(name, stage):
    assert unseen_mistakes(name, stage) == {}
