"""Parametric motion graphs: nodes are spaces of motions, edges are boxes of possible successors [HG07]."""

from collections.abc import Mapping, Sequence

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple, dataclass
from mocap.errors import MocapError, NoWalk
from mocap.methods.match_webs.target_weights import nearest_samples, neighbour_weights
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.stride_spaces import (
    Space,
    draw_parameters,
    parameter_text,
    spread_parameters,
)
from mocap.methods.parametric_graphs.tuned import TUNED


class TargetBox(NamedTuple):
    """The box of targets that may follow a source, and the phases of the transition.

    Parameters
    ----------
    low, high : shape (d,), corners of the box of the targets' parameters.
    leave, enter : phases at which to leave the source and to enter the target.

    Examples
    --------
    >>> TargetBox(np.array([-0.1]), np.array([0.4]), 1.0, 0.0).high
    array([0.4])
    """

    low: Array
    high: Array
    leave: float
    enter: float


@dataclass(frozen=True, eq=False)
class ParametricEdge:
    """The boxes of targets that may follow S sampled sources. `build_edge` has an example.

    Parameters
    ----------
    sources : shape (S, d), the parameters of the sources.
    low, high : shape (S, d'), the corners of the box of each source.
    leave, enter : shape (S,), phases near 1 and near 0.
    scale : shape (d,), the units in which distances between sources are measured.
    smallest_good : metres, the smallest T_GOOD at which every source has a target.
    """

    sources: Array
    low: Array
    high: Array
    leave: Array
    enter: Array
    scale: Array
    smallest_good: float

    def look_up(self, parameters: Array, count: int | None = None) -> TargetBox:
        """Interpolate the boxes of the sources nearest to given parameters (d,) [HG07, Eqs. 1-3].

        The farthest of k sources always has the weight 0. With k = d + 1, as in [HG07, 4], and one parameter,
        only the nearest source has a weight, and boxes jump. The default k is d + 4 [ours].

        Examples
        --------
        >>> at = np.arange(7.0)[:, None]
        >>> edge = ParametricEdge(at, at - 1, at + 1, at[:, 0] + 0.5, at[:, 0], np.ones(1), 0.0)
        >>> [round(float(np.squeeze(part)), 2) for part in edge.look_up(np.array([0.25]))]
        [-0.62, 1.38, 0.88, 0.38]
        >>> edge.look_up(np.array([0.25]), 2).high, edge.look_up(np.array([3.0])).high
        (array([1.]), array([4.]))
        """
        count = count or len(parameters) + TUNED.neighbours
        (rows,), distances = nearest_samples(parameters[None], self.sources, self.scale, count)
        (weights,) = neighbour_weights(distances)
        return TargetBox(*(weights @ part[rows] for part in (self.low, self.high, self.leave, self.enter)))


def shrink_box(
    good: Array, bad: Array, scale: Array, eps: float = TUNED.distance_from_bad
) -> tuple[Array, Array]:
    """Compute the bounding box of good targets, shrunk until no bad target is inside [HG07, 3.2].

    For each bad target inside, the side with the smallest loss is shifted inwards.

    Parameters
    ----------
    good, bad : parameters (A, d) and (B, d) of good and bad targets, with A at least 1.
    scale : shape (d,), the units of the loss of a side.
    eps : distance of a box from a bad target, as a fraction of the scale.

    Returns
    -------
    The low and the high corner, (d,) each. In an empty box, a low side is above its high side.

    Examples
    --------
    >>> good, bad = np.array([[0.0, 0], [10, 10]]), np.array([[9.0, 2]])
    >>> shrink_box(good, bad, np.array([5.0, 5]), eps=0.01)
    (array([0., 0.]), array([ 8.95, 10.  ]))

    With a larger unit of the second parameter, a loss of 2 along it is smaller than a loss of 1 along the
    first:

    >>> shrink_box(good, bad, np.array([5.0, 20]), eps=0.1)
    (array([0., 4.]), array([10., 10.]))

    Notebook: 17-parametric-graphs
    """
    low = good.min(axis=0).astype(float)
    high = good.max(axis=0).astype(float)
    for sample in bad:
        if ((sample > low - eps * scale) & (sample < high + eps * scale)).all():
            losses = np.concatenate([sample - low, high - sample]) / np.tile(scale, 2)
            side = int(losses.argmin())
            number = side % len(low)
            if side < len(low):
                low[number] = sample[number] + eps * scale[number]
            else:
                high[number] = sample[number] - eps * scale[number]
    return low, high


