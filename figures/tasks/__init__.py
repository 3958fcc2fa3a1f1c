"""The tasks of `benchmark.py`, each in a file of its own, with its clips, seeds and splits.

A task is a module with

- a docstring: what is asked for, and what the measures are; it is printed above the tables;
- `CLIPS`: {collection: names of clips}; "16/16_15" is the file 16_15 in a folder 16, a name alone is bundled;
- `MEASURES`: {name, with its unit: whether less is better};
- `cases(collection, clips)`: yields a `Case` for each thing that is asked; clips are at 30 Hz, plants marked;
- `METHODS`: {name: function of a case that gives the answer}, and `BASELINES`: those that are the simplest;
- `score(case, answer)`: a number for each measure, NaN where there is none;
- perhaps `DECIDED`: {measure: why no method can win it}; such cells are marked, and counted by themselves;
- perhaps `of_clips(case)`: the measures of the clips themselves, NaN where they have none;
- perhaps `RATES`: {collection: frames per second}, where the clips are not resampled to 30 Hz.

An answer is a `Motion` or an array of shape (rows, columns). A method that raises `MocapError` refuses. One
that walks through a graph returns a `Walked`, whose seams per second are printed, as is the CPU time of each
answer; neither is a measure.
What is given are motions, arrays and tuples of clips. Another program finds them as files, and hands in its
answers the same way: `benchmark.py --help`.
So `score` reads nothing from an answer but bones and places: plants, say, are those of the case.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from mocap._shared.arrays import Array
from mocap.body import Motion
from mocap.graphs import build, compile_graph, prune
from mocap.graphs.compiled_graph import CompiledGraph

TASKS = tuple(sorted(path.stem for path in Path(__file__).parent.glob("[a-z]*.py")))

WALKS = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
CMU_16 = tuple(f"16/16_{trial:02}" for trial in (*range(11, 35), 47, 58))
HOMEWORK = ("hw3/walk_fwd_circle", "hw3/walk_fwd_curve1", "hw3/walk_fwd_curve2")
STRAIGHT = ("02/02_01", "02/02_02")  # walks without turns
BANDAI = tuple(
    f"bandai_namco/dataset-{name}_001"
    for name in ("1_walk_normal", "2_walk_normal", "2_walk-turn-left_normal", "2_walk-turn-right_normal")
)


Answer = Motion | Array


class Walked(NamedTuple):
    """An answer that is a walk through a graph, with the seams per second of it."""

    motion: Motion
    seams: float


class Case(NamedTuple):
    """One thing that is asked for: what methods are given, motions or arrays, and what only `score` knows."""

    collection: str
    name: str
    given: Mapping[str, Any]  # reads: name: the tasks and the files of other programs have it
    truth: Any = None


@cache
def graph(clips: tuple[Motion, ...], threshold: float = 0.04) -> CompiledGraph:
    """Build the motion graph of some clips, once."""
    return compile_graph(prune(build(clips, window=10, threshold=threshold)))


def without(clips: Sequence[Motion], names: Sequence[str]) -> tuple[Motion, ...]:
    """Leave out the clips that are tested with."""
    return tuple(clip for clip in clips if clip.name not in names)
