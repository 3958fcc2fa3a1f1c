"""Parametric motion graphs: nodes are spaces of motions, edges say which targets may follow [HG07]."""

from collections.abc import Mapping, Sequence

import networkx as nx
import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple, dataclass
from mocap.errors import MocapError, NoWalk
from mocap.methods.match_webs.target_weights import nearest_samples, neighbour_weights
from mocap.methods.parametric_graphs.made_motions import optimal_transitions
from mocap.methods.parametric_graphs.stride_spaces import Space, draw_parameters, place_evenly, said

NEIGHBOURS = 4  # more than the parameters: with one more, as in [HG07, 4], boxes jump
BAD = 1.35  # T_BAD over T_GOOD: with 2 no bad target cuts a box
SAMPLING = (50, 1000)  # sources and targets of an edge
EPSILON = 0.005  # of half a range, by which a box keeps off bad targets


class Way(NamedTuple):
    """What may follow a source: a box of targets, (d,) each, and the phases to leave and to enter.

    Examples
    --------
    >>> Way(np.array([-0.1]), np.array([0.4]), 1.0, 0.0).high
    array([0.4])
    """

    low: Array
    high: Array
    leave: float
    enter: float


@dataclass(frozen=True, eq=False)
class ParametricEdge:
    """For S sampled sources what may follow; `build_edge` shows an example.

    Parameters
    ----------
    at : shape (S, d), the sources' parameters, in units of `scale` (d,).
    low, high : shape (S, d'), the box of each.
    leave, enter : shape (S,), phases near 1 and near 0.
    least : metres, the smallest T_GOOD at which every source has a target.
    """

    at: Array
    low: Array
    high: Array
    leave: Array
    enter: Array
    scale: Array
    least: float

    def look_up(self, asked: Array, count: int | None = None) -> Way:
        """Weigh the boxes of the sources nearest to some parameters (d,) [HG07, Eqs. 1-3].

        The farthest of k sources always weighs 0. So with k = d + 1, as [HG07, 4] says, one parameter gives
        the nearest source and nothing else, and boxes jump; k is d + 4 by default [ours].

        Examples
        --------
        >>> at = np.arange(7.0)[:, None]
        >>> edge = ParametricEdge(at, at - 1, at + 1, at[:, 0] + 0.5, at[:, 0], np.ones(1), 0.0)
        >>> [round(float(np.squeeze(part)), 2) for part in edge.look_up(np.array([0.25]))]
        [-0.62, 1.38, 0.88, 0.38]
        >>> edge.look_up(np.array([0.25]), 2).high, edge.look_up(np.array([3.0])).high
        (array([1.]), array([4.]))
        """
        (rows,), gaps = nearest_samples(asked[None], self.at, self.scale, count or len(asked) + NEIGHBOURS)
        (shares,) = neighbour_weights(gaps)
        return Way(*(shares @ part[rows] for part in (self.low, self.high, self.leave, self.enter)))


