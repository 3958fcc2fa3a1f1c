"""What a notebook shows when a function stands in the place of an exercise, in players and pictures.

A run executes only the cells that feed what the function can change, and keeps what they show as arrays. Each
run has places for students' functions of its own, as a kernel has.
"""

import contextlib
import io
import re
import symtable
import warnings
from typing import NamedTuple
from unittest.mock import patch

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import mocap
from mocap.course import checks
from mocap.course.check import Verdict
from mocap.course.lab import adopting
from mocap.course.lab.slots import Slot
from tests.course.stored_notebooks import read

FAR = 1e-3  # metres: what moves less looks the same
BRIGHT = 16  # of 255: what changes less looks the same
CHOOSERS = re.compile(r"\blab\.(compare|mine|own|tools|as_written)\b")
FUNCTION = re.compile(r"^def ", re.MULTILINE)
SHOWING = {"show", "play", "explore", "display"}
OUTSIDE = {"display": lambda *_: None, "__name__": "__main__"}  # what a kernel defines
LEFT_OUT = ("lab.bet", "lab.inspector", "lab.quiz", "lab.progress")
TOLD = re.compile("this fails|the package's stands in from here on|do not fit together")
"""An answer of another form can be neither drawn nor played: a sentence says so."""


class Item(NamedTuple):
    """A player ("play"), a picture ("show"), or a sentence instead ("told")."""

    kind: str
    arrays: tuple = ()

    def looks_like(self, other):
        if self.kind != other.kind or len(self.arrays) != len(other.arrays):
            return False
        limit = FAR if self.kind == "play" else BRIGHT
        pairs = zip(self.arrays, other.arrays, strict=True)
        return all(a.shape == b.shape and not (abs(a - b) > limit).any() for a, b in pairs)


NOTHING = Item("")


def look_alike(some, others):
    pairs = zip(some, others, strict=False)
    return len(some) == len(others) and all(a.looks_like(b) for a, b in pairs)


class Stage:
    """Where players and pictures are shown, as arrays."""

    def __init__(self):
        self.shown = []

    def play(self, *motions, positions=None, seams=(), **_):
        places = positions or [mocap.body.joint_positions(motion) for motion in motions]
        arrays = [np.asarray(each, float) for each in [*places, list(seams)]]
        self.shown.append(Item("play", [np.nan_to_num(each, nan=1e6) for each in arrays]))

    def show(self, drawn, alt=""):
        del alt
        first = drawn[0] if isinstance(drawn, list | tuple) else drawn
        figure = first if isinstance(first, Figure) else getattr(first, "figure", None) or plt.gcf()
        pixels = io.BytesIO()
        figure.savefig(pixels, format="raw", dpi=50)
        self.shown.append(Item("show", [np.frombuffer(pixels.getvalue(), np.uint8).astype(np.int16)]))
        plt.close("all")

    def explore(self, draw, **_):
        self.show(draw())

    def replace(self, monkeypatch):
        """Show here what `mocap` would show, without captured people."""
        monkeypatch.setattr(mocap.widgets, "play", self.play)
        monkeypatch.setattr(mocap.widgets, "explore", self.explore)
        monkeypatch.setattr(mocap.widgets, "draw_path", lambda _, points: Canvas(np.asarray(points, float)))
        monkeypatch.setattr(mocap.plotting, "show", self.show)
        for module in ("mocap.course.real_clips", "mocap.course.lab.seam_of_one", "mocap.course"):
            monkeypatch.setattr(f"{module}.people", lambda *_: [])


class Canvas(NamedTuple):
    """The ground on which nobody has drawn a line of their own yet."""

    path: np.ndarray


class Cell(NamedTuple):
    """A cell, the names that it binds and those that it needs, of the notebook."""

    source: str
    exercise: str  # that it asks for, or ""
    stores: frozenset
    needs: frozenset


def cells_of(name):
    """Return the code cells of a notebook that can show something or feed what does."""
    cells = [cell for cell in read(name).cells if cell.cell_type == "code"]
    kept = [cell for cell in cells if not cell.source.startswith(LEFT_OUT)]
    return [Cell(cell.source, exercise_of(cell), *names_in(cell.source)) for cell in kept]


def exercise_of(cell):
    tags = [tag.partition(":") for tag in cell.metadata.get("tags", ())]
    return next((exercise for kind, _, exercise in tags if kind == "exercise"), "")


def names_in(source):
    """Return the names of the notebook that a cell binds, and those that it needs, also in functions."""
    stores, needs = set(), set()
    top = symtable.symtable(source, "cell", "exec")
    tables = [top]
    while tables:
        table = tables.pop()
        tables += table.get_children()
        for symbol in table.get_symbols():
            is_bound = symbol.is_assigned() or symbol.is_imported()
            if is_bound and (table is top or symbol.is_declared_global()):
                stores.add(symbol.get_name())
            if symbol.is_referenced() and (table is top or symbol.is_global()):
                needs.add(symbol.get_name())
    return frozenset(stores), frozenset(needs)


