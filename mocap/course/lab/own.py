"""A motion graph of one's own: `mocap.plain`, made of the functions that students write in 01 to 08.

`program` has the text of `mocap.plain`, written so that it calls the exercises of the course. Here it runs
with the student's functions: those that passed their checks, or all as they stand, right or wrong.
"""

from __future__ import annotations

import copy
import importlib.util
import itertools
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import ArrayLike

from mocap import plain
from mocap._shared.arrays import Array
from mocap.body.concatenation import require_compatible
from mocap.body.motion import Motion
from mocap.course.checks import all_checks
from mocap.course.lab import program
from mocap.course.lab.adopting import NAMES as NAMES
from mocap.course.lab.adopting import Tools
from mocap.course.lab.adopting import as_written as as_written
from mocap.course.lab.adopting import tools as tools
from mocap.course.lab.slots import whose_run
from mocap.errors import MocapError
from mocap.plain import Edge, Ground

AHEAD = 1.5  # seconds that a choice looks ahead: with less, no turn is seen
PROGRESS = {"joint_positions": "clips measured", "distance_grid": "pairs of clips compared"}
MOST_KEPT = 2  # beam widths: a search that keeps more walks of a layer takes many times as long
MOST_ROUNDS = 20  # choices of walks in each layer: with more, walks do not advance along the line
OwnWalk = tuple[list[Edge], complex, complex]  # edges, and the transform of the first clip


def pages_of(by: Tools | None, window: int, below: float = plain.BELOW, **changes: Any) -> Any:  # noqa: ANN401
    """Return a module with the names of `mocap.plain`, in which functions of exercises work.

    Parameters
    ----------
    by : a function for each exercise; None for a copy of `mocap.plain` as it is.
    window, below : of the transitions: frames, and metres.
    changes : new values of constants by their names, such as BEAM_WIDTH; also functions.

    Notebook: 04-blending
    """
    constants = {"K": window, "BELOW": below, **changes}
    if by is not None:
        exercises = {name: function for name, function in vars(by).items() if name not in changes}
        return program.module({**exercises, **changes}, constants)
    spec = importlib.util.find_spec("mocap.plain")
    assert spec is not None and spec.loader is not None
    pages = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pages)
    vars(pages).update(constants)
    return pages


def squared_distances(a: Array, b: Array, window: int, window_sums: Callable[[Array, int], Array]) -> Array:
    """Measure D between all windows of two clips by sums along diagonals, as in notebook 02b.

    Parameters
    ----------
    a, b : windows of the clips, shapes (N, n, 3) and (M, n, 3), metres.
    window : frames in a window.
    window_sums : sums along the diagonals of a matrix.

    Returns
    -------
    Mean squared distances, shape (N, M), m².
    """
    pages = program.module({"window_sums": window_sums}, {"K": window})
    return np.asarray(pages.distance_grid(a, b) ** 2)


