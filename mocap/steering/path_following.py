"""Find a walk along a path on the ground: in layers, and by the paper's branch and bound [KGP02, 5.1]."""

import itertools
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from operator import attrgetter

import numpy as np

from mocap._shared.arrays import Indices, VectorsLike
from mocap._shared.deadlines import OUT_OF_TIME, Deadline
from mocap.body.ground_path import GroundPath, as_path
from mocap.body.planar import on_ground
from mocap.errors import MocapError, NoWalk, warn
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph, walk_track
from mocap.graphs.components import reached
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.bent_following import plan_bending
from mocap.steering.followed import Followed, measure_walk
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import Route, Settings, Wishes, make_route
from mocap.steering.path_search import Found, find_walk, too_slow
from mocap.steering.tuned import TUNED
from mocap.synthesis.bounded_search import Problem, SearchEdge, search_ahead
from mocap.synthesis.ground_walks import GroundWalks, Stand


def follow_path(
    graph: MotionGraph | CompiledGraph,
    path: GroundPath | VectorsLike,
    wishes: Wishes | None = None,
    *,
    settings: Settings | None = None,
    bend: float = 0.0,
) -> Followed:
    """Find a walk whose root, seen from above, follows a path [KGP02, 5.1].

    The search is a `LayeredSearch`; its time is linear in the path's length. No single price of a seam suits
    all paths. So where seams are too frequent, or the walk is too far off (`Followed.excess` above 1), the
    search is repeated with a wider beam, and with the price of a seam times or divided by 1.25. The best walk
    is taken. Where it still leaves the path, a search keeps 400 walks, at a third of the price of seams, and
    where that leaves it, too, a last one where they are free. Where no clip turns as the path does, the walk
    cuts the corner; a warning says where.

    Seams cost, so a walk can be nearer: the paper's own search, `follow_as_2002`, takes two to three times as
    many, and is nearer to 23 of the 40 lines of `figures/BENCHMARK.md`, mostly by a centimetre. With
    `Settings(seam=0, match=0, width=200, tries=1)`, where seams are free here, too, it is nearer to 4 of the
    20 of `figures/following.md`. Where a walk leaves its path, the warning says that it may come nearer.

    With `bend`, any walk follows any path: the search prices by how much a walk must be turned beyond what
    its clips turn, instead of its distance from the path. Then it is laid on the path [Gle01], and its feet
    are cleaned up. Where the path turns too fast, it is rounded; `report` says where and by how much.

    Parameters
    ----------
    graph : pruned, so that walks do not end; compile it yourself to follow many paths.
    path : where to walk, or its points (x, z), metres.
    wishes : labels, times and the start.
    settings : how thoroughly to search, and what deviations cost.
    bend : the fastest that a walk is turned beyond its own turning, radians per second: `editing.LIMIT`, 100°
        per second, as people turn. 0 leaves walks as they are.

    Returns
    -------
    The walk, and how well it follows the path; with `bend` also how it was laid on the path, `bent`.

    Raises
    ------
    NoWalk : for a label that no walk can reach, a start that is not in the graph, a dead end, and clips of
        which no walk goes on at 0.3 m/s; without `bend` where the walk is a metre off on average; with
        `Settings(tries=1)` it is given all the same. For a deadline before the first step of the search.
    MocapError : for a path that takes these clips more than an hour, and wishes that make no sense.

    Warns
    -----
    MocapWarning : where the walk is more than 15 cm off the path, and with `bend` for plants that are let go.
        Where `Settings.deadline` ended the search, with how much of the path the walk covers.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> followed = follow_path(graph, body.GroundPath([[0, 0], [0, 6]]))
    >>> followed.progress, bool(followed.off.mean() < 0.05)
    (1.0, True)
    >>> bent = follow_path(graph, body.circle(1.2), bend=1.0)  # radians per second
    >>> bent.progress > 0.97, bool(bent.off.max() < 0.08)
    (True, True)

    Notebook: 08-path-synthesis
    """
    compiled = compile_graph(graph)
    path = as_path(path)
    wishes = wishes or Wishes()
    settings = settings or Settings()
    deadline = Deadline(settings.deadline)
    if settings.tries < 1:
        raise MocapError(f"A path takes at least one search, got tries={settings.tries}.")
    measure: Callable[[Found], Followed]
    if bend:
        route, measure = plan_bending(compiled, path, wishes, bend)
    else:
        route = make_route(compiled, path, wishes)
        measure = partial(measure_walk, compiled, path, route)
    starts = start_of(compiled, route, wishes)
    _require_labels(compiled, [label for _, label in sorted(wishes.labels)], starts.node)

    said: dict[int, list[str]] = {}  # by each walk; only what the best one says is told

    def search(settings: Settings) -> Followed:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            walk = measure(find_walk(compiled, route, starts, settings, deadline))
        said[id(walk)] = [str(warned.message) for warned in caught]
        return walk

    followed, is_ended = _best_of(search, replace(settings, width=settings.width_on(route)), deadline)
    for sentence in said[id(followed)]:
        warn(sentence)
    if is_ended and deadline.is_over:
        _tell_deadline(followed, settings.deadline)
    if not wishes.others:  # with others it goes aside to give way
        if settings.tries > 1 and not bend and not is_ended:
            _require_near(compiled, followed)
        _tell_departures(followed, bend)
    return followed