def changed_by(cells, names):
    """Return the numbers of the cells whose results can depend on students' functions, or on some names.

    A function in a cell may also need names that later cells bind, if its own cell does not.
    """
    found = {number for number, cell in enumerate(cells) if CHOOSERS.search(cell.source)}
    found |= {number for number, cell in enumerate(cells) if cell.needs & set(names)}
    before = -1
    while len(found) > before:
        before = len(found)
        anywhere = frozenset().union(*(cells[number].stores for number in found))
        earlier = set()
        for number, cell in enumerate(cells):
            if cell.needs & earlier or (cell.needs - cell.stores) & anywhere:
                found.add(number)
            if number in found:
                earlier |= cell.stores
    return found


def feeding(cells, numbers):
    """Return the numbers of some cells, and of all before them whose names they need."""
    found = set(numbers)
    needs = set()
    for number in reversed(range(len(cells))):
        if number in found or cells[number].stores & needs:
            found.add(number)
            needs |= cells[number].needs - cells[number].stores
    return found


class Run:
    """A run of cells, one after the other, with a function that does not pass its check.

    Parameters
    ----------
    space : the names that the cells before have bound; it is copied.
    functions : what has been written for exercises, by their names, right or wrong.
    """

    def __init__(self, stage, space, functions):
        self.stage = stage
        self.slots = {name: Slot(check) for name, check in checks.all_checks().items()}
        for name, function in functions.items():
            self.slots[name].written = function
        self.space = {**space, **functions}
        self.functions = functions

    def show(self, cell):
        """Run a cell, and return what it shows."""
        self.stage.shown = []
        said = io.StringIO()
        with contextlib.ExitStack() as stack:
            stack.enter_context(patch.object(adopting, "_slots", lambda: self.slots))
            for name in self.functions:
                check = checks.all_checks()[name]
                stack.enter_context(patch.object(check, "verdict", lambda _: Verdict(False, "")))
            stack.enter_context(contextlib.redirect_stdout(said))
            stack.enter_context(warnings.catch_warnings())
            warnings.simplefilter("ignore")
            exec(compile(cell.source, cell.exercise or "cell", "exec"), self.space)
        return self.stage.shown + [Item("told")] * bool(TOLD.search(said.getvalue()))


class Rest:
    """The cells of a notebook from an exercise on, and what they show with a right function.

    The right function is as one that does not pass its check. So what a wrong one shows is labelled alike,
    and differs only if its values do.

    Parameters
    ----------
    functions : the right functions, by their exercises.
    """

    def __init__(self, stage, space, cells, functions):
        self.stage = stage
        self.before = dict(space)
        changed = changed_by(cells, functions)
        seen = {number for number in changed if cells[number].needs & SHOWING}
        needed = sorted(feeding(cells, seen))
        # A function changes the objects of the notebook that defines it. Therefore each run defines its own.
        again = changed | {number for number in needed if FUNCTION.search(cells[number].source)}
        self.cells = [(cells[number], number in again) for number in needed]
        self.right = Run(stage, space, functions)
        self.pages = []  # of each cell so far, what it shows and what it binds

    def page(self, number):
        """Return what a cell shows with the right function, and the names that it binds."""
        while len(self.pages) <= number:
            cell, _ = self.cells[len(self.pages)]
            shown = self.right.show(cell)
            bound = {name: self.right.space[name] for name in cell.stores & self.right.space.keys()}
            self.pages.append((shown, bound))
        return self.pages[number]

    def differences(self, functions):
        """Yield what each cell shows with wrong functions and with the right ones, if it differs."""
        run = Run(self.stage, self.before, functions)
        for number, (cell, is_run) in enumerate(self.cells):
            expected, bound = self.page(number)
            if is_run:
                shown = run.show(cell)
                if not look_alike(shown, expected):
                    yield shown, expected
            else:
                run.space.update(bound)


def rests(name, stage):
    """Yield each exercise of a notebook, and the rest of the notebook after its cell."""
    cells = cells_of(name)
    first_run = Run(stage, OUTSIDE, {})
    wanted = {number for number, cell in enumerate(cells) if cell.exercise}
    changed = changed_by(cells, [])
    seen = {number for number in changed if cells[number].needs & SHOWING}
    needed = feeding(cells, seen | wanted)
    for number, cell in enumerate(cells):
        if number > max(wanted, default=-1):
            break
        if number in needed:
            first_run.show(cell)
        if cell.exercise:
            right = {cell.exercise: written(cell.exercise, checks.all_checks()[cell.exercise].truth)}
            yield cell.exercise, Rest(stage, first_run.space, cells[number + 1 :], right)


def written(name, answer):
    """Return an answer as a function that a student has written."""

    def function(*arguments):
        return answer(*arguments)

    function.__name__ = name
    return function
