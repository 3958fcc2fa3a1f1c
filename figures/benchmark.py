"""One benchmark for all methods: each beside the best simple one, case by case.

`python figures/benchmark.py` writes `BENCHMARK.md` beside this script; `tasks` says what a task is. With
names of tasks, it writes only their sections anew. It takes some four minutes of CPU with the bundled clips,
fifteen with all. `--data` names folders of captured clips, by default those of fetched clips and
`MOCAP_REAL_DATA`.
`--again` writes the page anew from its tables, without a run. `--write FOLDER` writes what each case gives to
TASK/CASE/NAME.bvh or .csv; `--enter FOLDER` scores TASK/CASE.bvh or .csv beside the methods.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import time
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from tasks import TASKS, Answer, Case, Walked

import mocap
from mocap import datasets, feet
from mocap._shared.arrays import Array
from mocap._shared.atomic import write_file
from mocap.datasets.downloads import kept_in
from mocap.errors import MocapError, MocapWarning

PAGE = Path(__file__).with_name("BENCHMARK.md")
SCALES = {"pymo": 0.0254}  # metres of a file's unit, by folders; else centimetres
RATE = 30.0  # frames per second of the clips, unless the task names another
ENTERED = "entered"
OF_CLIPS = "the clips themselves"
SEAMS = "seams/s"  # of walks through graphs
CPU = "CPU, s"  # of one answer
SMALLEST = 0.001  # s or seams/s: what is less is printed as 0
DECIDED = "†"  # after a cell that is decided by construction
PAIR = re.compile(r"; \**(\d+) : (\d+)\** ?(†?)")  # wins and losses in a cell, and whether it is decided


class Row(NamedTuple):
    """One number: how a method did in a case, by one measure; NaN where it refused."""

    collection: str
    method: str
    case: str
    measure: str
    value: float


Values = Mapping[tuple[str, str], Array]  # by method and measure, a value for each case


@cache
def files(folders: tuple[Path, ...]) -> dict[str, Path]:
    """Find the clips in folders, as FOLDER/NAME."""
    paths = (path for folder in folders for path in sorted(folder.rglob("*"), reverse=True))
    return {
        f"{path.parent.name}/{path.stem}": path for path in paths if path.suffix.lower() in (".amc", ".bvh")
    }


def clips(names: Iterable[str], folders: tuple[Path, ...], rate: float = RATE) -> list[mocap.Motion] | None:
    """Load clips at one rate with their plants marked; None where one is not at hand."""
    if any("/" in name and name not in files(folders) for name in names):
        return None
    return [_clip(name, files(folders).get(name), rate) for name in names]


@cache
def _clip(name: str, path: Path | None, rate: float) -> mocap.Motion:
    clip = mocap.load(path, scale=SCALES.get(path.parent.name)) if path else datasets.sample(name)
    clip = replace(mocap.resample(clip, rate), name=name.rpartition("/")[2])
    return clip if clip.contacts else feet.mark_plants(clip)


def cases(task: ModuleType, folders: tuple[Path, ...]) -> Iterator[Case]:
    """Yield the cases of all collections that are at hand."""
    for collection, names in task.CLIPS.items():
        loaded = clips(names, folders, getattr(task, "RATES", {}).get(collection, RATE))
        if loaded is not None:
            yield from task.cases(collection, loaded)


def run(task: ModuleType, task_cases: Iterable[Case], entered: Path | None = None) -> Iterator[Row]:
    """Answer all cases by all methods, and score the answers, also those in the folder `entered`."""
    for case in task_cases:
        for method, values in scores(task, case, entered):
            for measure, value in values.items():
                yield Row(case.collection, method, case.name, measure, float(value))


def scores(
    task: ModuleType, case: Case, entered: Path | None = None
) -> Iterator[tuple[str, dict[str, float]]]:
    """Yield the scores of each method in a case, those of the answer that is entered, and those of the clips.

    Refusals have NaN. The seams per second and the CPU time are not measures.
    """
    example: Any = None  # the first answer with rows: the one that is entered has its form
    for name, method in task.METHODS.items():
        answer: Any = None
        seams = np.nan
        started = time.process_time()
        with suppress(MocapError):
            answer = method(case)
        seconds = time.process_time() - started
        if isinstance(answer, Walked):
            seams = answer.seams
            answer = answer.motion
        if example is None and answer is not None and len(answer):
            example = answer
        yield name, {**_scored(task, case, answer), SEAMS: seams, CPU: seconds}
    if entered:
        yield ENTERED, _scored_entry(task, case, entered, example)
    if hasattr(task, "of_clips"):
        yield OF_CLIPS, dict(zip(task.MEASURES, task.of_clips(case), strict=True))


def _scored(task: ModuleType, case: Case, answer: Answer | None) -> dict[str, float]:
    """Score an answer by each measure; NaN for none, and for one that cannot be scored."""
    values: Sequence[float] | Array = [np.nan] * len(task.MEASURES)
    if answer is not None:
        with suppress(MocapError):
            values = task.score(case, answer)
    return dict(zip(task.MEASURES, map(float, values), strict=True))


def _scored_entry(task: ModuleType, case: Case, folder: Path, example: Answer | None) -> dict[str, float]:
    """Score the answer of another program, and print why it cannot be scored."""
    try:
        values = task.score(case, read(folder, case, example))
    except MocapError as error:
        print(f"{case.collection}, {case.name}: {error}", file=sys.stderr)
        return dict.fromkeys(task.MEASURES, np.nan)
    return dict(zip(task.MEASURES, map(float, values), strict=True))


def read(folder: Path, case: Case, example: Answer | None = None) -> Answer:
    """Read an answer of another program: a motion, or a table with as many columns as an example."""
    table_path = folder / f"{case.name}.csv"
    if isinstance(example, mocap.Motion) or (example is None and not table_path.exists()):
        return mocap.load(table_path.with_suffix(".bvh"))
    try:
        answer = np.loadtxt(table_path, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise MocapError(f"'{table_path.name}' is no table of numbers: {error}"[:200]) from None
    columns = answer.shape[1] if example is None or not len(example) else example.shape[1]
    if not answer.size or not np.isfinite(answer).all() or answer.shape[1] != columns:
        shape = f"got a table of shape {answer.shape}"
        raise MocapError(f"{case.name} asks for rows of {columns} finite numbers, {shape}.")
    return answer


def write(folder: Path, case: Case) -> None:
    """Write what a case gives, not what only the score knows: arrays, motions, and which clips it may use."""
    case_folder = folder / case.name
    case_folder.mkdir(parents=True, exist_ok=True)
    clip_folder = folder / "clips"
    clip_folder.mkdir(parents=True, exist_ok=True)
    for name, value in case.given.items():
        if isinstance(value, mocap.Motion):
            mocap.save(value, case_folder / f"{name}.bvh")
        elif isinstance(value, tuple):
            paths = "".join(f"clips/{clip.name}.bvh\n" for clip in value)
            (case_folder / f"{name}.txt").write_text(paths, "utf-8")
            write_clips(clip_folder, value)
        else:
            np.savetxt(case_folder / f"{name}.csv", np.atleast_2d(value), fmt="%.9g", delimiter=",")


def write_clips(folder: Path, clips_of_case: Iterable[mocap.Motion]) -> None:
    """Write clips into a folder, except for those that are there."""
    for clip in clips_of_case:
        path = folder / f"{clip.name}.bvh"
        if not path.exists():
            mocap.save(clip, path)


def table(task: ModuleType, rows: Sequence[Row]) -> list[str]:
    """Write a table of all collections; where the best baseline wins, that is in bold."""
    names = [f"{name} {'↓' if less_is_better else '↑'}" for name, less_is_better in task.MEASURES.items()]
    names += extra_columns(rows)
    lines = [f"| | | {' | '.join(names)} |", "|---" * (2 + len(names)) + "|"]
    for collection in dict.fromkeys(row.collection for row in rows):
        values = values_by_method([row for row in rows if row.collection == collection])
        lines += lines_of_collection(task, collection, values, extra_columns(rows))
    return lines


def extra_columns(rows: Sequence[Row]) -> list[str]:
    """Return the columns that are no measures: the CPU time, and seams per second if any walk has them."""
    has_seams = any(row.measure == SEAMS and not np.isnan(row.value) for row in rows)
    has_times = any(row.measure == CPU for row in rows)
    return [SEAMS] * has_seams + [CPU] * has_times


def values_by_method(rows: Iterable[Row]) -> dict[tuple[str, str], Array]:
    """Collect the values of each method and measure, in the order of the cases."""
    values: dict[tuple[str, str], list[float]] = {}
    for row in rows:
        values.setdefault((row.method, row.measure), []).append(row.value)
    return {method_and_measure: np.array(listed) for method_and_measure, listed in values.items()}


def lines_of_collection(
    task: ModuleType, collection: str, values: Values, extra: Sequence[str] = ()
) -> list[str]:
    """Write a line of the table for each method; the first one names the collection."""
    baselines = {measure: _best_baseline(task, values, measure) for measure in task.MEASURES}
    lines: list[str] = []
    for method in dict.fromkeys(method for method, _ in values):
        values_of_method = [values[method, measure] for measure in task.MEASURES]
        title = "" if lines else f"{collection} ({len(values_of_method[0])})"
        name = f"*{method}*" if method in task.BASELINES else method
        refused = np.isnan(values_of_method).all(axis=0)
        if refused.any():
            name += f", refuses {refused.sum()}"
        cells = [_cell(task, values, method, measure, baselines[measure]) for measure in task.MEASURES]
        cells += [_median(values.get((method, column), np.empty(0))) for column in extra]
        lines.append(f"| {title} | {name} | {' | '.join(cells)} |")
    return lines


def _median(values: Array) -> str:
    """Write the median of some values that are no measure, or a dash if there are none."""
    values = values[~np.isnan(values)]
    if not len(values):
        return "–"
    median = float(np.median(values))
    return f"{median:.2g}" if median >= SMALLEST else "0"


def _best_baseline(task: ModuleType, values: Values, measure: str) -> str:
    """Choose the baseline with the best median; one that refuses counts as infinitely bad there."""

    def median(baseline: str) -> float:
        return float(np.median(_benefits(values[baseline, measure], task.MEASURES[measure])))

    return max(task.BASELINES, key=median)


def _benefits(values: Array, less_is_better: bool) -> Array:
    """Return values of which more is better, -inf for a refusal."""
    return np.where(np.isnan(values), -np.inf, -values if less_is_better else values)


def _cell(task: ModuleType, values: Values, method: str, measure: str, baseline: str) -> str:
    """Write the quartiles of a method; unless it is a baseline, also its wins and losses against the best."""
    text = _quartiles(values[method, measure])
    if method == OF_CLIPS:
        return "–" if np.isnan(values[method, measure]).all() else text
    if method in task.BASELINES:
        return text
    benefits = _benefits(values[method, measure], task.MEASURES[measure])
    wins, losses = _wins_and_losses(benefits, _benefits(values[baseline, measure], task.MEASURES[measure]))
    return f"{text}; **{wins} : {losses}**" if losses > wins else f"{text}; {wins} : {losses}"


def _wins_and_losses(benefits: Array, baseline_benefits: Array) -> tuple[int, int]:
    """Count the cases that a method wins and loses; a refusal loses, unless the baseline refuses too."""
    is_equal = np.isclose(benefits, baseline_benefits, rtol=1e-6, atol=5e-5)  # but for rounding
    wins = ~is_equal & (benefits > baseline_benefits)
    losses = ~is_equal & (benefits < baseline_benefits)
    return int(wins.sum()), int(losses.sum())


def _quartiles(values: Array) -> str:
    """Write the median and the quartiles of the values that are not refusals."""
    values = values[~np.isnan(values)]
    if not len(values):
        return "none"
    low, middle, high = np.percentile(values, [25, 50, 75])
    digits = _digits(abs(high))
    return f"{middle:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"


def _digits(size: float) -> int:
    """Return the number of decimals of a cell whose upper quartile has this size."""
    if size <= 5e-5:
        return 0
    exponent = int(np.floor(np.log10(max(size, 1e-3))))
    return 2 if exponent == 0 else max(0, 1 - exponent)


class Cell(NamedTuple):
    """The cases that a method wins and loses by one measure, and if that is decided by construction."""

    measure: str
    wins: int
    losses: int
    is_decided: bool


class TableRow(NamedTuple):
    """A row of a table: medians by measure, of which more is better, and the cells that are compared."""

    collection: int
    method: str
    is_baseline: bool
    medians: tuple[float, ...]
    cells: tuple[Cell, ...]


def rows_of(text: str) -> list[TableRow]:
    """Read the rows of a section's table."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    heads = [head for head in _split(lines[0])[2:] if head[-1] in "↓↑"] if lines else []
    collection = 0
    rows = []
    for line in lines[2:]:
        title, name, *cells = _split(line)
        collection += bool(title)
        method = name.partition(", refuses")[0]
        if method == OF_CLIPS:
            continue
        medians = tuple(_benefit(head, cell) for head, cell in zip(heads, cells, strict=False))
        compared = []
        for head, cell in zip(heads, cells, strict=False):
            for wins, losses, mark in PAIR.findall(cell):
                compared.append(Cell(head[:-2], int(wins), int(losses), bool(mark)))
        is_baseline = method.startswith("*")
        rows.append(TableRow(collection, method.strip("*"), is_baseline, medians, tuple(compared)))
    return rows


