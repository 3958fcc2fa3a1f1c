"""Parametric graphs whose parameters, ranges and T_GOOD are chosen from the clips [ours].

`build_parametric` takes spaces and a T_GOOD as they are, and refuses an edge if a source has no good target.
Ordinary clips seldom suit a range and a T_GOOD that were chosen for others: a runner moves farther from
frame to frame than one who walks, and few clips show what follows the sharpest turn. Here T_GOOD is as large
as the clips need, up to the distance by which their poses change in 1/15 s. Sources without a good target
below that are left out, by narrower ranges.

Notebook: 17-parametric-graphs
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError, NoWalk, warn
from mocap.methods.parametric_graphs.examples import Examples
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.parametric_edges import build_edge, build_parametric, shrink_box
from mocap.methods.parametric_graphs.stride_spaces import (
    PARAMETERS,
    Space,
    make_space,
    parameter_text,
    spread_parameters,
)
from mocap.methods.parametric_graphs.strides import STRIDE, cut_strides
from mocap.methods.parametric_graphs.tuned import TUNED

Range = tuple[Array, Array]
"""The lowest and the highest parameters of a space, (d,) each."""


def fit_strides(
    clips: Sequence[Motion],
    *,
    feet: Sequence[str] = ("lr", "rl"),
    limit: float = TUNED.largest_rotation,
    good: float = TUNED.good,
) -> nx.DiGraph:
    """Build a parametric graph of strides or steps from clips as they are.

    Examples are cut with the shortest margins. The parameter is the turn or, if the clips hardly turn, the
    speed. The graph is that of `fit_parametric`.

    Parameters
    ----------
    clips : clips of one skeleton and rate.
    feet : the strikes of each node, as for `cut_strides`: ("lrl",) for strides, or ("lr", "rl") for steps,
        which obey in half the time. Each node is followed by the next, and the last by the first.
    limit : the largest turn of a stride, radians. That of a step is 0.55 times as large.
    good : the smallest T_GOOD, metres.

    Raises
    ------
    MocapError : for clips whose strides neither turn nor vary in speed, with the clips that are missing.
    NoWalk : as for `fit_parametric`.

    Warns
    -----
    MocapWarning : as for `fit_parametric`.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> graph = fit_strides([body.resample(datasets.sample("walk_curve_2"), 30)], feet=("lrl",), limit=0.8)
    >>> space = graph.nodes["lrl"]["space"]
    >>> space.parameters, space.low.round(1).tolist(), space.high.round(1).tolist(), list(graph.edges)
    (('turn',), [-0.8], [0.8], [('lrl', 'lrl')])
    """
    cut = {kind: cut_strides(clips, feet=kind, margin=None) for kind in feet}
    spaces = _turn_spaces(cut, limit) or _speed_spaces(cut)
    if not spaces:
        raise _alike(cut)
    following = [*feet[1:], feet[0]]
    return fit_parametric(spaces, list(zip(feet, following, strict=True)), good=good)


def _turn_spaces(cut: Mapping[str, Examples], limit: float) -> dict[str, Space]:
    """Return a space of turns for each kind, or none if the examples of a kind hardly turn."""
    spaces = {}
    for kind, examples in cut.items():
        share = 1.0 if kind == STRIDE else TUNED.step_fraction
        width = TUNED.rotation_width * share
        if len(examples) < 2 or np.ptp(examples.values[:, 0]) < TUNED.rotations_from * width:
            return {}
        spaces[kind] = make_space(examples, width, -limit * share, limit * share)
    return spaces


def _speed_spaces(cut: Mapping[str, Examples]) -> dict[str, Space]:
    """Return a space of speeds for each kind, or none if the examples of a kind have one speed."""
    spaces = {}
    for kind, examples in cut.items():
        speeds = examples.values[:, 1]
        if len(examples) < 2 or np.ptp(speeds) < TUNED.speeds_from * TUNED.speed_width:
            return {}
        ends = float(speeds.min()), float(speeds.max())
        spaces[kind] = make_space(examples, TUNED.speed_width, *ends, parameter="speed")
    return spaces


def _alike(cut: Mapping[str, Examples]) -> MocapError:
    """Return the error for clips whose strides are all alike, with the clips that are missing."""
    kind, examples = min(cut.items(), key=lambda item: len(item[1]))
    texts = []
    for name, column in zip(PARAMETERS, examples.values.T, strict=True):
        texts.append(f"{name} {parameter_text(name, column.min())} to {parameter_text(name, column.max())}")
    present = f"The clips have {len(examples)} '{kind}', {' and '.join(texts)}"
    missing = "a clip that turns to the left and one to the right, or one that is quicker by 0.3 m/s"
    return MocapError(f"{present}: too alike for a parameter. Add {missing}.")


def fit_parametric(
    spaces: Mapping[str, Space],
    edges: Sequence[tuple[str, str]],
    *,
    good: float = TUNED.good,
    worst: float | None = None,
    sampling: tuple[int, int] = TUNED.sampling,
) -> nx.DiGraph:
    """Build a parametric motion graph with the T_GOOD and the ranges that its examples allow [ours].

    A range is narrowed until each source in it has a target below `worst` in the range of what follows. Then
    T_GOOD is the smallest value at which all edges exist, but at least `good`: the largest `smallest_good` of
    the edges.

    Parameters
    ----------
    spaces, edges, sampling : as for `build_parametric`.
    good : the smallest T_GOOD, metres.
    worst : the largest T_GOOD, metres, by default the largest change of the examples' poses in 1/15 s, but at
        least 1.5 `good`. If more than a third of a range would be lost, it is 1.25 times as large.

    Returns
    -------
    A graph as that of `build_parametric`.

    Raises
    ------
    NoWalk : if less than a quarter of a range is left, with the example that is missing.
    MocapError : as for `build_parametric`.

    Warns
    -----
    MocapWarning : for a range that was narrowed by more than a tenth, and for a T_GOOD above `good`.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> graph = fit_parametric({"walk": make_space(strides, 0.4, -0.8, 0.8)}, [("walk", "walk")])
    >>> edge = graph.edges["walk", "walk"]["edge"]
    >>> round(edge.smallest_good, 3), graph.nodes["walk"]["space"].high.round(2)
    (0.027, array([0.8]))
    """
    if worst is None:
        changes = [pose_change(space.examples) for space in spaces.values()]
        worst = max(TUNED.worst * good, *changes)
    costs = {pair: _sampled(spaces[pair[0]], spaces[pair[1]]) for pair in edges}
    ranges = _ranges(spaces, costs, worst)
    fitted = {name: _within(space, ranges[name]) for name, space in spaces.items()}
    needed = [
        build_edge(fitted[source], fitted[target], good=np.inf, sampling=sampling).smallest_good
        for source, target in edges
    ]
    if max(needed) > good:
        warn(f"T_GOOD is {100 * max(needed):.1f} cm, as these examples need, instead of {100 * good:.1f} cm.")
    return build_parametric(fitted, edges, good=max(good, *needed), sampling=sampling)


def pose_change(examples: Examples, seconds: float = TUNED.pose_change) -> float:
    """Compute how far the poses of examples change in a short time, metres RMS over joints and phases.

    Positions are relative to the root on the ground and to the heading. Two windows that differ by less are
    as similar as a motion is to itself a moment later.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> names = ("walk_6m_0.7_0", "walk_6m_1.65_0")
    >>> walks = [cut_strides([body.resample(datasets.sample(name), 30)]) for name in names]
    >>> [round(pose_change(strides), 3) for strides in walks]
    [0.038, 0.084]
    """
    first, last = examples.ends
    joints = examples.joints
    squares = []
    for poses, heights, times in zip(examples.poses, examples.heights, examples.seconds, strict=True):
        roots = np.zeros((len(heights), 3))
        roots[:, 1] = heights
        points = joint_positions(Motion(examples.skeleton, roots, poses, examples.fps))[
            first : last + 1, joints
        ]
        rates = np.diff(points, axis=0) / np.diff(times[first : last + 1])[:, None, None]
        squares.append((rates**2).sum(axis=-1).mean())
    return float(np.sqrt(np.mean(squares)) * seconds)


class _Sampled(NamedTuple):
    """The costs (S, T) of transitions from sources (S, d) to targets (T, d'), metres."""

    sources: Array
    targets: Array
    costs: Array


def _sampled(source: Space, target: Space) -> _Sampled:
    """Compute the costs between sources and targets that are spread over both spaces."""
    sources = spread_parameters(source, TUNED.fitting[0])
    targets = spread_parameters(target, TUNED.fitting[1])
    return _Sampled(sources, targets, optimal_transitions(source, target, sources, targets)[0])


def _ranges(
    spaces: Mapping[str, Space], costs: Mapping[tuple[str, str], _Sampled], worst: float
) -> dict[str, Range]:
    """Narrow ranges at `worst`, or at a somewhat larger cost if one of them would lose more than a third.

    Otherwise one poor source in the middle of a range would cost all turns to one side.
    """
    try:
        ranges = _narrowed(spaces, costs, worst)
    except NoWalk:
        return _narrowed(spaces, costs, TUNED.beyond_worst * worst)
    for name, (low, high) in ranges.items():
        if ((high - low) < TUNED.most_range * (spaces[name].high - spaces[name].low)).any():
            return _narrowed(spaces, costs, TUNED.beyond_worst * worst)
    return ranges


def _narrowed(
    spaces: Mapping[str, Space], costs: Mapping[tuple[str, str], _Sampled], worst: float
) -> dict[str, Range]:
    """Narrow ranges until each source inside has a target below `worst` inside, along each edge."""
    ranges: dict[str, Range] = {name: (space.low, space.high) for name, space in spaces.items()}
    is_settled = False
    while not is_settled:
        is_settled = True
        for (name, following), sampled in costs.items():
            is_target = _inside(sampled.targets, ranges[following])
            lowest = sampled.costs[:, is_target].min(axis=1, initial=np.inf)
            is_source = _inside(sampled.sources, ranges[name])
            if (lowest[is_source] > worst).any():
                is_settled = False
                ranges[name] = _range_of_good(spaces[name], sampled.sources, is_source & (lowest <= worst))
                _require_wide(spaces[name], name, ranges[name], sampled, worst)
    return ranges


def _range_of_good(space: Space, sources: Array, is_good: Mask) -> Range:
    """Return the box of the good sources without those that are not good, or an empty one."""
    if not is_good.any():
        return space.high, space.low
    return shrink_box(sources[is_good], sources[~is_good], space.scale)


def _inside(parameters: Array, limits: Range) -> Mask:
    """Return which of the parameters (M, d) are in a range."""
    low, high = limits
    return np.asarray(((parameters >= low) & (parameters <= high)).all(axis=1))


def _require_wide(space: Space, name: str, limits: Range, sampled: _Sampled, worst: float) -> None:
    """Raise NoWalk if little of a space is left, with the source that lacks a target most."""
    low, high = limits
    if (high - low >= TUNED.least_range * (space.high - space.low)).all():
        return
    lowest = sampled.costs.min(axis=1)
    number = int(lowest.argmax())
    source = _described(space, sampled.sources[number])
    below = f"below {100 * worst:.1f} cm (the best costs {100 * lowest[number]:.1f} cm)"
    raise NoWalk(f"Nothing follows '{name}' with {source} {below}: add a clip that continues after it.")


def _described(space: Space, parameters: Array) -> str:
    """Format the parameters (d,) of a space with their names and units."""
    named = zip(space.parameters, parameters, strict=True)
    return ", ".join(f"{name} {parameter_text(name, value)}" for name, value in named)


def _within(space: Space, limits: Range) -> Space:
    """Return a space with a narrower range, and warn if it lost more than a tenth."""
    low, high = limits
    full = space.high - space.low
    if ((high - low) < (1 - TUNED.reported_loss) * full).any():
        texts = []
        for name, start, stop in zip(space.parameters, low, high, strict=True):
            texts.append(f"{name} {parameter_text(name, start)} to {parameter_text(name, stop)}")
        warn(f"A range was narrowed to {', '.join(texts)}: what lies beyond has no good successor.")
    is_single = len(space.parameters) == 1
    scale = (high - low) / 2 if is_single else space.scale
    return replace(space, low=low, high=high, scale=scale)
