"""One benchmark for all methods: each beside the best simple one, case by case.

`python figures/benchmark.py` writes `BENCHMARK.md` beside this script; it takes some minutes. `tasks` says
what a task is. With names of tasks, it prints only these. `--data` names folders of captured clips, by
default those of fetched clips and `MOCAP_REAL_DATA`. `--write FOLDER` writes what each case gives to
TASK/CASE/NAME.bvh or .csv; `--enter FOLDER` scores TASK/CASE.bvh or .csv beside the methods.
"""

from __future__ import annotations

import argparse
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

import numpy as np
from tasks import TASKS, Answer, Case

import mocap
from mocap import datasets, feet
from mocap._shared.arrays import Array
from mocap._shared.atomic import write_text
from mocap.datasets.downloads import kept_in
from mocap.errors import MocapError, MocapWarning

PAGE = Path(__file__).with_name("BENCHMARK.md")
SCALES = {"pymo": 0.0254}  # metres of a file's unit, by folders; else centimetres
ENTERED = "entered"


class Row(NamedTuple):
    """One number: how a method did in a case, by one measure; NaN where it refused."""

    collection: str
    method: str
    case: str
    measure: str
    value: float


@cache
def files(folders: tuple[Path, ...]) -> dict[str, Path]:
    """Find the clips in folders, as FOLDER/NAME."""
    found = (path for folder in folders for path in sorted(folder.rglob("*"), reverse=True))
    return {
        f"{path.parent.name}/{path.stem}": path for path in found if path.suffix.lower() in (".amc", ".bvh")
    }


def clips(names: Iterable[str], folders: tuple[Path, ...]) -> list[mocap.Motion] | None:
    """Load clips at 30 Hz with their plants marked; None where one is not at hand."""
    if any("/" in name and name not in files(folders) for name in names):
        return None
    return [_clip(name, files(folders).get(name)) for name in names]


@cache
def _clip(name: str, path: Path | None) -> mocap.Motion:
    found = mocap.load(path, scale=SCALES.get(path.parent.name)) if path else datasets.sample(name)
    found = replace(mocap.resample(found, 30), name=name.rpartition("/")[2])
    return found if found.contacts else feet.mark_plants(found)


def cases(task: ModuleType, folders: tuple[Path, ...]) -> Iterator[Case]:
    """Yield the cases of all collections that are at hand."""
    for collection, names in task.CLIPS.items():
        if (found := clips(names, folders)) is not None:
            yield from task.cases(collection, found)


def run(task: ModuleType, some: Iterable[Case], entered: Path | None = None) -> Iterator[Row]:
    """Let all methods answer all cases, and score the answers; those entered, too."""
    for case in some:
        for name, method in {**task.METHODS, **({ENTERED: None} if entered else {})}.items():
            try:
                answer = method(case) if method else read(entered, case)
                values = task.score(case, answer)
            except MocapError:
                values = [np.nan] * len(task.MEASURES)
            for measure, value in zip(task.MEASURES, values, strict=True):
                yield Row(case.collection, name, case.name, measure, float(value))


def read(folder: Path, case: Case) -> Answer:
    """Read an answer that another program made."""
    table = folder / f"{case.name}.csv"
    return (
        np.loadtxt(table, delimiter=",", ndmin=2) if table.exists() else mocap.load(table.with_suffix(".bvh"))
    )


def write(folder: Path, case: Case) -> None:
    """Write what a case gives, not what only the score knows: arrays, motions, and which clips it may use."""
    own, shared = folder / case.name, folder / "clips"
    for place in (own, shared):
        place.mkdir(parents=True, exist_ok=True)
    for name, given in case.given.items():
        if isinstance(given, mocap.Motion):
            mocap.save(given, own / f"{name}.bvh")
        elif isinstance(given, tuple):
            (own / f"{name}.txt").write_text("".join(f"clips/{clip.name}.bvh\n" for clip in given), "utf-8")
            for path, clip in ((shared / f"{clip.name}.bvh", clip) for clip in given):
                if not path.exists():
                    mocap.save(clip, path)
        else:
            np.savetxt(own / f"{name}.csv", np.atleast_2d(given), fmt="%.9g", delimiter=",")