def shrink_box(good: Array, bad: Array, scale: Array, eps: float = EPSILON) -> tuple[Array, Array]:
    """Bound the good targets; for each bad one inside move the side in that loses least [HG07, 3.2].

    Parameters
    ----------
    good, bad : parameters (A, d) and (B, d); at least one good one.
    scale : shape (d,): what a side loses is measured in these units.
    eps : of the scale, by which a box stays off a bad target.

    Returns
    -------
    The low and the high corner, (d,) each. The box may be empty: a low side above its high side.

    Examples
    --------
    >>> good, bad = np.array([[0.0, 0], [10, 10]]), np.array([[9.0, 2]])
    >>> shrink_box(good, bad, np.array([5.0, 5]), eps=0.01)
    (array([0., 0.]), array([ 8.95, 10.  ]))

    Where much of the second counts as far as little of the first, 2 from its end is nearer than 1:

    >>> shrink_box(good, bad, np.array([5.0, 20]), eps=0.1)
    (array([0., 4.]), array([10., 10.]))

    A box keeps 0.1 · 5 off a bad target, and 0.1 · 20:

    >>> bad = np.array([[10.5, 5], [-0.5, 5], [5, 12], [5, -2]])
    >>> [part.tolist() for part in shrink_box(good, bad, np.array([5.0, 20]), eps=0.1)]
    [[0.0, 0.0], [10.0, 10.0]]
    >>> bad = np.array([[10.25, 5], [-0.25, 5], [5, 11], [5, -1]])
    >>> [part.tolist() for part in shrink_box(good, bad, np.array([5.0, 20]), eps=0.1)]
    [[0.25, 1.0], [9.75, 9.0]]

    Notebook: 17-parametric-graphs
    """
    low, high = good.min(axis=0).astype(float), good.max(axis=0).astype(float)
    for sample in bad:
        if ((sample > low - eps * scale) & (sample < high + eps * scale)).all():
            side = int((np.concatenate([sample - low, high - sample]) / np.tile(scale, 2)).argmin())
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
    sampling: tuple[int, int] = SAMPLING,
) -> ParametricEdge:
    """Say for each source which box may follow, and when to leave and enter [HG07, 3.2; no edge; 4].

    Parameters
    ----------
    source, target : spaces; one may follow itself.
    good : T_GOOD, metres: targets at most this far bound the box; with ∞ all do.
    bad : T_BAD, metres: targets farther than this are kept out of it; 1.35 T_GOOD by default. Those between
        may be in it.
    sampling : how many sources to place, and targets to draw; 50 and 1000 as in the paper.

    Raises
    ------
    MocapError : for a T_BAD below T_GOOD, and spaces of different skeletons, rates or marks.
    NoWalk : where some source has no good target: [HG07] has no edge then.

    Examples
    --------
    >>> from mocap import body, datasets
    >>> from mocap.methods.parametric_graphs.stride_spaces import make_space
    >>> from mocap.methods.parametric_graphs.strides import cut_strides
    >>> strides = cut_strides([body.resample(datasets.sample("walk_circle"), 30)])
    >>> space = make_space(strides, 0.4, -0.8, 0.8)
    >>> edge = build_edge(space, space, good=0.02, sampling=(50, 200))
    >>> for turn in (-0.5, 0.0, 0.5):  # the box of what may follow, and when to leave and to enter
    ...     print([round(float(np.squeeze(part)), 2) for part in edge.look_up(np.array([turn]))])
    [-0.8, -0.06, 0.94, -0.06]
    [-0.44, 0.46, 0.92, -0.07]
    [0.11, 0.8, 0.92, -0.06]
    >>> len(edge.at), round(edge.least, 3)
    (50, 0.01)

    Notebook: 17-parametric-graphs
    """
    bad = BAD * good if bad is None else bad
    if not good <= bad:
        raise MocapError(f"Thresholds are T_GOOD <= T_BAD, got {good} and {bad} m.")
    source.examples.require_joinable(target.examples)
    at = place_evenly(source, sampling[0])
    to = draw_parameters(target, sampling[1], np.random.default_rng(0))
    costs, leave, enter = optimal_transitions(source, target, at, to)
    least = costs.min(axis=1)
    if (worst := float(least.max())) > good:
        named = zip(source.parameters, at[least.argmax()], strict=True)
        what = ", ".join(f"{name} {said(name, value)}" for name, value in named)
        below = f"{100 * good:.1f} cm (the best costs {100 * worst:.1f} cm)"
        more = f"raise T_GOOD to {np.ceil(1000 * worst) / 10:.1f} cm, or ask for less"
        raise NoWalk(f"Nothing follows {what} below {below}: {more}.")
    rows = []
    for row, cost in enumerate(costs):
        fine = cost <= good
        low, high = shrink_box(to[fine], to[cost > bad], target.scale)
        inside = fine & ((to >= low) & (to <= high)).all(axis=1)
        if not inside.any():  # bad ones all around: only the best
            best = int(cost.argmin())
            low, high, inside = to[best], to[best], np.arange(len(to)) == best
        rows.append((low, high, leave[row, inside].mean(), enter[row, inside].mean()))
    low, high, leave, enter = (np.array(part) for part in zip(*rows, strict=True))
    return ParametricEdge(at, low, high, leave, enter, source.scale, worst)


def build_parametric(
    spaces: Mapping[str, Space],
    edges: Sequence[tuple[str, str]] | None = None,
    *,
    good: float,
    sampling: tuple[int, int] = SAMPLING,
) -> nx.DiGraph:
    """Build a parametric motion graph [HG07, graph]: an author names the spaces, and which may follow which.

    Parameters
    ----------
    spaces : by name, of one skeleton and rate.
    edges : pairs of names. By default all pairs that can be had: where some source has no good target, there
        is no edge.
    good, sampling : as for `build_edge`.

    Returns
    -------
    A `networkx.DiGraph` of the names: each node has its `space`, each edge its `ParametricEdge` as `edge`.

    Raises
    ------
    NoWalk : for a named edge that cannot be had, with what would help, and a node that nothing leaves.
    MocapError : as `build_edge`, and for unknown names.

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
    asked = [(a, b) for a in spaces for b in spaces] if edges is None else list(edges)
    if unknown := [name for pair in asked for name in pair if name not in spaces]:
        raise MocapError(f"There is no space '{unknown[0]}'; there are: {', '.join(spaces)}.")
    for space in spaces.values():  # before any edge takes its seconds
        next(iter(spaces.values())).examples.require_joinable(space.examples)
    graph = nx.DiGraph()
    graph.add_nodes_from((name, {"space": space}) for name, space in spaces.items())
    for name, other in asked:
        try:
            edge = build_edge(spaces[name], spaces[other], good=good, sampling=sampling)
            graph.add_edge(name, other, edge=edge)
        except NoWalk as error:
            if edges is not None:
                raise NoWalk(f"{name} → {other}: {error}") from error
    if stuck := [name for name in spaces if not graph.out_degree(name)]:
        raise NoWalk(f"Nothing follows '{stuck[0]}' below {100 * good:.1f} cm: raise T_GOOD, or add spaces.")
    return graph
