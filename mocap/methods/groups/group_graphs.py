"""Group motion graphs: nodes are configurations, and clips of the whole group join them [LCF05]."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.records import dataclass
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import MocapError, warn
from mocap.methods.groups.configurations import cluster, seen_from_itself
from mocap.methods.groups.flocking import APART, Configuration, simulate
from mocap.methods.groups.group_clips import HARDEST, GroupClip, clips_from

CORRIDORS = (2.5, 2.0, 1.7)  # metres from wall to wall
COLUMN = 60.0  # seconds in each


@dataclass(frozen=True, eq=False)
class GroupGraph:
    """Configurations of N members as nodes, and clips that lead from one to another.

    `tried` counts all clips that were made; those that nobody could walk are left out.

    Examples
    --------
    >>> graph = build_group(4, nodes=3, corridors=(), simulated=60.0, reach=0.4)
    >>> graph.members, len(graph.nodes), {clip.start for clip in graph.clips} == {0, 1, 2}
    (4, 3, True)
    """

    nodes: tuple[Configuration, ...]
    clips: tuple[GroupClip, ...]
    tried: int

    @property
    def members(self) -> int:
        """How many walk."""
        return int(self.nodes[0].places.shape[-1])

    def leaving(self, node: int) -> list[int]:
        """List the numbers of the clips that leave a node."""
        return [number for number, clip in enumerate(self.clips) if clip.start == node]


def make_clips(nodes: Sequence[Configuration], *, seed: int = 0) -> GroupGraph:
    """Join nodes by clips of four seconds, for each ordered pair, bend and shift aside [ours, after LCF05].

    Parameters
    ----------
    nodes : configurations, each seen from itself.
    seed : of the members' whims.

    Returns
    -------
    The graph of clips without collisions and without accelerations above 2.2 m/s².

    Raises
    ------
    MocapError : for a node that stands, and where no clip is kept.

    Warns
    -----
    MocapWarning : for pairs of nodes that no clip joins.

    Notebook: 19-group-graphs
    """
    for node in nodes:
        seen_from_itself(node)  # refuses who stands
    random = np.random.default_rng(seed)
    made = [clips_from(start, nodes, random) for start in range(len(nodes))]
    clips, tried = tuple(clip for kept, _ in made for clip in kept), sum(count for _, count in made)
    if not clips:
        why = f"members come nearer than {APART:g} m, or need more than {HARDEST:g} m/s²"
        raise MocapError(f"None of {tried} clips can be kept: {why}.")
    if missing := len(nodes) ** 2 - len({(clip.start, clip.end) for clip in clips}):
        warn(f"No clip joins {missing} of {len(nodes) ** 2} pairs of nodes.")
    return GroupGraph(tuple(nodes), clips, tried)


def build_group(  # noqa: PLR0913 (how many, how long and how fine)
    members: int,
    *,
    nodes: int = 8,
    corridors: Sequence[float] = CORRIDORS,
    simulated: float = 300.0,
    reach: float = 0.5,
    seed: int = 0,
) -> GroupGraph:
    """Build a group motion graph: simulate, cluster, and join the nodes by clips [LCF05, graph].

    A group that only ever walked over open ground has no narrow node, and passes no gap narrower than
    itself. So it also walks a minute through corridors; what comes again there are *columns*, as further
    nodes [ours].

    Parameters
    ----------
    members : from 2 on.
    nodes, reach : as for `cluster`, on open ground.
    corridors : metres from wall to wall; one column or two come of each; none: the group stays wide.
    simulated : seconds of flocking over open ground to take the nodes from.
    seed : as for `simulate`.

    Raises
    ------
    MocapError : as `simulate`, `cluster` and `make_clips`.

    Warns
    -----
    MocapWarning : as `cluster` and `make_clips`.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> sorted({(clip.start, clip.end) for clip in graph.clips})
    [(0, 0), (0, 1), (1, 0), (1, 1)]
    >>> len(graph.clips), graph.tried  # four pairs, five bends, three shifts aside
    (60, 60)

    Notebook: 19-group-graphs
    """
    found = cluster(simulate(members, simulated, seed=seed), nodes=nodes, reach=reach).nodes
    for width in corridors:
        narrow = simulate(members, COLUMN, corridor=width, seed=seed)
        found += cluster(narrow, nodes=2, reach=reach).nodes
    return make_clips(found, seed=seed)


def random_group_walk(graph: GroupGraph, clips: int, *, start: int = 0, seed: int = 0) -> list[int]:
    """Wander through the graph: the numbers of clips, each chosen evenly among those that leave its node.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> random_group_walk(graph, 5)
    [25, 49, 45, 38, 9]

    Notebook: 19-group-graphs
    """
    random, node, walk = np.random.default_rng(seed), start, []
    for _ in range(clips):
        if not (leaving := graph.leaving(node)):
            raise MocapError(f"No clip leaves node {node}.")
        walk.append(int(random.choice(leaving)))
        node = graph.clips[walk[-1]].end
    return walk


def play_group(graph: GroupGraph, walk: Sequence[int], start: PlanarTransform = IDENTITY) -> Configuration:
    """Put clips in a row: where every member goes, one column for each from start to end [LCF05, playing].

    Places, turns *and the members' numbers* multiply up: the member in slot s of a clip's start goes on in
    slot `order[s]` of the next. Without this members would jump by metres at each seam.

    Parameters
    ----------
    graph : whose clips.
    walk : numbers of clips, each leaving the node where the one before ends.
    start : how the first configuration lies on the ground; as it is seen by itself by default.

    Raises
    ------
    MocapError : for no clips, and clips that do not follow one another.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> play_group(graph, random_group_walk(graph, 5)).places.shape
    (201, 3)

    Notebook: 19-group-graphs
    """
    if not len(walk):
        raise MocapError("A walk of a group has one clip or more, got none.")
    clips = [graph.clips[number] for number in walk]
    node, turn, move = clips[0].start, start.rotation, start.translation
    order, places, velocities = np.arange(graph.members), [], []
    for clip in clips:
        if node != clip.start:
            raise MocapError(f"A group at node {node} cannot go on by a clip that leaves {clip.start}.")
        places.append((turn * clip.places + move)[:, order])
        velocities.append((turn * clip.velocities)[:, order])
        node, order = clip.end, clip.order[order]
        turn, move = turn * clip.turn, turn * clip.move + move
    rows = ([*(frames[:-1] for frames in part), part[-1][-1:]] for part in (places, velocities))
    return Configuration(*map(np.concatenate, rows))