def _tell_deadline(followed: Followed, seconds: float) -> None:
    """Warn of a search that a deadline ended, with how much of the path the walk covers."""
    length = f"{followed.path.length:.1f} m"
    if followed.progress < 1:
        percent = min(99, round(100 * followed.progress))
        covered = f"{percent} % of the path, {followed.along[-1]:.1f} of {length}"
    else:
        covered = f"all of the path, {length}, but a longer search may find a better one"
    warn(f"The deadline of {seconds:g} s ended the search: the walk covers {covered}.")


def _require_near(graph: CompiledGraph, followed: Followed) -> None:
    """Raise `NoWalk` for a walk that does not follow the path at all."""
    if followed.off.mean() > TUNED.not_followed and not followed.found.stopped:
        distance = f"The nearest walk is {followed.off.mean():.1f} m off the line on average"
        speed = np.abs(np.diff(on_ground(followed.track))).sum() / followed.seconds
        if speed < TUNED.slowest:
            raise too_slow(graph, f"{distance}, and goes at {speed:.2f} m/s")
        raise NoWalk(f"{distance}: no clips turn as it does; try `bend`, or add clips that turn.")


def _tell_departures(followed: Followed, bend: float) -> None:
    """Warn of a walk that leaves the path."""
    if departures := followed.departures:
        start, end, worst = max(departures, key=lambda stretch: stretch[2])
        often = "once" if len(departures) == 1 else f"{len(departures)} times"
        cause = "the clips sway so far" if bend else "no clips turn as it does there"
        rounded = followed.bent and followed.bent.rounded[followed.off.argmax()]
        cause = "it turns too fast there" if rounded else cause
        cause += "" if bend else "; `bend` turns them, and `follow_as_2002` may come nearer"
        furthest = f"the furthest by {100 * worst:.0f} cm at {start:.1f} to {end:.1f} m"
        warn(f"The walk leaves the path {often}, {furthest}: {cause}.")


def _best_of(
    search: Callable[[Settings], Followed], settings: Settings, deadline: Deadline
) -> tuple[Followed, bool]:
    """Search, and search again with other settings while that may help.

    Returns
    -------
    The best walk, and whether the deadline or Ctrl-C ended the search.
    """
    best = search(settings)
    last = best
    for count in itertools.count(1):
        next_settings = _next_settings(best, settings, count)
        if next_settings is None:
            break
        if last.found.stopped or deadline.is_over:
            return best, True
        with _ending(deadline):
            last = search(next_settings)
        measure = attrgetter("excess" if count < settings.tries else "far")
        best = min(best, last, key=lambda walk: (walk.progress < 1, measure(walk)))
    return best, bool(last.found.stopped)


@contextmanager
def _ending(deadline: Deadline) -> Iterator[None]:
    """Suppress NoWalk if the deadline is over: a search may end before its first step."""
    try:
        yield
    except NoWalk:
        if not deadline.is_over:
            raise


def _next_settings(best: Followed, settings: Settings, count: int) -> Settings | None:
    """Return the settings of the next search after so many; None where the best walk needs no other.

    While `excess` is above 1, the beam grows, and the price of a seam changes. Where the best walk still
    leaves the path, far more walks are kept, of cheap seams and then of free ones.
    """
    if count < settings.tries:
        if best.excess <= 1:
            return None
        factor = TUNED.seam_price_step if best.restless > 1 else 1 / TUNED.seam_price_step
        width = settings.width or TUNED.wide_beam
        return replace(settings, seam=factor * settings.seam, width=round((1 + count / 2) * width))
    cheap = count - settings.tries
    leaves = best.far and best.off.max() > TUNED.leaves_path
    if settings.tries == 1 or cheap >= len(TUNED.cheap_seams) or not leaves:
        return None
    share = TUNED.cheap_seams[cheap]
    return replace(settings, seam=share * settings.seam, match=share * settings.match, width=TUNED.wide_beam)


