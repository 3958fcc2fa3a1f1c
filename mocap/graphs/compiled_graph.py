"""A motion graph as arrays, for searches that evaluate thousands of edges at once.

Ground points are complex numbers z + ix, and planar transforms are p ↦ rotation · p + translation, as in
`body.planar`.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, Points, ranges
from mocap._shared.records import dataclass
from mocap.body.concatenation import gather_marks
from mocap.body.planar import heading, on_ground
from mocap.errors import NoWalk
from mocap.graphs.edge_tables import (
    Edge,
    EdgeTable,
    MacroEdges,
    clip_rows,
    edge_table,
    find_macro_edges,
    require_node,
)
from mocap.graphs.motion_graph import MotionGraph, Node, require_graph
from mocap.graphs.tuned import TUNED


@dataclass(frozen=True, eq=False)
class CompiledGraph(EdgeTable):
    """A motion graph as arrays, of E edges with T frames, N nodes and H macro-edges.

    Parameters
    ----------
    source : the graph.
    nodes : sorted by clip and frame.
    edges : the stretches of clip, in the order of the nodes they leave, then the transitions.
    target : shape (E,), the number of the node that each edge enters.
    at : shape (N,), the position of the root at each node, in the coordinates of its clip.
    ahead : shape (N, 3), the positions of the root after `TUNED.ahead` seconds, extrapolated at constant
        velocity beyond the end of the clip.
    going : shape (N,), the direction of movement of the root, or the heading if it stands still, radians.
    ground : shape (T,), the position of the root in each frame, in the coordinates of the clip that the edge
        leaves.
    step : shape (T,), the distance of the root to its position in the previous frame, metres.
    label_names : the L labels.
    bears : shape (L, T), whether a frame has a label.
    macro_edges : the macro-edges from each node.
    """

    source: MotionGraph
    nodes: list[Node]
    edges: list[Edge]
    target: Indices
    at: Points  # reads: name: public, and read by searches everywhere
    ahead: Points
    going: Array
    ground: Points
    step: Array
    label_names: list[str]
    bears: Mask
    macro_edges: MacroEdges

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.source.fps

    @cached_property
    def progress(self) -> Array:
        """The progress of each frame, its step but at least γ, metres, (T,) [KGP02, least progress]."""
        return np.maximum(self.step, TUNED.least_speed / self.fps)

    def index(self, node: Node) -> int:
        """Return the number of a node, or raise `NoWalk` if the graph does not have it."""
        require_node(self.source, node)
        return self.nodes.index(node)

    def label_number(self, name: str) -> int:
        """Return the number of a label, -1 for "", or raise `NoWalk` if no clip has it."""
        if not name:
            return -1
        if name not in self.label_names:
            names = ", ".join(self.label_names) or "none"
            raise NoWalk(f"No clip of the graph bears the label '{name}'; there are: {names}.")
        return self.label_names.index(name)


def compile_graph(graph: MotionGraph | CompiledGraph) -> CompiledGraph:
    """Compile a motion graph into arrays. A compiled graph is returned as it is.

    Raises
    ------
    NoWalk : for a graph without edges.

    Examples
    --------
    A clip of 90 frames has a transition from frame 60 to frame 20. The last edge is the transition, which
    enters the second node:

    >>> from mocap import body, datasets, graphs, matching
    >>> clip = body.resample(datasets.sample("walk_circle"), 30)[:90]
    >>> back = matching.Transition(0, 60, 0, 10, 0.02, body.PlanarTransform(0, 0, 0))
    >>> compiled = compile_graph(graphs.from_transitions([clip], [back], window=10))
    >>> compiled.nodes, compiled.target.tolist()
    ([(0, 0), (0, 20), (0, 60), (0, 90)], [1, 2, 3, 1])

    Notebook: 08-path-synthesis
    """
    if isinstance(graph, CompiledGraph):
        return graph
    require_graph(graph)
    kinds = list(graph.graph.edges(keys=True, data="kind"))
    if not kinds:
        raise NoWalk("The graph has no edges.")
    stretches = sorted((start, end, key) for start, end, key, kind in kinds if kind == "clip")
    transitions = sorted((start, end, key) for start, end, key, kind in kinds if kind == "transition")
    edges = stretches + transitions
    nodes = sorted(graph.graph)
    number = {node: n for n, node in enumerate(nodes)}
    starts = np.array([number[start] for start, _, _ in edges])
    target = np.array([number[end] for _, end, _ in edges])
    table = edge_table(graph, edges)
    roots = on_ground(np.concatenate([clip.root_positions for clip in graph.clips]))
    positions, ahead, directions = _roots_at_nodes(graph, np.array(nodes), roots)
    ground, step = _roots_on_edges(graph, table, roots)
    # The labels of a frame in a transition are those of the clip with the larger weight.
    marks = gather_marks([clip.labels for clip in graph.clips], table.owner)
    label_names = sorted(marks)
    bears = np.array([marks[name] for name in label_names], bool).reshape(-1, len(table.of))
    macro_edges = find_macro_edges(table, starts, len(nodes), graph.fps)
    # reads: statement: one field a line
    return CompiledGraph(
        **vars(table),
        source=graph,
        nodes=nodes,
        edges=edges,
        target=target,
        at=positions,
        ahead=ahead,
        going=directions,
        ground=ground,
        step=step,
        label_names=label_names,
        bears=bears,
        macro_edges=macro_edges,
    )


def _roots_at_nodes(graph: MotionGraph, nodes: Indices, roots: Points) -> tuple[Points, Points, Array]:
    """Compute the root's position at each node, its positions ahead, and its direction of movement."""
    clip, frame = nodes.T
    last = np.array([len(motion) - 1 for motion in graph.clips])[clip]

    def root(frames: Indices) -> Points:
        return np.asarray(roots[clip_rows(graph.clips, np.stack([clip, frames], axis=1))])

    position = root(frame)
    interval = max(1, round(graph.fps * TUNED.velocity_time))  # frames
    velocity = (root(last) - root(last - interval)) / interval  # at the end of the clip, metres per frame
    later = [frame + max(1, round(graph.fps * seconds)) for seconds in TUNED.ahead]
    ahead = np.stack([root(time) + velocity * np.maximum(time - last, 0) for time in later], axis=1)
    displacement = ahead[:, -1] - position
    orientations = np.concatenate([motion.rotations[:, 0] for motion in graph.clips])
    headings = heading(orientations[clip_rows(graph.clips, nodes)])
    directions = np.where(np.abs(displacement) > TUNED.standing, np.angle(displacement), headings)
    return position, ahead, directions