def tables(task: ModuleType, rows: Sequence[Row]) -> tuple[list[str], list[str]]:
    """Write a table of all collections, and a line for each method that loses to a baseline in one."""
    names = [f"{name} {'↓' if less else '↑'}" for name, less in task.MEASURES.items()]
    lines, lost = [f"| | | {' | '.join(names)} |", "|---" * (2 + len(names)) + "|"], []
    for collection in dict.fromkeys(row.collection for row in rows):
        found: dict[tuple[str, str], list[float]] = {}
        for row in (row for row in rows if row.collection == collection):
            found.setdefault((row.method, row.measure), []).append(row.value)
        best = {name: _best(found, task.BASELINES, name, less) for name, less in task.MEASURES.items()}
        for number, method in enumerate(dict.fromkeys(method for method, _ in found)):
            cells, worse = [], []
            for measure, less in task.MEASURES.items():
                values, base = (np.array(found[one, measure]) for one in (method, best[measure]))
                wins, losses = _pairs(values, base, less)
                cells.append(_cell(values) + ("" if method in task.BASELINES else f"; {wins} : {losses}"))
                worse += [f"{measure} ({best[measure]} {losses} : {wins})"] if losses > wins else []
            refused = int(
                np.all([np.isnan(found[method, measure]) for measure in task.MEASURES], axis=0).sum()
            )
            name = f"*{method}*" if method in task.BASELINES else method
            name += f", refuses {refused}" if refused else ""
            whose = "" if number else f"{collection} ({len(values)})"
            lines.append(f"| {whose} | {name} | {' | '.join(cells)} |")
            if worse and method not in task.BASELINES:
                lost.append(f"{collection}: {method} by {', '.join(worse)}")
    return [*lines, ""], lost


def _best(found: Mapping[tuple[str, str], Array], baselines: Sequence[str], measure: str, less: bool) -> str:
    """Choose the baseline with the best median; one that refuses counts as infinitely bad there."""
    worst = np.inf if less else -np.inf

    def middle(name: str) -> float:
        values = np.array(found[name, measure])
        return float(np.median(np.where(np.isnan(values), worst, values)))

    return (min if less else max)(baselines, key=middle)


def _pairs(values: Array, base: Array, less: bool) -> tuple[int, int]:
    """Count the cases that a method wins and loses; to refuse is to lose against whoever does not."""
    worst = np.inf if less else -np.inf
    values, base = (np.where(np.isnan(some), worst, some) * (-1 if less else 1) for some in (values, base))
    return int((values > base).sum()), int((values < base).sum())


def _cell(values: Array) -> str:
    """Write the median and the quartiles of what was not refused."""
    done = values[~np.isnan(values)]
    if not len(done):
        return "none"
    low, middle, high = np.percentile(done, [25, 50, 75])
    size = int(np.floor(np.log10(max(abs(high), 1e-3))))
    digits = max(0, 1 + (size == 0) - size) if abs(high) > 5e-5 else 0
    return f"{middle:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"


HEAD = """# Every method beside the best simple one

Written by `python figures/benchmark.py`, which needs no other clips than the bundled ones; sets that are not
at hand are left out. Each cell has the median and [quartiles] over the cases, whose number is in brackets;
then, as in 9 : 3, how many cases the method wins and loses against the best baseline (in *italics*) by that
measure, case by case. Who refuses a case loses it. ↓ less is better, ↑ more is better."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the tasks, print their tables, and write the page when all of them were run."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", choices=[*TASKS, []], help="all of them by default")
    known = [kept_in(), *([Path(os.environ["MOCAP_REAL_DATA"])] if "MOCAP_REAL_DATA" in os.environ else [])]
    parser.add_argument("--data", type=Path, nargs="+", default=known, help="folders of captured clips")
    parser.add_argument("--enter", type=Path, help="a folder of another program's answers")
    parser.add_argument("--write", type=Path, help="write what the cases give, and stop")
    asked = parser.parse_args(arguments)
    warnings.simplefilter("ignore", MocapWarning)
    page, all_lost = [], []
    for name in asked.tasks or TASKS:
        task, folders = import_module(f"tasks.{name}"), tuple(asked.data)
        if asked.write:
            for case in cases(task, folders):
                write(asked.write / name, case)
            continue
        lines, lost = tables(task, list(run(task, cases(task, folders), asked.enter and asked.enter / name)))
        missing = [some for some, names in task.CLIPS.items() if clips(names, folders) is None]
        page += [f"## {name.replace('_', ' ').capitalize()}", "", task.__doc__.strip(), "", *lines]
        page += [f"Not at hand: {', '.join(missing)}.", ""] if missing else []
        all_lost += [f"- {name.replace('_', ' ')}: {one}" for one in lost]
        print("\n".join(page[-len(lines) - 4 :]), flush=True)
    text = "\n".join([HEAD, "", "## Where a baseline wins", "", *all_lost, "", *page])
    if not (asked.tasks or asked.enter or asked.write):
        write_text(PAGE, text)


if __name__ == "__main__":
    main()