def start_of(graph: CompiledGraph, route: Route, wishes: Wishes) -> States:
    """Start at the first point of the route, at every node or the one asked for, in the route's direction."""
    nodes = np.arange(len(graph.nodes)) if wishes.start is None else np.array([graph.index(wishes.start)])
    first = route.points[: int(0.3 / route.spacing) + 2]
    rotation = np.exp(1j * (np.angle(first[-1] - first[0]) - graph.going[nodes]))
    return start_states(nodes, rotation, first[0] - rotation * graph.at[nodes])


def _require_labels(graph: CompiledGraph, labels: Sequence[str], starts: Indices) -> None:
    """Raise `NoWalk` unless a walk can reach the labels one after the other."""
    source = graph.source.graph
    nodes = {graph.nodes[start] for start in starts}
    for label in filter(None, labels):
        edges = list(source.out_edges(reached(source, nodes), data=True))
        nodes = {end for _, end, edge in edges if label in edge["labels"]}
        if not nodes:
            can = ", ".join(sorted({name for _, _, edge in edges for name in edge["labels"]})) or "none"
            raise NoWalk(f"No walk comes to the label '{label}' from there; it can reach: {can}.")


def cost_along(walks: GroundWalks, route: Route, stand: Stand, edge: SearchEdge) -> tuple[float, Stand]:
    """Give g(w, e) = Σ_i ‖P'(s(e_i)) - P(s(e_i))‖² [KGP02, Eq. 9] after a walk, and where it leads."""
    rows, points, end = walks.step(stand, edge)
    along = stand.along + np.cumsum(walks.graph.progress[rows])
    distances = np.abs(points - route.at(along))
    return float((distances**2).sum()), end._replace(along=float(along[-1]))


def path_problem(walks: GroundWalks, route: Route) -> Problem:
    """Make the paper's search problem: edges cost `cost_along`; a walk ends with the path."""
    step = partial(cost_along, walks, route)
    return Problem(walks.graph.source.graph, step, lambda stand: stand.along >= route.length)


def follow_as_2002(  # noqa: PLR0913 (a path, wishes, and three limits)
    graph: MotionGraph | CompiledGraph,
    path: GroundPath | VectorsLike,
    wishes: Wishes,
    *,
    look: tuple[int, int] = (90, 28),
    budget: float = np.inf,
    deadline: float = np.inf,
) -> Followed:
    """Follow a path by the paper's branch and bound, to compare with `follow_path` [KGP02, Eq. 9].

    Parameters
    ----------
    graph, path : as for `steering.follow_path`.
    wishes : give a `start`, else the walk starts at the first node; labels and times are ignored.
    look : n and m, the frames to look ahead and the frames to keep; as for `synthesis.search_ahead`.
    budget : of each stretch of the search.
    deadline : seconds of wall time for the whole search; then it is the walk so far.

    Returns
    -------
    The walk, and how well it follows the path.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, and where the budget ends before the first step.

    Warns
    -----
    MocapWarning : where the deadline ended the search, with how much of the path the walk covers.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> path, wishes = body.GroundPath([[0, 0], [0, 1]]), Wishes(start=(0, 10))
    >>> followed = follow_as_2002(graph, path, wishes, budget=100)
    >>> followed.progress, followed.found.stopped
    (1.0, 'out of nodes')

    Notebook: 08c-judging-a-search
    """
    compiled = compile_graph(graph)
    path = as_path(path)
    route = make_route(compiled, path, wishes)
    start = start_of(compiled, route, wishes)
    stand = Stand(complex(start.rotation[0]), complex(start.translation[0]))
    walks = GroundWalks(compiled)
    node = compiled.nodes[int(start.node[0])]
    limits = {"budget": budget, "deadline": deadline}
    result = search_ahead(path_problem(walks, route), node, stand, look=look, **limits)
    if not result.walk:
        raise NoWalk(f"The search was {result.stopped} before its first step.")
    edges = np.array([walks.number[edge] for edge in result.walk])
    along = np.cumsum(compiled.progress[walk_track(compiled, edges, stand.rotation, stand.translation)[1]])
    counts = result.expanded, result.cut, result.stopped
    walk = Found(edges, stand.rotation, stand.translation, along, result.cost, *counts)
    followed = measure_walk(compiled, path, route, walk)
    if result.stopped == OUT_OF_TIME:
        _tell_deadline(followed, deadline)
    return followed