def _roots_on_edges(graph: MotionGraph, edges: EdgeTable, roots: Points) -> tuple[Points, Array]:
    """Compute the root's position in every frame of every edge, and its distance to the previous frame.

    Roots are blended as in [KGP02, Eq. 5].
    """
    rotation = edges.rotation[edges.of]
    translation = edges.translation[edges.of]
    leaving = roots[clip_rows(graph.clips, edges.here)]
    entering = roots[clip_rows(graph.clips, edges.there)]
    ground = edges.alpha * leaving + (1 - edges.alpha) * (rotation * entering + translation)
    step = np.abs(np.diff(ground, prepend=0))
    # The frame before the first frame of an edge belongs to the clip that the edge leaves.
    previous = clip_rows(graph.clips, edges.here[edges.first] - np.array([0, 1]))
    step[edges.first] = np.abs(ground[edges.first] - roots[previous])
    return ground, step


def walk_track(
    graph: CompiledGraph, edges: Indices, rotation: complex, translation: complex
) -> tuple[Points, Indices]:
    """Compute the position of the root in every frame of a walk, and the rows of these frames.

    Parameters
    ----------
    graph : the compiled graph.
    edges : numbers of consecutive edges.
    rotation, translation : the planar transform p ↦ rotation · p + translation of the first edge's clip.

    Returns
    -------
    The positions, shape (F,), and the rows of the frames in the arrays of all T frames, shape (F,).
    """
    # The transforms of a clip and an edge compose to r · r_e and t + r · t_e.
    rotations = np.cumprod([rotation, *graph.rotation[edges]])[:-1]
    translations = translation + np.concatenate([[0], np.cumsum(rotations * graph.translation[edges])[:-1]])
    frames = graph.frames[edges]
    rows = ranges(graph.first[edges], frames)
    positions = np.repeat(translations, frames) + np.repeat(rotations, frames) * graph.ground[rows]
    return positions, rows
