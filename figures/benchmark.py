"""One benchmark for all methods: each beside the best simple one, case by case.

`python figures/benchmark.py` writes `BENCHMARK.md` beside this script; `tasks` says what a task is. With
names of tasks, it writes only their sections anew. It takes some four minutes of CPU with the bundled clips,
fifteen with all. `--data` names folders of captured clips, by default those of fetched clips and
`MOCAP_REAL_DATA`.
`--write FOLDER` writes what each case gives to TASK/CASE/NAME.bvh or .csv; `--enter FOLDER` scores
TASK/CASE.bvh or .csv beside the methods.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
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
from mocap._shared.atomic import write_file
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
        like = None  # what an answer looks like: a method's own
        for name, method in {**task.METHODS, **({ENTERED: None} if entered else {})}.items():
            try:
                answer = method(case) if method else read(entered, case, like)
                like = answer if like is None or not len(like) else like
                values = task.score(case, answer)
            except MocapError as error:
                values = [np.nan] * len(task.MEASURES)
                if not method:
                    print(f"{case.collection}, {case.name}: {error}", file=sys.stderr)
            for measure, value in zip(task.MEASURES, values, strict=True):
                yield Row(case.collection, name, case.name, measure, float(value))


def read(folder: Path, case: Case, like: Answer | None = None) -> Answer:
    """Read an answer that another program made: a motion, or a table of as many columns as another one."""
    table = folder / f"{case.name}.csv"
    if isinstance(like, mocap.Motion) or (like is None and not table.exists()):
        return mocap.load(table.with_suffix(".bvh"))
    try:
        found = np.loadtxt(table, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise MocapError(f"'{table.name}' is no table of numbers: {error}"[:200]) from None
    columns = found.shape[1] if like is None or not len(like) else like.shape[1]
    if not found.size or not np.isfinite(found).all() or found.shape[1] != columns:
        got = f"got a table of shape {found.shape}"
        raise MocapError(f"{case.name} asks for rows of {columns} finite numbers, {got}.")
    return found


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


def table(task: ModuleType, rows: Sequence[Row]) -> list[str]:
    """Write a table of all collections; where the best baseline wins, that is in bold."""
    names = [f"{name} {'↓' if less else '↑'}" for name, less in task.MEASURES.items()]
    lines = [f"| | | {' | '.join(names)} |", "|---" * (2 + len(names)) + "|"]
    for collection in dict.fromkeys(row.collection for row in rows):
        found: dict[tuple[str, str], list[float]] = {}
        for row in (row for row in rows if row.collection == collection):
            found.setdefault((row.method, row.measure), []).append(row.value)
        best = {name: _best(found, task.BASELINES, name, less) for name, less in task.MEASURES.items()}
        for number, method in enumerate(dict.fromkeys(method for method, _ in found)):
            cells = []
            for measure, less in task.MEASURES.items():
                values, base = (np.array(found[one, measure]) for one in (method, best[measure]))
                wins, losses = _pairs(values, base, less)
                pairs = f"**{wins} : {losses}**" if losses > wins else f"{wins} : {losses}"
                cells.append(_cell(values) + ("" if method in task.BASELINES else f"; {pairs}"))
            none = np.all([np.isnan(found[method, measure]) for measure in task.MEASURES], axis=0)
            name = f"*{method}*" if method in task.BASELINES else method
            name += f", refuses {none.sum()}" if none.any() else ""
            whose = "" if number else f"{collection} ({len(values)})"
            lines.append(f"| {whose} | {name} | {' | '.join(cells)} |")
    return lines


def summary(sections: Mapping[str, str]) -> list[str]:
    """Count in how many cells of its section each method wins and loses."""
    lines = ["| | | wins | as good | the baseline wins |", "|---|---|---|---|---|"]
    for title, text in sections.items():
        counts: dict[str, list[int]] = {}
        for line in (line for line in text.splitlines() if line.startswith("|") and "; " in line):
            _, method, *cells = re.split(r" ?\| ", line.strip("|"))
            for wins, losses in re.findall(r"; \**(\d+) : (\d+)", " ".join(cells)):
                tally = counts.setdefault(method.partition(", refuses")[0], [0, 0, 0])
                tally[1 + (int(losses) > int(wins)) - (int(wins) > int(losses))] += 1
        lines += [f"| {title} | {name} | {' | '.join(map(str, tally))} |" for name, tally in counts.items()]
    return lines


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
    apart = ~np.isclose(values, base, rtol=1e-6, atol=5e-5)  # what rounding may do is no win
    return int((apart & (values > base)).sum()), int((apart & (values < base)).sum())


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
measure, case by case; in **bold** where the baseline wins more. Who refuses a case loses it. ↓ less is
better, ↑ more is better. Where a baseline is the best by one measure, another may be the best by the next."""


def section(name: str, folders: tuple[Path, ...], entered: Path | None) -> str:
    """Run a task, and write its section without the title."""
    task = import_module(f"tasks.{name}")
    lines = table(task, list(run(task, cases(task, folders), entered and entered / name)))
    missing = [some for some, names in task.CLIPS.items() if clips(names, folders) is None]
    note = ["", f"Not at hand: {', '.join(missing)}."] if missing else []
    return "\n".join([(task.__doc__ or "").strip(), "", *lines, *note])


def sections_of(text: str) -> dict[str, str]:
    """Take the sections of a page by their titles."""
    _, *parts = re.split(r"^## ", text, flags=re.MULTILINE)
    return {title: rest.strip() for title, _, rest in (part.partition("\n") for part in parts)}


def page(sections: Mapping[str, str]) -> str:
    """Write the page: a summary, and the sections in the order of the tasks."""
    known = {title_of(name): sections[title_of(name)] for name in TASKS if title_of(name) in sections}
    text = [f"## {title}\n\n{text}" for title, text in known.items()]
    return "\n\n".join([HEAD, "\n".join(summary(known)), *text]) + "\n"


def title_of(name: str) -> str:
    """Write a task's name as a title."""
    return name.replace("_", " ").capitalize()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run tasks, print their sections, and put them into the page, unless another program's answers enter."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", choices=[*TASKS, []], help="all of them by default")
    known = [kept_in(), *([Path(os.environ["MOCAP_REAL_DATA"])] if "MOCAP_REAL_DATA" in os.environ else [])]
    parser.add_argument("--data", type=Path, nargs="+", default=known, help="folders of captured clips")
    parser.add_argument("--enter", type=Path, help="a folder of another program's answers")
    parser.add_argument("--write", type=Path, help="write what the cases give, and stop")
    asked = parser.parse_args(arguments)
    if asked.enter and not asked.enter.is_dir():
        parser.error(f"There is no folder '{asked.enter}' to enter.")
    warnings.simplefilter("ignore", MocapWarning)
    for name in asked.tasks or TASKS:
        if asked.write:
            for case in cases(import_module(f"tasks.{name}"), tuple(asked.data)):
                write(asked.write / name, case)
            continue
        text = section(name, tuple(asked.data), asked.enter)
        print(f"## {title_of(name)}\n\n{text}\n", flush=True)
        if not asked.enter:
            before = sections_of(PAGE.read_text("utf-8")) if PAGE.exists() else {}
            write_file(PAGE, page({**before, title_of(name): text}))


if __name__ == "__main__":
    main()