class OwnGraph:
    """A motion graph of clips, of which the component that plays most frames is kept, and walks on it.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    window, threshold : of the transitions: frames, and metres.
    by : whose functions work; None for those of `mocap.plain`.

    Attributes
    ----------
    pages : the copy of `mocap.plain` which calls these functions.
    transitions, graph : all transitions, and the nodes and edges that are kept, as in `mocap.plain`.

    Raises
    ------
    SkeletonMismatch, MocapError : for no clips, clips that differ in skeleton or rate or are shorter than the
        window, and where there is no loop: the threshold is too low.

    Notebook: 08b-steering
    """

    def __init__(self, clips: Sequence[Motion], window: int, threshold: float, by: Tools | None) -> None:
        self.clips = require_compatible(clips)
        self.pages = pages_of(by, window, threshold)
        self.by = by
        self._walks: dict[tuple[bytes, Edge | None], OwnWalk] = {}  # by paths and first edges
        if not 2 <= window <= min(map(len, self.clips)):
            raise MocapError(f"A graph takes a window of two frames up to the shortest clip, got {window}.")
        self.transitions = self.pages.find_transitions(self.clips)
        whole = self.pages.cut_and_join(self.clips, self.transitions)
        self.graph: nx.MultiDiGraph = self.pages.prune(whole)
        if len(self.graph) < 2:
            raise MocapError(f"No walk goes on for ever with transitions below {threshold} m: allow more.")

    def varied(self, **changes: Any) -> OwnGraph:  # noqa: ANN401
        """Return the same graph, on which the program walks with some changes.

        Parameters
        ----------
        changes : new values of the program's constants by their names, such as BEAM_WIDTH, LOOK, RESCUE and
            SEAM of `mocap.plain`, or functions in place of exercises.

        Raises
        ------
        MocapError : for a name that the program does not have.
        """
        for name in changes:
            if name not in NAMES and not hasattr(plain, name):
                raise MocapError(f"The program has no constant or exercise '{name}', such as BEAM_WIDTH.")
        variation = copy.copy(self)
        variation._walks = {}
        variation.pages = pages_of(self.by, self.pages.K, self.pages.BELOW, **changes)
        return variation

    def follow(self, path: ArrayLike, first: Edge | None = None) -> OwnWalk:
        """Find a walk along a path: all walks advance layer by layer, as in notebook 08 [KGP02, Eq. 9].

        Parameters
        ----------
        path : corners on the ground (x, z), shape (N, 2), metres.
        first : the edge with which the walk begins, such as the reader's seam; by default any.

        Raises
        ------
        ValueError : if no walk reaches the end of the path, or the graph has no such edge.
        MocapError : for functions with which the search would not end, or not before minutes have passed.
        """
        line = self.pages.points_along(np.asarray(path, float))
        search = self.pages.Search(self.clips, self.graph, line)
        layers = search.end / self.pages.LAYER
        if first is not None:
            search.starts = _starts_by(search, first)
        search.best_of = _bounded(search.best_of, self.pages.BEAM_WIDTH, MOST_ROUNDS * (1 + round(layers)))
        walk: OwnWalk = search.walk()
        return walk

    def steer(self, command: Callable[[float], tuple[float, float]], seconds: float) -> OwnWalk:
        """Walk for some seconds, and choose at each node the edge that fits the command of that moment.

        Parameters
        ----------
        command : from the time in seconds to a heading in radians (0 is +z, π/2 is +x) and a speed, metres
            per second.
        seconds : how long to walk.
        """
        fps = self.clips[0].fps
        frames_ahead = round(AHEAD * fps)
        choose = self.by.next_edge if self.by else all_checks()["next_edge"].truth
        search = self.pages.Search(self.clips, self.graph, self.pages.points_along(np.eye(2)))
        node = min(self.graph)
        transform = (1 + 0j, 0j)
        walk: list[Edge] = []
        frames = 0
        while frames < seconds * fps:
            edges = list(self.graph.out_edges(node, keys=True))
            tracks = [self._track_ahead(search, edge)[: frames_ahead + 1] for edge in edges]
            number = choose(transform[0], tracks, *command(frames / fps), fps)
            edge = edges[int(number)]
            walk.append(edge)
            frames += len(search.tracks[edge])
            transform = self.pages.compose(transform, self.graph.edges[edge]["transform"])
            node = edge[1]
        return walk, 1, 0

    def _track_ahead(self, search: Any, edge: Edge) -> Ground:  # noqa: ANN401 (of a copied module)
        """Return the root's track on an edge, and then to the end of the clip that the edge leads into."""
        (clip_before, frame_before), (clip, frame), _ = edge
        rotation, translation = self.graph.edges[edge]["transform"]
        start = search.roots[clip_before][[max(frame_before - 1, 0)]]
        onward = rotation * search.roots[clip][frame:] + translation
        return np.concatenate([start, search.tracks[edge], onward])

    def walk(self, path: ArrayLike, first: Edge | None = None) -> tuple[Motion, list[int]]:
        """Find a walk along a path, and play it.

        Parameters
        ----------
        path, first : as for `follow`.

        Returns
        -------
        The motion, and the first frame of each transition.

        Raises
        ------
        ValueError : if no walk reaches the end of the path, or the graph has no such edge.
        """
        key = (np.asarray(path, float).tobytes(), first)
        if key not in self._walks:
            self._walks[key] = self.follow(path, first)
        followed = self._walks[key]
        edges = [self.graph.edges[edge] for edge in followed[0]]
        starts = np.cumsum([0, *(edge["frames"] for edge in edges)]).tolist()
        seams = [start for start, edge in zip(starts, edges, strict=False) if edge["kind"] == "transition"]
        return self.play(followed), seams

    def play(self, walk: OwnWalk) -> Motion:
        """Play a walk, shape (F, ...): copy stretches of clip, blend transitions [KGP02, Eqs. 5 and 6]."""
        roots, rotations = self.pages.to_motion(self.clips, self.graph, *walk)
        return Motion(self.clips[0].skeleton, roots, rotations, self.clips[0].fps, "my walk")