def _split(line: str) -> list[str]:
    """Split a line of a table into its cells."""
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def _benefit(head: str, cell: str) -> float:
    """Read the median of a cell, of which more is better; -inf if all cases were refused."""
    number = re.match(r"-?[\d.]+", cell)
    if number is None:
        return -np.inf
    return -float(number[0]) if head.endswith("↓") else float(number[0])


def dominates(first: Sequence[float], second: Sequence[float]) -> bool:
    """Return whether values, of which more is better, are nowhere worse than others, and somewhere better."""
    differences = [
        value - compared for value, compared in zip(first, second, strict=True) if value != compared
    ]
    return bool(differences) and min(differences) > 0


RANKS = {  # of a row: the heading of its column
    "every": "better than every baseline",
    "some": "better than some, worse than none",
    "neither": "neither",
    "worse": "worse than a baseline",
}


def summary(sections: Mapping[str, str]) -> list[str]:
    """Count on all measures at once, and by single measures, how each method does beside the baselines."""
    heads = [*RANKS.values(), "wins", "as good", "the baseline wins", "of these decided"]
    lines = [f"| | | {' | '.join(heads)} |", "|" + "---|" * (2 + len(heads))]
    for title, text in sections.items():
        rows = rows_of(text)
        for method in dict.fromkeys(row.method for row in rows if row.cells):
            of_method = [row for row in rows if row.method == method]
            ranks = [_rank(row, rows) for row in of_method]
            counts = [ranks.count(rank) for rank in RANKS]
            counts += _wins_of_cells([cell for row in of_method for cell in row.cells])
            lines.append(f"| {title} | {method} | {' | '.join(map(str, counts))} |")
    return lines


