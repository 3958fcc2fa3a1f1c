"""Search for a walk along a path on the ground: by layers, and by branch and bound [KGP02, 5.1]."""

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
from mocap.errors import MocapError, NoWalk, Remedy, warn
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph, walk_track
from mocap.graphs.components import reached
from mocap.graphs.motion_graph import MotionGraph
from mocap.steering.bent_following import plan_bending
from mocap.steering.followed import Followed, measure_walk
from mocap.steering.layered_search import States, start_states
from mocap.steering.path_objective import PathRequest, Route, Settings, make_route
from mocap.steering.path_search import Found, find_walk, too_slow
from mocap.steering.tuned import TUNED
from mocap.synthesis.bounded_search import Problem, SearchEdge, search_ahead
from mocap.synthesis.ground_walks import GroundWalks, Stand


def follow_path(
    graph: MotionGraph | CompiledGraph,
    path: GroundPath | VectorsLike,
    request: PathRequest | None = None,
    *,
    settings: Settings | None = None,
    bend: float = 0.0,
) -> Followed:
    """Find a walk through a motion graph whose root follows a path on the ground [KGP02, 5.1].

    The search is a `LayeredSearch`, whose time is linear in the path's length. No single price of a seam
    suits all paths. If seams are too frequent, or the walk is too far off (`Followed.excess` above 1), the
    search is repeated with a wider beam, and with the price of a seam multiplied or divided by 1.25. The best
    walk is returned. If it still leaves the path, two more searches have a beam width of 400: one with a
    third of the price of a seam, and, if necessary, one with free seams. If no clip turns as the path does,
    the walk cuts the corner, and a warning reports the position.

    Because seams have a price, other walks can be nearer to the path. The search of the paper,
    `follow_as_2002`, uses two to three times as many seams, and is nearer to 8 of the 15 lines of
    `figures/BENCHMARK.md`, mostly by a centimetre. If seams are also free here, with `Settings(seam=0,
    match=0, width=200, tries=1)`, it is nearer to 4 of them, two with clips that never turn. The warning
    about a walk that leaves its path mentions that search.

    With `bend`, any walk can follow any path. The search prices the rotation of a walk beyond that of its
    clips instead of its distance from the path. Then the walk is bent onto the path by path editing [Gle01],
    and foot sliding is removed. If the path turns too fast, it is rounded. `report` shows the position and
    the amount of the rounding.

    Parameters
    ----------
    graph : pruned, so that walks do not end. To follow many paths, pass a graph that is compiled already.
    path : the path, or its points (x, z), metres.
    request : labels, times and the start.
    settings : the effort of the search, and the prices of deviations.
    bend : the highest angular speed that bending adds to a walk, radians per second, for example
        `editing.LIMIT`, 100° per second, which people reach. 0 does not bend.

    Returns
    -------
    The walk and its distances from the path. With `bend`, its field `bent` describes the bending.

    Raises
    ------
    NoWalk : for a label that no walk can reach, a start that is not in the graph, a dead end, clips from
        which no walk keeps a speed of 0.3 m/s, and a deadline before the first step of the search. Also for a
        walk that is more than a metre off the path on average, except with `bend` or `Settings(tries=1)`.
    MocapError : for a path that would take more than an hour with these clips, and invalid requests.

    Warns
    -----
    MocapWarning : if the walk is more than 15 cm off the path, if bending released foot contacts, and if
        `Settings.deadline` ended the search, with the part of the path that the walk covers.

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
    request = request or PathRequest()
    settings = settings or Settings()
    deadline = Deadline(settings.deadline)
    if settings.tries < 1:
        raise MocapError(f"A path takes at least one search, got tries={settings.tries}.")
    measure: Callable[[Found], Followed]
    if bend:
        route, measure = plan_bending(compiled, path, request, bend)
    else:
        route = make_route(compiled, path, request)
        measure = partial(measure_walk, compiled, path, route)
    starts = start_of(compiled, route, request)
    _require_labels(compiled, [label for _, label in sorted(request.labels)], starts.node)

    messages: dict[int, list[str]] = {}  # warnings, by the id of a walk: only those of the best are issued

    def search(settings: Settings) -> Followed:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            walk = measure(find_walk(compiled, route, starts, settings, deadline))
        messages[id(walk)] = [str(warned.message) for warned in caught]
        return walk

    followed, is_ended = _best_of(search, replace(settings, width=settings.width_on(route)), deadline)
    for message in messages[id(followed)]:
        warn(message)
    if is_ended and deadline.is_over:
        _warn_of_deadline(followed, settings.deadline)
    if not request.others:  # a walk that gives way to others may leave the path
        if settings.tries > 1 and not bend and not is_ended:
            _require_near(compiled, followed)
        _warn_of_departures(followed, bend)
    return followed


def _warn_of_deadline(followed: Followed, seconds: float) -> None:
    """Warn that a deadline ended the search, with the part of the path that the walk covers."""
    length = f"{followed.path.length:.1f} m"
    if followed.progress < 1:
        percent = min(99, round(100 * followed.progress))
        covered = f"{percent} % of the path, {followed.along[-1]:.1f} of {length}"
    else:
        covered = f"all of the path, {length}, but a longer search may find a better one"
    warn(f"The deadline of {seconds:g} s ended the search: the walk covers {covered}.")


def _require_near(graph: CompiledGraph, followed: Followed) -> None:
    """Raise `NoWalk` for a walk that is more than a metre off the path on average."""
    if followed.off.mean() > TUNED.not_followed and not followed.found.stopped:
        distance = f"The nearest walk is {followed.off.mean():.1f} m off the line on average"
        speed = np.abs(np.diff(on_ground(followed.track))).sum() / followed.seconds
        if speed < TUNED.slowest:
            raise too_slow(graph, f"{distance}, and goes at {speed:.2f} m/s")
        remedy = Remedy("add clips that turn, or try {}", "bend")
        raise NoWalk(f"{distance}; no clips turn as it does.", remedy=remedy)


def _warn_of_departures(followed: Followed, bend: float) -> None:
    """Warn about a walk that leaves the path, with the worst place and a likely cause."""
    if departures := followed.departures:
        start, end, worst = max(departures, key=lambda stretch: stretch[2])
        often = "once" if len(departures) == 1 else f"{len(departures)} times"
        cause = "the clips sway so far" if bend else "no clips turn as it does there"
        rounded = followed.bent and followed.bent.rounded[followed.off.argmax()]
        cause = "it turns too fast there" if rounded else cause
        cause += "" if bend else "; add clips that turn, or bend the walk onto the path"
        furthest = f"the furthest by {100 * worst:.0f} cm at {start:.1f} to {end:.1f} m"
        warn(f"The walk leaves the path {often}, {furthest}: {cause}.")


def _best_of(
    search: Callable[[Settings], Followed], settings: Settings, deadline: Deadline
) -> tuple[Followed, bool]:
    """Search repeatedly, with changed settings, until the walk is good or no settings remain.

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
    """Suppress `NoWalk` after the deadline, because a search may end before its first step."""
    try:
        yield
    except NoWalk:
        if not deadline.is_over:
            raise


