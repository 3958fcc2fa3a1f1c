"""From clips to a graph in one call: kinds of strides, changes between them, and all their edges [ours]."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array, Indices
from mocap._shared.easing import quintic_step
from mocap.body.motion import Motion
from mocap.errors import MocapError, NoWalk
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.parametric_edges import Sampling, smallest_good
from mocap.methods.parametric_graphs.parametric_motion_graphs import ParametricGraph, build_parametric
from mocap.methods.parametric_graphs.stride_spaces import Space, make_space, measure_mixes
from mocap.methods.parametric_graphs.strides import cut_strides

WIDTH = np.radians(14)  # of the bell, for strides
WIDEST = np.radians(75)  # of turn per stride, to either side
LEAST, MOST = 0.04, 0.08  # metres: T_GOOD where none is given
FROM, TO = 0.2, 0.8  # phases between which a change takes place
NEAR = np.radians(5)  # a turn that the other kind nearly has
EXAMPLES = 60  # of a change, at most


def build_kinds(
    kinds: Mapping[str, Sequence[Motion] | Examples],
    changes: Sequence[tuple[str, str]] | None = None,
    *,
    good: float | None = None,
    widest: float = WIDEST,
    sampling: Sampling | None = None,
) -> ParametricGraph:
    """Build a graph of kinds of strides, each of which follows itself, and of changes between them [ours].

    Each kind is a space asked by turn, and so is each change, under a name such as "walk to jog".

    Parameters
    ----------
    kinds : clips by the name of their kind, or strides already cut. Of clips that have the name as a label,
        only strides with that label are taken.
    changes : pairs of names; by default each kind changes into each other one.
    good : T_GOOD, metres; by default the smallest from 4 to 8 cm that gives all edges.
    widest : radians per stride, to either side; spaces end there, or where their strides do (from the 4th to
        the 96th percentile).
    sampling : as for `build_edge`; by default 25 sources and 250 targets.

    Returns
    -------
    The graph; with n kinds and c changes it has n + c nodes and n + 2 c edges.

    Raises
    ------
    NoWalk : for an edge that cannot be had, with what would help.
    MocapError : for no kinds, unknown names, and a kind, by name, whose strides are too few or hardly vary.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> names = ("walk_circle", "walk_curve_1", "walk_curve_2", "walk_straight")
    >>> walks = [body.resample(datasets.sample(name), 30) for name in names]
    >>> print(build_kinds({"walk": walks}, sampling=Sampling(12, 60)).report())
    walk → walk: boxes of ...° of turn, from ... cm on
    """
    if not kinds:
        raise MocapError("A graph has one kind of strides or more, got none.")
    sampling = sampling or Sampling(sources=25, targets=250)
    strides: dict[str, Examples] = {}
    for name, kind in kinds.items():
        with _naming(name):
            if isinstance(kind, Examples):
                strides[name] = kind
            else:
                label = name if any(name in clip.labels for clip in kind) else ""
                strides[name] = cut_strides(kind, label=label)
    edges = [(name, name) for name in strides]
    for one, other in permutations(strides, 2) if changes is None else changes:
        if unknown := {one, other} - set(kinds):
            raise MocapError(f"There is no kind '{min(unknown)}'; there are: {', '.join(kinds)}.")
        name = f"{one} to {other}"
        with _naming(name):
            strides[name] = changing_strides(strides[one], strides[other])
        edges += [(one, name), (name, other)]
    spaces = {}
    for name, some in strides.items():
        low, high = np.clip(np.percentile(some.values[:, 0], [4, 96]), -widest, widest)
        with _naming(name):
            spaces[name] = make_space(some, WIDTH, min(low, high - 1e-6), high)
    good = _least(spaces, edges, sampling) if good is None else good
    return build_parametric(spaces, edges, good=good, sampling=sampling)


@contextmanager
def _naming(name: str) -> Iterator[None]:
    """Name the kind where something is refused."""
    try:
        yield
    except MocapError as error:
        raise type(error)(f"{name}: {error}"[:200]) from error


def _least(spaces: Mapping[str, Space], edges: Sequence[tuple[str, str]], sampling: Sampling) -> float:
    """Find the T_GOOD that gives all edges, with a twentieth to spare."""
    needed = {}
    for a, b in edges:
        with _naming(f"{a} → {b}"):
            needed[a, b] = smallest_good(spaces[a], spaces[b], sampling)
    (one, other), worst = max(needed.items(), key=lambda item: item[1])
    if worst > MOST:
        needs = f"T_GOOD = {100 * worst:.1f} cm, more than {100 * MOST:.0f}"
        raise NoWalk(f"{one} → {other} needs {needs}: give `good`, narrow the range, or leave it out.")
    return max(LEAST, 1.05 * worst)


def changing_strides(first: Examples, second: Examples, *, stands: str = "") -> Examples:
    """Fade strides of one kind into strides of another, phase by phase [ours; KG03's transition on phases].

    Each stride of the first kind is paired with the one of the second that turns most like it. Between the
    phases 0.2 and 0.8 all rates and poses go from the one to the other, with level ends; so its start fits
    what follows the first kind, and its end what comes before the second.

    Parameters
    ----------
    first, second : examples over the same phases, of one skeleton and rate.
    stands : "first" or "second" for examples that do not walk, such as punches: of them only the beginning
        or the end is in the change, each foot of the walker takes its step from there or to there, and pairs
        need not turn alike.

    Returns
    -------
    At most 60 examples, of turns that both kinds have.

    Raises
    ------
    MocapError, SkeletonMismatch : for examples over other phases, and of other skeletons or rates.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> from mocap.body import resample
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> kinds = [cut_strides([resample(sample(f"walk_6m_{speed}_0"), 30)]) for speed in (0.7, 1.65)]
    >>> speeds = [kind.values[:, 1].mean() for kind in (kinds[0], changing_strides(*kinds), kinds[1])]
    >>> bool(speeds[0] < speeds[1] < speeds[2])
    True
    """
    if len(first.grid) != len(second.grid) or not np.allclose(first.grid, second.grid):
        raise MocapError("A change goes between examples over the same phases.")
    first.require_joinable(second)
    one, other = _pairs(first, second, any_turn=bool(stands))
    first, second = first.take(one), second.take(other)
    first = _held(first, -1, FROM) if stands == "first" else first
    second = _held(second, TO, 2) if stands == "second" else second
    made = _faded(first, second, quintic_step((first.grid - FROM) / (TO - FROM)), bool(stands))
    return replace(made, values=measure_mixes(made, np.eye(len(made))))


def _faded(first: Examples, second: Examples, share: Array, stands: bool) -> Examples:
    """Fade all rates and poses by a share (G,); marks change when half is faded, or come from both sides."""
    grid = first.grid
    apart = (first.poses * second.poses).sum(axis=-1, keepdims=True) < 0  # q and -q are one rotation
    poses = (first.poses, np.where(apart, -second.poses, second.poses))
    paces = [np.gradient(some.seconds, grid[1] - grid[0], axis=1) for some in (first, second)]

    def faded(before: NDArray[Any], after: NDArray[Any]) -> NDArray[Any]:
        amount = share.reshape(-1, *[1] * (before.ndim - 2))
        return np.asarray((1 - amount) * before + amount * after)

    turns = faded(*poses)
    until, since = (grid < 1, grid > 0) if stands else (share < 0.5, share >= 0.5)
    before, after = np.where(until[:, None], first.contacts, 1), np.where(since[:, None], second.contacts, 1)
    return replace(
        first,
        speeds=faded(first.speeds, second.speeds),
        turning=faded(first.turning, second.turning),
        heights=faded(first.heights, second.heights),
        seconds=first.integrated(faded(*paces)),  # how long a phase lasts is what fades
        poses=turns / np.linalg.norm(turns, axis=-1, keepdims=True),
        contacts=before * after,
        sway=(first.sway + second.sway) / 2,
        offset=(first.offset + second.offset) / 2,
        dropped=0,
    )


def _held(examples: Examples, low: float, high: float) -> Examples:
    """Let examples stand still before one phase and after another."""
    rows = np.searchsorted(examples.grid, np.clip(examples.grid, low, high) - 1e-9)
    goes = rows == np.arange(len(rows))
    moved = {part: getattr(examples, part) * goes for part in ("speeds", "turning")}
    stood = {part: getattr(examples, part)[:, rows] for part in ("heights", "poses")}
    return replace(examples, **moved, **stood, contacts=np.maximum(examples.contacts, ~goes[:, None]))


def _pairs(first: Examples, second: Examples, any_turn: bool) -> tuple[Indices, Indices]:
    """Pair examples of two kinds, spread over their turns: any two, or those that turn most alike."""
    turns, others = first.values[:, 0], second.values[:, 0]
    if any_turn:
        count = max(len(turns), len(others))
        return np.resize(_spread(turns), count)[:EXAMPLES], np.resize(_spread(others), count)[:EXAMPLES]
    shared = np.flatnonzero((turns >= others.min() - NEAR) & (turns <= others.max() + NEAR))
    if not len(shared):
        raise MocapError("The two kinds have no turn in common, so that none can change into the other.")
    one = shared[_spread(turns[shared])]
    return one, np.abs(turns[one][:, None] - others).argmin(axis=1)


def _spread(turns: Array) -> Indices:
    """Choose examples that are spread evenly in the order of their turns."""
    places = np.unique(np.linspace(0, len(turns) - 1, EXAMPLES).round().astype(int))
    return np.asarray(np.argsort(turns)[places])