def _wins_of_cells(cells: Collection[Cell]) -> list[int]:
    """Count the cells that are won, those that are as good, those that are lost, and the decided of these."""
    losses = [cell for cell in cells if cell.losses > cell.wins]
    wins = sum(cell.wins > cell.losses for cell in cells)
    return [wins, len(cells) - wins - len(losses), len(losses), sum(cell.is_decided for cell in losses)]


def _rank(row: TableRow, rows: Sequence[TableRow]) -> str:
    """Compare a row with each baseline of its collection, by the medians of all measures at once."""
    in_collection = [candidate for candidate in rows if candidate.collection == row.collection]
    baselines = [candidate for candidate in in_collection if candidate.is_baseline]
    if any(dominates(baseline.medians, row.medians) for baseline in baselines):
        return "worse"
    beaten = [dominates(row.medians, baseline.medians) for baseline in baselines]
    if all(beaten):
        return "every"
    return "some" if any(beaten) else "neither"


def list_decided(sections: Mapping[str, str]) -> list[str]:
    """List what is decided by construction, and the cells that the baselines win before and after."""
    lines = ["| | measure | cells that the baseline wins | why no method can win them |", "|---|---|---|---|"]
    total = 0
    decided = 0
    for title, text in sections.items():
        cells = [cell for row in rows_of(text) for cell in row.cells]
        lost = [cell for cell in cells if cell.losses > cell.wins]
        total += len(lost)
        for measure, reason in _decisions(title).items():
            count = sum(cell.measure == measure for cell in lost)
            decided += count
            lines.append(f"| {title} | {measure} | {count} | {reason} |")
    sentence = f"By single measures, the best baseline wins {total} cells. Of these {decided} are decided by"
    return [f"{sentence}\nconstruction (†), which leaves {total - decided}:", "", *lines]


