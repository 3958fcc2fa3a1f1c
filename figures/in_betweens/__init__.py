"""Between two poses at two places in a given time: a walk through the clips, brought to both.

`tasks.in_betweening` measures it. Walks from both poses that meet half-way give what the clips can do. Of the
best of them the one is taken that need be changed least: its path is bent [Gle01] and its steps are
lengthened, its time is stretched, and its ends fade into the poses. Then its feet are cleaned up. The papers
ask for a path; that a walk arrives at a pose in time is ours.

1. `two_sided_search`: frames that look like two poses, and walks from both that meet half-way
2. `end_bending`: a walk bent and stretched so that it ends where it must

References
----------
.. [Gle01] M. Gleicher, *Motion Path Editing*, I3D 2001, doi 10.1145/364338.364400.
.. [KGP02] L. Kovar, M. Gleicher, F. Pighin, *Motion Graphs*, SIGGRAPH 2002, doi 10.1145/566654.566605.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from in_betweens.end_bending import MOST_TURN, Arrived, bend_to
from in_betweens.two_sided_search import TwoSided, choices, pose_at
from mocap._shared.arrays import Array, Mask, runs
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.editing.displacements import Displacement, difference, displaced
from mocap.editing.retiming import at_frames
from mocap.errors import MocapWarning, NoWalk
from mocap.feet.footplants import least_frames
from mocap.feet.footskate import clean_up, settled_marks
from mocap.graphs.compiled_graph import CompiledGraph
from mocap.graphs.edge_tables import Edge
from mocap.synthesis.walk_to_motion import to_motion, with_plants

TRIED = 24  # walks that are bent, of all that were found
POSE = 0.1  # metres by which joints may be moved where ends fade into the poses, the root mean square

# Times that feet are cleaned up and ends brought to the poses. The clean-up may let go what it should hold at
# the ends, by up to 1° of a joint; feet then slide by up to 0.3 mm. After the second round most do not. Where
# a straight leg makes the clean-up lower the root near an end, 1 mm is left; more rounds do not help.
ROUNDS = 2
FADE = 0.5  # seconds over which a difference fades, at most; half of a walk that is shorter than two of it
NEAR = 0.3  # seconds from an end: a plant so near to it stands where it stands at its frame next to the end


class InBetween(NamedTuple):
    """A motion from one pose to another, and what it took.

    `motion`: N + 1 frames, the first and the last of them the poses asked for; `walk`: the edges that it
    plays; `arrived`: the walk before its ends faded, and by how much it was turned, lengthened and retimed.
    """

    motion: Motion
    walk: list[Edge]
    arrived: Arrived


def in_between(graph: CompiledGraph, start: Motion, end: Motion, seconds: float) -> InBetween:
    """Find a motion from one pose to another, each at its place, in a given time.

    Parameters
    ----------
    graph : pruned, and compiled.
    start, end : motions of the graph's skeleton, at their places: from the first frame of one to the last
        frame of the other. Further frames say how fast they move. Clips of the graph are met best.
    seconds : from the first frame to the last, rounded to whole frames.

    Raises
    ------
    NoWalk : where no walk arrives though its pace and its steps change by up to a quarter, its turning by up
        to 60° per second and the poses at its ends by up to 10 cm.
    """
    frames = round(seconds * graph.fps)
    near = choices(graph, start, way=1, limit=POSE), choices(graph, end, way=-1, limit=POSE)
    source, found = with_plants(graph.source), []
    for joined in TwoSided(graph, near, frames).best(TRIED):
        walk = [graph.edges[edge] for edge in joined.edges]
        played = to_motion(source, walk, place=joined.place)[joined.first : joined.first + joined.frames + 1]
        arrived = bend_to(played, frames + 1, joined.end, joined.apart)
        if arrived.lack <= POSE / 2 and np.abs(arrived.turned).max() <= MOST_TURN:
            found.append((joined.cost + arrived.price, walk, arrived))
    if not found:
        raise NoWalk(f"No walk leads from one pose to the other in {seconds:.1f} s: give another time.")
    _, walk, arrived = min(found, key=lambda one: one[0])
    motion = meet_poses(replace(arrived.motion, name="in between"), start, end)
    for _ in range(ROUNDS):
        motion = meet_poses(stand(motion), start, end, speed=False)
    return InBetween(motion, walk, arrived)


def stand(motion: Motion) -> Motion:
    """Clean up the feet, and change nothing in the first and in the last frames.

    `feet.clean_up` puts a plant where it is on average, and lets what it changes fade over 0.2 s. A pose at
    an end would change. So plants near an end stand where they stand next to it, and from there to the end
    both joints of the foot are held on their own way, as if they stood.

    Parameters
    ----------
    motion : F frames with contacts, whose feet hardly slide at both ends.

    Returns
    -------
    The motion; plants that were let go are no longer marked.
    """
    legs = find_legs(motion.skeleton)
    marks, places = settled_marks(motion, legs), joint_positions(motion)
    columns = [joint for leg in legs for joint in (leg.ankle, leg.ball)]
    known = np.full((len(motion), len(columns), 3), np.nan)  # nan where nothing is held
    for n, own in enumerate(marks):
        foot = slice(2 * n, 2 * n + 2)
        for way in (slice(None), slice(None, None, -1)):  # the start is the end of the motion run backwards
            _hold_end(known[way, foot], places[way][:, columns[foot]], own[:, way], motion.fps)
    names = [motion.skeleton.names[joint] for joint in columns]
    own = dict(zip(names, marks.reshape(-1, len(motion)), strict=True))
    also = {name: own[name] | np.isfinite(known[:, n, 0]) for n, name in enumerate(names)}
    where = dict(zip(columns, np.swapaxes(known, 0, 1), strict=True))
    # Its warnings would also list the frames that are held here.
    with warnings.catch_warnings(action="ignore", category=MocapWarning):
        found = clean_up(replace(motion, contacts={**motion.contacts, **also}), legs, held=where)
    contacts = {name: mark & own.get(name, mark) for name, mark in found.contacts.items()}
    return replace(found, contacts=contacts)


def _hold_end(held: Array, places: Array, marks: Mask, fps: float) -> None:
    """Fill in where the joints are held at the end of a motion, and in the plant that is near to it.

    What stands in the plant's last frame is held there, the rest a foot's length away.
    """
    away = places - places[:, ::-1]  # of each joint from the other one
    span, length = least_frames(fps), np.linalg.norm(away[0, 0])
    stands, begin = runs(marks[0] | marks[1]), len(places) - span - 1
    if len(stands) and stands[-1][1] > len(places) - max(span, round(NEAR * fps)):
        first, begin = stands[-1].tolist()
        for kind in sorted((0, 1), key=lambda kind: not marks[kind, begin - 1]):
            for start, stop in runs(marks[kind, :begin]):
                both = np.flatnonzero(np.isfinite(held[start:stop, 1 - kind, 0])) + start
                if stop == begin:
                    held[start:stop, kind] = places[begin - 1, kind]
                elif start >= first and len(both):
                    way = away[both, kind].mean(axis=0)
                    held[start:stop, kind] = held[both[-1], 1 - kind] + length * way / np.linalg.norm(way)
    held[begin:] = places[begin:]
    # Where one joint stands up to the end, the other is where the foot's own turn has it; also in the gaps so
    # short that a clean-up closes them.
    for kind in (0, 1):
        alone = np.isnan(held[:, kind, 0]) & ~np.isnan(held[:, 1 - kind, 0])
        alone[: min(begin, len(places) - 1) - span] = False
        held[alone, kind] = held[alone, 1 - kind] + away[alone, kind]


def meet_poses(motion: Motion, start: Motion, end: Motion, *, speed: bool = True) -> Motion:
    """Add what the first and the last frame lack to two poses, and let it fade into the walk.

    The differences fade as in `blending.inertialize`: by a quintic that starts with
    the speed by which they change at the pose, and ends at rest. At the end of the walk it runs backwards.

    Parameters
    ----------
    motion : F frames, which starts and ends near to the poses.
    start, end : the poses, the first frame of the one and the last frame of the other.
    speed : whether the fades start with the speed of the differences; else they are level.
    """
    begin, finish = _fading(motion, start, 1, speed=speed), _fading(motion, end, -1, speed=speed)
    added = Displacement(*(one + other for one, other in zip(begin, finish, strict=True)))
    return displaced(motion, added)


def _fading(motion: Motion, asked: Motion, way: int, *, speed: bool) -> Displacement:
    """Let the difference at an end fade: x(u) = (1 - u)⁴ (x + (4 x + v T) u), and 0 from u = 1 on.

    `way` is 1 for the first frames of both motions, -1 for their last ones.
    """
    last = len(motion) - 1
    frame, window = (0 if way > 0 else last), max(1.0, min(FADE * motion.fps, last / 2))
    late = np.minimum(np.abs(np.arange(last + 1) - frame) / window, 1)
    here = difference(pose_at(asked, way), motion[frame : frame + 1])
    drift = [0 * part for part in here]
    if speed and len(asked) > 1:
        step = way * motion.fps / asked.fps
        then = difference(pose_at(asked, way, 1), at_frames(motion, [frame + step]))
        drift = [(b - a) * window / abs(step) for a, b in zip(here, then, strict=True)]
    faded = []
    for x, v in zip(here, drift, strict=True):
        u = late.reshape(-1, *np.ones(x.ndim - 1, int))
        faded.append((1 - u) ** 4 * (x + (4 * x + v) * u))
    return Displacement(*faded)
