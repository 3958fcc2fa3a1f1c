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
PAIRS = re.compile(r"; \**(\d+) : (\d+)")  # wins and losses in a cell


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


def clips(names: Iterable[str], folders: tuple[Path, ...]) -> list[mocap.Motion] | None:
    """Load clips at 30 Hz with their plants marked; None where one is not at hand."""
    if any("/" in name and name not in files(folders) for name in names):
        return None
    return [_clip(name, files(folders).get(name)) for name in names]


@cache
def _clip(name: str, path: Path | None) -> mocap.Motion:
    clip = mocap.load(path, scale=SCALES.get(path.parent.name)) if path else datasets.sample(name)
    clip = replace(mocap.resample(clip, 30), name=name.rpartition("/")[2])
    return clip if clip.contacts else feet.mark_plants(clip)


def cases(task: ModuleType, folders: tuple[Path, ...]) -> Iterator[Case]:
    """Yield the cases of all collections that are at hand."""
    for collection, names in task.CLIPS.items():
        loaded = clips(names, folders)
        if loaded is not None:
            yield from task.cases(collection, loaded)


def run(task: ModuleType, task_cases: Iterable[Case], entered: Path | None = None) -> Iterator[Row]:
    """Answer all cases by all methods, and score the answers, also those in the folder `entered`."""
    for case in task_cases:
        for method, values in scores(task, case, entered):
            for measure, value in zip(task.MEASURES, values, strict=True):
                yield Row(case.collection, method, case.name, measure, float(value))


def scores(
    task: ModuleType, case: Case, entered: Path | None = None
) -> Iterator[tuple[str, Sequence[float] | Array]]:
    """Yield the scores of each method in a case, then those of the answer that is entered; NaN if refused."""
    refused = [np.nan] * len(task.MEASURES)
    example = None  # the first answer with rows: the one that is entered has its form
    for name, method in task.METHODS.items():
        try:
            answer = method(case)
            example = answer if example is None or not len(example) else example
            values = task.score(case, answer)
        except MocapError:
            values = refused
        yield name, values
    if entered:
        try:
            values = task.score(case, read(entered, case, example))
        except MocapError as error:
            print(f"{case.collection}, {case.name}: {error}", file=sys.stderr)
            values = refused
        yield ENTERED, values


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
    lines = [f"| | | {' | '.join(names)} |", "|---" * (2 + len(names)) + "|"]
    for collection in dict.fromkeys(row.collection for row in rows):
        values = values_by_method([row for row in rows if row.collection == collection])
        lines += lines_of_collection(task, collection, values)
    return lines


def values_by_method(rows: Iterable[Row]) -> dict[tuple[str, str], Array]:
    """Collect the values of each method and measure, in the order of the cases."""
    values: dict[tuple[str, str], list[float]] = {}
    for row in rows:
        values.setdefault((row.method, row.measure), []).append(row.value)
    return {method_and_measure: np.array(listed) for method_and_measure, listed in values.items()}


def lines_of_collection(task: ModuleType, collection: str, values: Values) -> list[str]:
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
        lines.append(f"| {title} | {name} | {' | '.join(cells)} |")
    return lines


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


def summary(sections: Mapping[str, str]) -> list[str]:
    """Count in how many cells of its section each method wins and loses."""
    lines = ["| | | wins | as good | the baseline wins |", "|---|---|---|---|---|"]
    for title, text in sections.items():
        for method, leads in leads_by_method(text).items():
            wins = sum(lead > 0 for lead in leads)
            losses = sum(lead < 0 for lead in leads)
            lines.append(f"| {title} | {method} | {wins} | {leads.count(0)} | {losses} |")
    return lines


def leads_by_method(text: str) -> dict[str, list[int]]:
    """Read, from each cell of a section, by how many cases a method leads the best baseline."""
    leads: dict[str, list[int]] = {}
    for line in text.splitlines():
        if line.startswith("|") and PAIRS.search(line):
            _, name, *cells = re.split(r" ?\| ", line.strip("|"))
            method = name.partition(", refuses")[0]
            pairs = PAIRS.findall(" ".join(cells))
            leads.setdefault(method, []).extend(int(wins) - int(losses) for wins, losses in pairs)
    return leads


HEAD = """# Every method beside the best simple one

Written by `python figures/benchmark.py`, which needs no other clips than the bundled ones; sets that are not
at hand are left out. Each cell has the median and [quartiles] over the cases, whose number is in brackets;
then, as in 9 : 3, how many cases the method wins and loses against the best baseline (in *italics*) by that
measure, case by case; in **bold** where the baseline wins more. Who refuses a case loses it. ↓ less is
better, ↑ more is better. Where a baseline is the best by one measure, another may be the best by the next."""


def section(name: str, folders: tuple[Path, ...], entered: Path | None) -> str:
    """Run a task, and write its section without the title."""
    task = import_module(f"tasks.{name}")
    rows = list(run(task, cases(task, folders), entered / name if entered else None))
    missing = [collection for collection, names in task.CLIPS.items() if clips(names, folders) is None]
    note = ["", f"Not at hand: {', '.join(missing)}."] if missing else []
    return "\n".join([(task.__doc__ or "").strip(), "", *table(task, rows), *note])


def sections_of(text: str) -> dict[str, str]:
    """Take the sections of a page by their titles."""
    _, *parts = re.split(r"^## ", text, flags=re.MULTILINE)
    return {title: rest.strip() for title, _, rest in (part.partition("\n") for part in parts)}


def page(sections: Mapping[str, str]) -> str:
    """Write the page: a summary, and the sections in the order of the tasks."""
    titles = [title_of(name) for name in TASKS]
    in_order = {title: sections[title] for title in titles if title in sections}
    texts = [f"## {title}\n\n{text}" for title, text in in_order.items()]
    return "\n\n".join([HEAD, "\n".join(summary(in_order)), *texts]) + "\n"


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