def build_edge(
    source: Space,
    target: Space,
    *,
    good: float,
    bad: float | None = None,
    sampling: tuple[int, int] = TUNED.sampling,
) -> ParametricEdge:
    """Compute the boxes of targets and the phases of transitions of sampled sources [HG07, 3.2; no edge; 4].

    Parameters
    ----------
    source, target : spaces, which may be the same one.
    good : T_GOOD, metres. The box bounds the targets with at most this cost, or all targets with ∞.
    bad : T_BAD, metres, by default 1.35 T_GOOD. Targets with a higher cost are outside the box. Targets with
        a cost between the two may be inside.
    sampling : number of sources to spread and of targets to draw, by default 50 and 1000 as in the paper.

    Raises
    ------
    MocapError : for a T_BAD below T_GOOD, and spaces of different skeletons, rates or contacts.
    NoWalk : if a source has no good target. In [HG07] there is no edge then.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_circle"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> edge = build_edge(space, space, good=0.02, sampling=(50, 200))
    >>> for turn in (-0.5, 0.0, 0.5):  # the box of targets, and the phases to leave and to enter
    ...     print([round(float(np.squeeze(part)), 2) for part in edge.look_up(np.array([turn]))])
    [-0.8, -0.06, 0.94, -0.06]
    [-0.44, 0.46, 0.92, -0.07]
    [0.11, 0.8, 0.92, -0.06]
    >>> len(edge.sources), round(edge.smallest_good, 3)
    (50, 0.01)

    Notebook: 17-parametric-graphs
    """
    bad = TUNED.bad * good if bad is None else bad
    if not good <= bad:
        raise MocapError(f"Thresholds are T_GOOD <= T_BAD, got {good} and {bad} m.")
    source.examples.require_joinable(target.examples)
    sources = spread_parameters(source, sampling[0])
    targets = draw_parameters(target, sampling[1], np.random.default_rng(0))
    costs, leave, enter = optimal_transitions(source, target, sources, targets)
    lowest = costs.min(axis=1)
    worst = int(lowest.argmax())
    if lowest[worst] > good:
        raise _no_edge(source, sources[worst], good, float(lowest[worst]))
    boxes = []
    for row, cost in enumerate(costs):
        is_good = cost <= good
        low, high = shrink_box(targets[is_good], targets[cost > bad], target.scale)
        inside = is_good & ((targets >= low) & (targets <= high)).all(axis=1)
        if not inside.any():  # good targets surrounded by bad ones: only the best target is used
            best = int(cost.argmin())
            low = high = targets[best]
            inside = np.arange(len(targets)) == best
        boxes.append((low, high, leave[row, inside].mean(), enter[row, inside].mean()))
    low, high, leave, enter = (np.array(part) for part in zip(*boxes, strict=True))
    return ParametricEdge(sources, low, high, leave, enter, source.scale, float(lowest[worst]))


def _no_edge(source: Space, parameters: Array, good: float, cost: float) -> NoWalk:
    """Return the error for a source whose best target has a cost above T_GOOD."""
    named = zip(source.parameters, parameters, strict=True)
    values = ", ".join(f"{name} {parameter_text(name, value)}" for name, value in named)
    below = f"{100 * good:.1f} cm (the best costs {100 * cost:.1f} cm)"
    remedy = f"raise T_GOOD to {np.ceil(1000 * cost) / 10:.1f} cm, or ask for less"
    return NoWalk(f"Nothing follows {values} below {below}: {remedy}.")


def build_parametric(
    spaces: Mapping[str, Space],
    edges: Sequence[tuple[str, str]] | None = None,
    *,
    good: float,
    sampling: tuple[int, int] = TUNED.sampling,
) -> nx.DiGraph:
    """Build a parametric motion graph from named spaces and pairs of consecutive spaces [HG07, graph].

    Parameters
    ----------
    spaces : spaces of one skeleton and rate, by name.
    edges : pairs of names. By default all pairs for which an edge exists, because all sources have a good
        target.
    good, sampling : as for `build_edge`.

    Returns
    -------
    A `networkx.DiGraph` of the names, with the attribute `space` of a node and the attribute `edge`, a
    `ParametricEdge`, of an edge.

    Raises
    ------
    NoWalk : for a given edge that does not exist, with a remedy, and a node without successors.
    MocapError : as for `build_edge`, and for unknown names.

    Examples
    --------
    A stride of the left foot follows itself:

    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_curve_2"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> graph = build_parametric({"walk": space}, good=0.05)
    >>> list(graph.edges)
    [('walk', 'walk')]

    Notebook: 17-parametric-graphs
    """
    pairs = [(source, target) for source in spaces for target in spaces] if edges is None else list(edges)
    unknown = [name for pair in pairs for name in pair if name not in spaces]
    if unknown:
        raise MocapError(f"There is no space '{unknown[0]}'; there are: {', '.join(spaces)}.")
    for space in spaces.values():  # before the first edge, which takes seconds
        next(iter(spaces.values())).examples.require_joinable(space.examples)
    graph = nx.DiGraph()
    graph.add_nodes_from((name, {"space": space}) for name, space in spaces.items())
    for source, target in pairs:
        try:
            edge = build_edge(spaces[source], spaces[target], good=good, sampling=sampling)
            graph.add_edge(source, target, edge=edge)
        except NoWalk as error:
            if edges is not None:
                raise NoWalk(f"{source} → {target}: {error}") from error
    ends = [name for name in spaces if not graph.out_degree(name)]
    if ends:
        raise NoWalk(f"Nothing follows '{ends[0]}' below {100 * good:.1f} cm: raise T_GOOD, or add spaces.")
    return graph
