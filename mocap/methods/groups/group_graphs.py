"""Group motion graphs: nodes are configurations, and edges are clips of the whole group [LCF05]."""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Points
from mocap._shared.records import dataclass
from mocap.body.planar import IDENTITY, PlanarTransform
from mocap.errors import MocapError, warn
from mocap.methods.groups.configurations import cluster, seen_from_itself
from mocap.methods.groups.flocking import APART, Configuration, simulate
from mocap.methods.groups.group_clips import GroupClip, clips_from
from mocap.methods.groups.tuned import TUNED


@dataclass(frozen=True, eq=False)
class GroupGraph:
    """Configurations of N members as nodes, and clips that lead from one to another.

    `tried` is the number of clips that were simulated, including those that were rejected because of
    collisions or high accelerations.

    Examples
    --------
    >>> graph = build_group(4, nodes=3, corridors=(), simulated=60.0, reach=0.4)
    >>> graph.members, len(graph.nodes), {clip.start for clip in graph.clips} == {0, 1, 2}
    (4, 3, True)
    """

    nodes: tuple[Configuration, ...]
    clips: tuple[GroupClip, ...]
    tried: int

    def __repr__(self) -> str:
        return f"GroupGraph({len(self.nodes)} nodes, {len(self.clips)} clips)"

    @property
    def members(self) -> int:
        """The number of members."""
        return int(self.nodes[0].positions.shape[-1])

    def leaving(self, node: int) -> list[int]:
        """List the numbers of the clips that leave a node."""
        return [number for number, clip in enumerate(self.clips) if clip.start == node]


def make_clips(nodes: Sequence[Configuration], *, seed: int = 0) -> GroupGraph:
    """Join nodes by clips of four seconds, for each ordered pair, bend and lateral shift [ours, after LCF05].

    Parameters
    ----------
    nodes : configurations, each as from `seen_from_itself`.
    seed : seed of the whims of the members.

    Returns
    -------
    The graph of clips without collisions and without accelerations above 2.2 m/s².

    Raises
    ------
    MocapError : for a node that stands still, and if no clip is kept.

    Warns
    -----
    MocapWarning : for pairs of nodes that no clip joins.

    Notebook: 19-group-graphs
    """
    for node in nodes:
        seen_from_itself(node)  # raises for a node that stands still
    random = np.random.default_rng(seed)
    clips: list[GroupClip] = []
    tried = 0
    for start in range(len(nodes)):
        kept_clips, count = clips_from(start, nodes, random)
        clips += kept_clips
        tried += count
    if not clips:
        reason = f"members come nearer than {APART:g} m, or need more than {TUNED.hardest:g} m/s²"
        raise MocapError(f"None of {tried} clips can be kept: {reason}.")
    pairs = len(nodes) ** 2
    joined = len({(clip.start, clip.end) for clip in clips})
    if joined < pairs:
        warn(f"No clip joins {pairs - joined} of {pairs} pairs of nodes.")
    return GroupGraph(tuple(nodes), tuple(clips), tried)


def build_group(  # noqa: PLR0913 (sizes, durations and distances)
    members: int,
    *,
    nodes: int = 8,
    corridors: Sequence[float] = TUNED.corridors,
    simulated: float = 300.0,
    reach: float = 0.5,
    seed: int = 0,
) -> GroupGraph:
    """Build a group motion graph: simulate, cluster, and join the nodes by clips [LCF05, graph].

    A group that walked only over open ground has no narrow node, and cannot pass a gap narrower than itself.
    Therefore the group is also simulated for a minute in each corridor. The configurations that recur there
    are *columns*, which are added to the nodes [ours].

    Parameters
    ----------
    members : number of members, at least 2.
    nodes, reach : as for `cluster`, on open ground.
    corridors : metres from wall to wall. Each adds one or two columns. Without any, the group stays wide.
    simulated : seconds of flocking over open ground from which the nodes are chosen.
    seed : as for `simulate`.

    Raises
    ------
    MocapError : as for `simulate`, `cluster` and `make_clips`.

    Warns
    -----
    MocapWarning : as for `cluster` and `make_clips`.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> sorted({(clip.start, clip.end) for clip in graph.clips})
    [(0, 0), (0, 1), (1, 0), (1, 1)]
    >>> len(graph.clips), graph.tried  # four pairs, five bends, three shifts
    (60, 60)

    Notebook: 19-group-graphs
    """
    configurations = cluster(simulate(members, simulated, seed=seed), nodes=nodes, reach=reach).nodes
    for width in corridors:
        columns = simulate(members, TUNED.column, corridor=width, seed=seed)
        configurations += cluster(columns, nodes=2, reach=reach).nodes
    return make_clips(configurations, seed=seed)


def random_group_walk(graph: GroupGraph, clips: int, *, start: int = 0, seed: int = 0) -> list[int]:
    """Return a random walk: the numbers of clips, each drawn uniformly from those that leave its node.

    Raises
    ------
    MocapError : for a node that no clip leaves.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> random_group_walk(graph, 5)
    [25, 49, 45, 38, 9]

    Notebook: 19-group-graphs
    """
    random = np.random.default_rng(seed)
    node = start
    walk: list[int] = []
    for _ in range(clips):
        leaving = graph.leaving(node)
        if not leaving:
            raise MocapError(f"No clip leaves node {node}.")
        walk.append(int(random.choice(leaving)))
        node = graph.clips[walk[-1]].end
    return walk


def play_group(graph: GroupGraph, walk: Sequence[int], start: PlanarTransform = IDENTITY) -> Configuration:
    """Concatenate clips to the trajectories of all members, one column for each member [LCF05, playing].

    The planar transforms of the clips are composed, *and so are the orders of the members*: the member that
    ends in slot `order[s]` of a clip continues from that slot in the next clip. Without the orders, members
    would jump by metres between clips.

    Parameters
    ----------
    graph : the graph of the clips.
    walk : numbers of clips, each leaving the node where the previous one ends.
    start : the transform of the first node to the ground, by default the identity.

    Raises
    ------
    MocapError : for an empty walk, and for clips that do not follow one another.

    Examples
    --------
    >>> graph = build_group(3, nodes=2, corridors=(), simulated=40.0, reach=0.4)
    >>> play_group(graph, random_group_walk(graph, 5)).positions.shape
    (201, 3)

    Notebook: 19-group-graphs
    """
    if not len(walk):
        raise MocapError("A walk of a group has one clip or more, got none.")
    clips = [graph.clips[number] for number in walk]
    node = clips[0].start
    rotation = start.rotation
    translation = start.translation
    slots = np.arange(graph.members)  # slot of each member at the start of a clip
    positions: list[Points] = []
    velocities: list[Points] = []
    for clip in clips:
        if node != clip.start:
            raise MocapError(f"A group at node {node} cannot go on by a clip that leaves {clip.start}.")
        positions.append((rotation * clip.positions + translation)[:, slots])
        velocities.append((rotation * clip.velocities)[:, slots])
        node = clip.end
        slots = clip.order[slots]
        translation = rotation * clip.translation + translation
        rotation = rotation * clip.rotation
    return Configuration(_concatenate(positions), _concatenate(velocities))


def _concatenate(clips: Sequence[Points]) -> Points:
    """Concatenate the frames of clips, where the last frame of each is the first one of the next."""
    return np.concatenate([*(frames[:-1] for frames in clips), clips[-1][-1:]])