def _next_settings(best: Followed, settings: Settings, count: int) -> Settings | None:
    """Return the settings of the next search after `count` searches, or None if there is no next one.

    While `excess` is above 1, the beam is widened, and the price of a seam changes. If the best walk still
    leaves the path, the beam is much wider, and seams have a low price, and finally none.
    """
    if count < settings.tries:
        if best.excess <= 1:
            return None
        factor = TUNED.seam_price_step if best.restless > 1 else 1 / TUNED.seam_price_step
        width = settings.width or TUNED.wide_beam
        return replace(settings, seam=factor * settings.seam, width=round((1 + count / 2) * width))
    extra = count - settings.tries
    leaves = best.far and best.off.max() > TUNED.leaves_path
    if settings.tries == 1 or extra >= len(TUNED.lower_seam_prices) or not leaves:
        return None
    factor = TUNED.lower_seam_prices[extra]
    cheaper = replace(settings, seam=factor * settings.seam, match=factor * settings.match)
    return replace(cheaper, width=TUNED.wide_beam)


def start_of(graph: CompiledGraph, route: Route, request: PathRequest) -> States:
    """Return the states at the start of a route, heading along it, at the requested node or at all nodes."""
    nodes = np.arange(len(graph.nodes)) if request.start is None else np.array([graph.index(request.start)])
    first = route.points[: int(0.3 / route.spacing) + 2]
    rotation = np.exp(1j * (np.angle(first[-1] - first[0]) - graph.going[nodes]))
    return start_states(nodes, rotation, first[0] - rotation * graph.at[nodes])