def _decisions(title: str) -> Mapping[str, str]:
    """Return the measures that a task says are decided by construction, and why."""
    names = {title_of(name): name for name in TASKS}
    decisions: Mapping[str, str] = getattr(import_module(f"tasks.{names[title]}"), "DECIDED", {})
    return decisions


def marked(title: str, text: str) -> str:
    """Mark the cells of a table that are decided by construction."""
    decisions = _decisions(title)
    lines = text.splitlines()
    heads = [head[:-2] for head in _split(lines[0])] if lines else []
    columns = [number for number, head in enumerate(heads) if head in decisions]
    for number, line in enumerate(lines):
        if PAIR.search(line):
            cells = [cell.rstrip(f" {DECIDED}") for cell in _split(line)]
            for column in columns:
                cells[column] += f" {DECIDED}"
            lines[number] = f"| {' | '.join(cells)} |"
    return "\n".join(lines)


HEAD = """# Every method beside the simple ones

Written by `python figures/benchmark.py`, which needs no other clips than the bundled ones; sets that are not
at hand are left out. Each cell has the median and [quartiles] over the cases, whose number is in brackets;
then, as in 9 : 3, how many cases the method wins and loses against the best baseline (in *italics*) by that
measure, case by case; in **bold** where the baseline wins more. Who refuses a case loses it. ↓ less is
better, ↑ more is better. Seams per second and the CPU time of an answer are no measures, but medians of what
it takes. *The clips themselves* have those measures that a clip can have.

By one measure one baseline is the best, and by the next another: a clip that is turned at once obeys, and
slides. So the first four columns count rows, by the medians of all measures at once: a method is better than
a baseline if it is nowhere worse and somewhere better. The last four count cells."""


