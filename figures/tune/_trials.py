"""Trials of tuned constants: one varies, the others keep their values, and a table shows what changes.

A script of this folder is a `Study` of one room. For each constant it names other values, and a function that
measures clips; `main` prints a table for each constant and each collection of clips. The row of the chosen
value has a star.
"""

from __future__ import annotations

import argparse
import inspect
import re
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import mocap
from mocap import datasets
from mocap.datasets.downloads import kept_in
from mocap.errors import MocapError

Clips = tuple[mocap.Motion, ...]
Row = Mapping[str, object]
Measure = Callable[[Clips], Row]

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
RATE = 30.0  # frames per second at which clips are compared


class Trial(NamedTuple):
    """Values of a constant beside the chosen one, and what is measured with each.

    The first value is the one that `--quick` tries. A measure that needs no clips is made once.
    """

    measure: Measure
    values: tuple[Any, ...]
    needs_clips: bool = True


class Collection(NamedTuple):
    """Clips by name: bundled ones, or trials of the CMU database such as `16/16_15`."""

    name: str
    clips: tuple[str, ...]
    fps: float | None = RATE

    @property
    def is_bundled(self) -> bool:
        """Whether the clips come with the package."""
        return not any("/" in clip for clip in self.clips)

    def load(self) -> Clips | None:
        """Load the clips, or return None if one of them is not here."""
        motions = []
        for clip in self.clips:
            path = kept_in() / f"{clip}.amc"
            if not self.is_bundled and not path.exists():
                return None
            motions.append(datasets.sample(clip) if self.is_bundled else mocap.load(path))
        return tuple(mocap.resample(motion, self.fps or motion.fps) for motion in motions)


def cmu(subject: str, *trials: int) -> tuple[str, ...]:
    """Return the names of trials of a subject of the CMU database."""
    return tuple(f"{subject}/{subject}_{trial:02}" for trial in trials)


BUNDLED_WALKS = Collection("four bundled walks", WALKS)
STOP_AND_GO = Collection("four bundled walks, stops", (*WALKS, "stop_and_go"))
CAPTURED_WALKS = Collection("CMU 16, 26 walks", cmu("16", *range(11, 35), 47, 58))


def of_folder(folder: Path, fps: float | None = RATE) -> Clips:
    """Load all clips of a folder."""
    paths = sorted(path for path in folder.iterdir() if path.suffix.lower() in {".amc", ".bvh"})
    motions = [mocap.load(path) for path in paths]
    return tuple(mocap.resample(motion, fps or motion.fps) for motion in motions)