def _require_labels(graph: CompiledGraph, labels: Sequence[str], starts: Indices) -> None:
    """Raise `NoWalk` unless a walk can reach the labels in their order."""
    source = graph.source.graph
    nodes = {graph.nodes[start] for start in starts}
    for label in filter(None, labels):
        edges = list(source.out_edges(reached(source, nodes), data=True))
        nodes = {end for _, end, edge in edges if label in edge["labels"]}
        if not nodes:
            can = ", ".join(sorted({name for _, _, edge in edges for name in edge["labels"]})) or "none"
            raise NoWalk(f"No walk comes to the label '{label}' from there; it can reach: {can}.")


def cost_along(walks: GroundWalks, route: Route, stand: Stand, edge: SearchEdge) -> tuple[float, Stand]:
    """Compute the cost of an edge, Σ_i ‖P'(s(e_i)) - P(s(e_i))‖² [KGP02, Eq. 9], and the state at its end."""
    rows, points, end = walks.step(stand, edge)
    along = stand.along + np.cumsum(walks.graph.progress[rows])
    distances = np.abs(points - route.at(along))
    return float((distances**2).sum()), end._replace(along=float(along[-1]))


def path_problem(walks: GroundWalks, route: Route) -> Problem:
    """Formulate path following as the paper's search problem, with `cost_along` as the cost of an edge."""
    step = partial(cost_along, walks, route)
    return Problem(walks.graph.source.graph, step, lambda stand: stand.along >= route.length)


def follow_as_2002(  # noqa: PLR0913 (a path, a request, and three limits)
    graph: MotionGraph | CompiledGraph,
    path: GroundPath | VectorsLike,
    request: PathRequest,
    *,
    look: tuple[int, int] = (90, 28),
    budget: float = np.inf,
    deadline: float = np.inf,
) -> Followed:
    """Follow a path by the paper's branch and bound, to compare with `follow_path` [KGP02, Eq. 9].

    Parameters
    ----------
    graph, path : as for `steering.follow_path`.
    request : of these, only `start` is used, by default the first node. Labels and times are ignored.
    look : n and m, the frames to look ahead and the frames to keep, as for `synthesis.search_ahead`.
    budget : the largest number of walks to expand in each stretch of the search.
    deadline : seconds of wall time for the whole search, after which it returns the walk so far.

    Returns
    -------
    The walk and its distances from the path.

    Raises
    ------
    NoWalk, MocapError : as for `steering.follow_path`, and if the budget is used up before the first step.

    Warns
    -----
    MocapWarning : if the deadline ended the search, with the part of the path that the walk covers.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> path, request = body.GroundPath([[0, 0], [0, 1]]), PathRequest(start=(0, 10))
    >>> followed = follow_as_2002(graph, path, request, budget=100)
    >>> followed.progress, followed.found.stopped
    (1.0, 'out of nodes')

    Notebook: 08c-judging-a-search
    """
    compiled = compile_graph(graph)
    path = as_path(path)
    route = make_route(compiled, path, request)
    start = start_of(compiled, route, request)
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
        _warn_of_deadline(followed, deadline)
    return followed