def section(name: str, folders: tuple[Path, ...], entered: Path | None) -> str:
    """Run a task, and write its section without the title."""
    task = import_module(f"tasks.{name}")
    rows = list(run(task, cases(task, folders), entered / name if entered else None))
    missing = [collection for collection, names in task.CLIPS.items() if clips(names, folders) is None]
    note = ["", f"Not at hand: {', '.join(missing)}."] if missing else []
    return "\n".join([*table(task, rows), *note])


def sections_of(text: str) -> dict[str, str]:
    """Take the sections of a page by their titles: what is below the text of the task."""
    _, *parts = re.split(r"^## ", text, flags=re.MULTILINE)
    sections = {title: rest.strip() for title, _, rest in (part.partition("\n") for part in parts)}
    return {title: rest[max(rest.find("| | |"), 0) :] for title, rest in sections.items()}


def page(sections: Mapping[str, str]) -> str:
    """Write the page: a summary, and the sections in the order of the tasks."""
    in_order = {title_of(name): name for name in TASKS if title_of(name) in sections}
    tables = {title: marked(title, sections[title]) for title in in_order}
    texts = []
    for title, name in in_order.items():
        description = (import_module(f"tasks.{name}").__doc__ or "").strip()
        texts.append(f"## {title}\n\n{description}\n\n{tables[title]}")
    counts = ["\n".join(summary(tables)), "\n".join(list_decided(tables))]
    return "\n\n".join([HEAD, *counts, *texts]) + "\n"


def title_of(name: str) -> str:
    """Write a task's name as a title."""
    return name.replace("_", " ").capitalize()


def data_folders() -> list[Path]:
    """List the folders of captured clips that are read by default."""
    folders = [kept_in()]
    if "MOCAP_REAL_DATA" in os.environ:
        folders.append(Path(os.environ["MOCAP_REAL_DATA"]))
    return folders


def argument_parser() -> argparse.ArgumentParser:
    """Describe the arguments of the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", choices=[*TASKS, []], help="all of them by default")
    folders = data_folders()
    parser.add_argument("--data", type=Path, nargs="+", default=folders, help="folders of captured clips")
    parser.add_argument("--enter", type=Path, help="a folder of another program's answers")
    parser.add_argument("--again", action="store_true", help="count anew what the page holds, and stop")
    parser.add_argument("--write", type=Path, help="write what the cases give, and stop")
    return parser


def put_into_page(name: str, text: str) -> None:
    """Replace a task's section in the page."""
    sections = sections_of(PAGE.read_text("utf-8")) if PAGE.exists() else {}
    write_file(PAGE, page({**sections, title_of(name): text}))


def main(arguments: Sequence[str] | None = None) -> None:
    """Run tasks, print their sections, and put them into the page, unless another program's answers enter."""
    parser = argument_parser()
    options = parser.parse_args(arguments)
    if options.enter and not options.enter.is_dir():
        parser.error(f"There is no folder '{options.enter}' to enter.")
    if options.again:
        write_file(PAGE, page(sections_of(PAGE.read_text("utf-8"))))
        return
    warnings.simplefilter("ignore", MocapWarning)
    folders = tuple(options.data)
    for name in options.tasks or TASKS:
        if options.write:
            for case in cases(import_module(f"tasks.{name}"), folders):
                write(options.write / name, case)
            continue
        text = section(name, folders, options.enter)
        print(f"## {title_of(name)}\n\n{text}\n", flush=True)
        if not options.enter:
            put_into_page(name, text)


if __name__ == "__main__":
    main()