def middle_of(clip: mocap.Motion, seconds: float) -> mocap.Motion:
    """Cut the middle out of a clip, or return the whole of a shorter one."""
    frames = round(seconds * clip.fps)
    first = max(0, (len(clip) - frames) // 2)
    return clip[first : first + frames]


@contextmanager
def varied(room: ModuleType, **values: object) -> Iterator[None]:
    """Let all modules read other values of a room's constants.

    Modules import the dataclass by name, so each of their names is bound to the varied one, and back.
    """
    chosen = constants_of(room)
    changed = replace(chosen, **values)
    try:
        _rebind(chosen, changed)
        yield
    finally:
        _rebind(changed, chosen)


def constants_of(room: ModuleType) -> Any:  # noqa: ANN401 (each room has its own class)
    """Return the constants of a room: `TUNED`, or `LIMITS` of quality."""
    return vars(room).get("TUNED") or vars(room)["LIMITS"]


def _rebind(old: object, new: object) -> None:
    """Bind all names in modules of the package that are bound to an object to another one."""
    for module in [module for name, module in sys.modules.items() if name.startswith("mocap")]:
        for name in [name for name, value in vars(module).items() if value is old]:
            setattr(module, name, new)


class Study(NamedTuple):
    """The trials of a room; `room` is the module of its constants.

    `fixed` has the constants that are not varied, with a reason. A measure is given the clips of each of the
    collections in turn.
    """

    room: ModuleType
    trials: Mapping[str, Trial]
    fixed: Mapping[str, str]
    collections: Sequence[Collection]
    fps: float | None = RATE

    def unexplained(self) -> set[str]:
        """Return constants that are neither varied nor fixed with a reason, and names of no constant."""
        names = {field.name for field in fields(constants_of(self.room))}
        return names ^ {*self.trials, *self.fixed}

    def main(self, description: str | None) -> None:
        """Read the options, and print the tables."""
        parser = argparse.ArgumentParser(
            description=description, formatter_class=argparse.RawTextHelpFormatter
        )
        parser.add_argument("--clips", nargs="+", type=Path, default=[], metavar="FOLDER", help="more clips")
        parser.add_argument("--quick", action="store_true", help="bundled clips, two values of each constant")
        parser.add_argument("--only", nargs="+", metavar="CONSTANT", choices=list(self.trials))
        options = parser.parse_args()
        names = options.only or list(self.trials)
        printed: set[str] = set()  # constants whose measure needs no clips
        for name, clips in self._clips(options.clips, quick=options.quick):
            measured: dict[Measure, Row] = {}  # with the chosen values, by measure
            for constant in filter(lambda constant: constant not in printed, names):
                print(f"\n{constant}: {self.reason(constant)}")
                if self.trials[constant].needs_clips:
                    print(name)
                for line in self._table(constant, clips, measured, quick=options.quick):
                    print(line, flush=True)
            printed = {constant for constant, trial in self.trials.items() if not trial.needs_clips}

    def _clips(self, folders: Sequence[Path], *, quick: bool) -> Iterator[tuple[str, Clips]]:
        """Yield collections that are here; print which are not."""
        for collection in self.collections:
            if quick and not collection.is_bundled:
                continue
            clips = collection.load()
            if clips is None:
                first = f"{collection.clips[0]}.amc"
                print(f"{collection.name}: not in {kept_in()}. Let MOCAP_DATA name a folder with {first}.")
            else:
                yield collection.name, clips
        for folder in folders:
            yield folder.name, of_folder(folder, self.fps)

    def _table(
        self, constant: str, clips: Clips, measured: dict[Measure, Row], *, quick: bool
    ) -> Iterator[str]:
        """Yield the lines of a table: one for each value, in ascending order where they have one."""
        trial = self.trials[constant]
        chosen = getattr(constants_of(self.room), constant)
        if trial.measure not in measured:
            measured[trial.measure] = _measured(trial.measure, clips)
        rows = [(chosen, measured[trial.measure])]
        for value in trial.values[: 1 if quick else None]:
            with varied(self.room, **{constant: value}):
                rows.append((value, _measured(trial.measure, clips)))
        rows.sort(key=lambda row: _rank(row[0]))
        heads = sorted({head: None for _, row in rows for head in row}, key="CPU s".__eq__)
        yield "  ".join([f"  {'value':>18}", *(f"{head:>14}" for head in heads)])
        for value, row in rows:
            star = "*" if value == chosen else " "
            cells = [f"{_written(row.get(head, '')):>{max(14, len(head))}}" for head in heads]
            yield "  ".join([f"{star} {_written(value):>18}", *cells])

    def reason(self, constant: str) -> str:
        """Return what the source says of a constant: its unit and reason."""
        source = inspect.getsource(type(constants_of(self.room)))
        comment = re.search(rf"^    {constant}: .*?#\s*(.*)$", source, re.MULTILINE)
        return comment[1] if comment else ""


def _rank(value: object) -> tuple[bool, Any]:
    """Return a key that sorts numbers, and leaves the order of anything else."""
    return (False, value) if isinstance(value, float | int) else (True, 0)


def _written(value: object) -> str:
    """Write a number with three digits; a tuple in a few characters."""
    if isinstance(value, tuple):
        return f"({', '.join(map(_written, value))})"
    if isinstance(value, int) or (isinstance(value, float) and value.is_integer() and abs(value) < 1e7):
        return str(int(value))
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def _measured(measure: Measure, clips: Clips) -> Row:
    """Measure clips without warnings; add the CPU time. An error is a result, too."""
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            row = dict(measure(clips))
        except MocapError as error:
            row = {"result": type(error).__name__}
    return {"CPU s": time.process_time() - start} | row
