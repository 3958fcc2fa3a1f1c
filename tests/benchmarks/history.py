"""The history of the benchmarks: one line for each ratio of each run that was recorded.

    pytest -m benchmark -n 0 tests/benchmarks --record-benchmarks tests/benchmarks/history.tsv
    python -m tests.benchmarks.history

The first command records a run; `.ci/release benchmarks` does so. The second prints, for each benchmark, its
last ratio beside the one before. A line has tabs between its columns: date, commit, processor, benchmark,
ratio, bound and a note, in which the load says whether the machine was idle.
"""

import os
import platform
import re
import subprocess
from collections.abc import Iterable, Sequence
from datetime import date
from pathlib import Path
from typing import NamedTuple

from tests.benchmarks.timing import Ratio

HISTORY = Path(__file__).with_name("history.tsv")
CPU_INFO = Path("/proc/cpuinfo")


class Entry(NamedTuple):
    """A line of the history: a ratio, with where and when it was measured."""

    date: str
    commit: str
    processor: str
    benchmark: str
    ratio: float
    bound: float
    note: str


def read_history(file: Path = HISTORY) -> list[Entry]:
    """Read all entries of a history, in order; a missing file has none."""
    if not file.exists():
        return []
    heading, *lines = file.read_text("utf-8").splitlines()
    assert heading.split("\t") == list(Entry._fields), f"'{file.name}' begins with other columns: {heading}"
    entries = []
    for line in lines:
        day, commit, name, benchmark, value, bound, note = line.split("\t")
        entries.append(Entry(day, commit, name, benchmark, float(value), float(bound), note))
    return entries


def record(ratios: Iterable[Ratio], file: Path = HISTORY, note: str = "") -> None:
    """Append the ratios of a run to a history."""
    if not file.exists():
        file.write_text("\t".join(Entry._fields) + "\n", "utf-8")
    run = date.today().isoformat(), commit(), processor()
    with file.open("a", encoding="utf-8") as history:
        for benchmark, value, bound in ratios:
            columns = [*run, benchmark, f"{value:.4g}", f"{bound:.4g}", note]
            if any(re.search(r"[\t\r\n]", column) for column in columns):
                raise ValueError(f"A column of '{benchmark}' holds a tab or a line end.")
            history.write("\t".join(columns) + "\n")


def commit() -> str:
    """Return the commit of this checkout, with a + if files differ from it."""
    git = ["git", "-C", str(HISTORY.parents[2])]
    head = subprocess.run(
        [*git, "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=False
    )
    if head.returncode != 0:
        return "unknown"
    files = ["--", ":/", f":(exclude,top){HISTORY.relative_to(HISTORY.parents[2]).as_posix()}"]
    changed = subprocess.run(
        [*git, "status", "--porcelain", "--untracked-files=no", *files],
        capture_output=True,
        text=True,
        check=True,
    )
    return head.stdout.strip() + ("+" if changed.stdout else "")


def processor() -> str:
    """Return the name of the processor and the number of its cores that there are."""
    info = CPU_INFO.read_text("utf-8") if CPU_INFO.exists() else ""
    named = re.search(r"^model name\s*: (.+)$", info, re.MULTILINE)
    name = named[1].strip() if named else platform.processor() or platform.machine()
    return f"{name}, {os.cpu_count()} cores"


def load_note() -> str:
    """Return the load of the last 15 minutes, the mean number of processes that wanted a core."""
    if not hasattr(os, "getloadavg"):
        return ""
    return f"load {os.getloadavg()[2]:.1f}"


def compare(ratios: Iterable[Ratio], history: Sequence[Entry]) -> str:
    """Return a table of ratios beside their bounds and the last ratios of a history, with the factors."""
    last = {entry.benchmark: entry for entry in history}  # later ones replace those before them
    lines = [f"{'ratio':>9} {'bound':>9} {'last':>9} {'factor':>7}  benchmark"]
    for held in ratios:
        previous = last.get(held.benchmark)
        change = f"{previous.ratio:9.3g} {held.value / previous.ratio:7.2f}" if previous else " " * 17
        line = f"{held.value:9.3g} {held.bound:9.3g} {change}  {held.benchmark}  {held.mark}"
        lines.append(line.rstrip())
    return "\n".join(lines)


def main() -> None:
    """Print the last ratio of each benchmark in the history beside the one before."""
    history = read_history()
    newest = {entry.benchmark: place for place, entry in enumerate(history)}
    places = sorted(newest.values())
    ratios = [Ratio(history[place].benchmark, history[place].ratio, history[place].bound) for place in places]
    print(compare(ratios, [entry for place, entry in enumerate(history) if place not in places]))


if __name__ == "__main__":
    main()