def my_graph(clips: Sequence[Motion], window: int, threshold: float, path: ArrayLike) -> OwnGraph:
    """Build a graph with the student's functions as they stand, right or wrong, and print whose they are.

    If functions that do not pass do not lead along a path, which is printed, those that pass stand in.

    Parameters
    ----------
    clips, window, threshold : as for `OwnGraph`.
    path : corners on the ground (x, z), shape (N, 2), metres.

    Notebook: 08-path-synthesis
    """
    by = as_written()
    try:
        graph = OwnGraph(clips, window, threshold, by)
        graph.walk(path)
    except Exception as error:  # whatever functions that do not pass lead to
        by = tools()
        problem = f"{type(error).__name__}: {error}"
        print(f"As you wrote them, your functions do not fit together. {problem}"[:200])
        graph = OwnGraph(clips, window, threshold, by)
    print(whose_run(vars(by)[name] for name in NAMES[:-1]))  # the last one steers, in 08b
    return graph


def main(file: str) -> int:
    """Walk along a line by the functions in a file that has no program of its own, as earlier versions wrote.

    The arguments on the command line are those of `python -m mocap.plain`: clips, a path, and -o.

    Returns
    -------
    The exit status: 0, or 2 if there is no walk.
    """
    return run(vars(program.module({}, {})), file)


def run(names: dict[str, Any], file: str) -> int:
    """Run the program in `my_graph.py` as it stands, right or wrong, and print what does not pass its check.

    Parameters
    ----------
    names : the global names of the file. A function that it lacks is the package's. A function whose helper
        has the name of another one's helper gets its own again.
    file : its path.

    Returns
    -------
    The exit status: 0, or 2 if there is no walk.
    """
    os.environ["MOCAP_MINE"] = file
    by = as_written()
    print(f"{whose_run(vars(by)[name] for name in NAMES[:-1])}.")
    for name, slot in vars(by).items():
        function = slot.written
        if _first_line(names.get(name)) in (None, _first_line(function)):
            names[name] = function
    for name, label in PROGRESS.items():
        names[name] = _counted(names[name], label)
    names["Search"].best_of = _counted(names["Search"].best_of, "layers searched")
    try:
        return int(names["main"]())
    except Exception as error:  # functions that do not pass may not fit together
        print(_place_of(error, Path(file)), file=sys.stderr)
        return 2


def _starts_by(search: Any, first: Edge) -> Callable[[], list[Any]]:  # noqa: ANN401 (of a copied module)
    """Return the starts of a search whose walks all begin with one edge."""
    every_start = search.starts

    def starts() -> list[Any]:
        if not search.graph.has_edge(*first):
            raise ValueError("The pruned graph does not have the edge with which the walk should begin.")
        return [search.lengthen(walk, first) for walk in every_start() if walk.node == first[0]]

    return starts


def _bounded(best_of: Callable[[list[Any]], list[Any]], width: int, rounds: int) -> Callable[..., list[Any]]:
    """Return the choice of a layer, which raises where the search would go on nearly for ever.

    Parameters
    ----------
    best_of : chooses the walks of a layer that go on.
    width : how many these may be.
    rounds : the largest number of choices.
    """
    counted = itertools.count(1)

    def choose(walks: list[Any]) -> list[Any]:
        kept = best_of(walks)
        if len(kept) > MOST_KEPT * width:
            problem = f"`survivors` keeps {len(kept)} walks of a layer, and the beam width is {width}."
            raise MocapError(f"{problem} Such a search does not end in good time.")
        if next(counted) > rounds:
            raise MocapError(f"After {rounds} layers no walk is at the end of the line: they do not advance.")
        return kept

    return choose


def _first_line(function: object) -> int | None:
    """Return the line at which a function starts in its file; None for what is no function in Python."""
    code = getattr(function, "__code__", None)
    return code.co_firstlineno if code else None


def _place_of(error: Exception, file: Path) -> str:
    """Return a sentence that names the error, and the last line of the file that led to it."""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame for frame in frames if Path(frame.filename).name == file.name and frame.name[0] != "<"]
    in_file = f", line {lines[-1].lineno}, in `{lines[-1].name}`" if lines else ""
    return f"{file.name}{in_file}: {type(error).__name__}: {error}"[:200]


def _counted(function: Callable[..., Any], label: str) -> Callable[..., Any]:
    """Return a function that also shows on a terminal how often it has been called."""
    from tqdm import tqdm  # no notebook needs it

    bar = tqdm(bar_format="{n} {desc}, {elapsed}", desc=label, delay=1.0, leave=False, disable=None)

    def call(*arguments: Any) -> Any:  # noqa: ANN401 (as the function has it)
        result = function(*arguments)
        bar.update()
        return result

    return call
