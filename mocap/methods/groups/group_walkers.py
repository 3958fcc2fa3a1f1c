"""Characters for a group: a motion graph follows the path of each member, in space and time."""

import warnings

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap._shared.progress import Progress
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import from_ground, on_ground
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.path_editing import moving_frames, plants_kept, ride_of
from mocap.editing.toes import lowest_heights
from mocap.errors import MocapError, MocapWarning, warn
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.methods.groups.flocking import RATE, Configuration, nearest_two
from mocap.methods.groups.tuned import TUNED
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import PathRequest, Settings
from mocap.synthesis.walk_to_motion import with_footplants


@dataclass(frozen=True, eq=False)
class GroupWalkers:
    """The motions of one character for each member of a group. `walk_group` has an example.

    Parameters
    ----------
    motions : one per member, F frames each.
    kept : the fraction of planted frames that the clean-up kept.
    targets : shape (F, N), complex: the planned position of each member in each frame.
    """

    motions: tuple[Motion, ...]
    kept: float
    targets: Points

    @property
    def tracks(self) -> Points:
        """The positions of the roots on the ground, (F, N) complex."""
        return np.stack([on_ground(motion.root_positions) for motion in self.motions], axis=1)

    @property
    def errors(self) -> Array:
        """The distances of the roots from their targets, (F, N), metres."""
        return np.asarray(np.abs(self.tracks - self.targets))

    @property
    def nearest(self) -> float:
        """The smallest distance between two roots, metres."""
        return float(nearest_two(self.tracks).min())

    def report(self) -> str:
        """Summarise the errors of the characters and their distances in one line."""
        centimetres = 100 * self.errors
        seconds = len(centimetres) / self.motions[0].fps
        characters = f"{len(self.motions)} characters, {seconds:.1f} s"
        mean = f"{centimetres.mean():.1f} cm from the plan"
        percentile = f"95 % within {np.percentile(centimetres, 95):.0f} cm"
        distance = f"{self.nearest:.2f} m apart at least"
        return f"{characters}, {mean} ({percentile}), {distance}, {self.kept:.0%} of the planted frames kept"


def walk_group(
    graph: MotionGraph | CompiledGraph, flock: Configuration, *, bend: bool = True, progress: Progress = iter
) -> GroupWalkers:
    """Follow the trajectory of each member with a character of a motion graph [ours].

    Each character follows a path with a target time every second. This alone would bring characters to within
    0.15 m of each other, although the members keep 0.9 m. With `bend`, each walk is then transformed to the
    moving frames of its member's path, as in `editing.on_path` [ours]. Finally, foot sliding is removed.

    Parameters
    ----------
    graph : pruned.
    flock : trajectories of the members, as from `play_group`.
    bend : bend each walk exactly onto its member's path.
    progress : wraps the members, to show a bar.

    Returns
    -------
    One motion per member, all of the duration of the plan.

    Raises
    ------
    MocapError, NoWalk : as for `steering.follow_path`, and for a plan of less than a second.

    Warns
    -----
    MocapWarning : if more than a tenth of the planted frames were released.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> steps = 0.09 * np.arange(41)[:, None]
    >>> plan = Configuration(steps + [0j, 1.5j], np.full((41, 2), 0.9 + 0j))
    >>> walkers = walk_group(graph, plan)
    >>> for part in walkers.report().split(", "):
    ...     print(part)
    2 characters
    4.0 s
    3.7 cm from the plan (95 % within 8 cm)
    1.50 m apart at least
    100% of the planted frames kept

    Notebook: 19-group-graphs
    """
    frames, members = flock.positions.shape
    if not members or frames <= RATE:
        got = f"{members} and {max(frames - 1, 0) / RATE:g} s: does it lead away from where the group starts?"
        raise MocapError(f"A plan that is walked has a member or more and lasts 1 s or more, got {got}")
    source = graph.source if isinstance(graph, CompiledGraph) else graph
    marked = with_footplants(source)
    compiled = compile_graph(graph if marked is source else marked)
    trajectories = list(flock.positions.T)
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # one warning is given for all
        walks = [_walk_one(compiled, trajectory, bend=bend) for trajectory in progress(trajectories)]
    motions = tuple(motion for motion, _ in walks)
    kept = float(np.mean([fraction for _, fraction in walks]))
    if kept < TUNED.kept:
        released = f"{1 - kept:.0%} of the planted frames were released"
        warn(f"{released}: the steps of these clips differ from those of the plan.")
    seconds = np.arange(len(motions[0])) / compiled.fps
    plan_seconds = np.arange(frames) / RATE
    targets = np.stack([np.interp(seconds, plan_seconds, path) for path in trajectories], axis=1)
    return GroupWalkers(motions, kept, targets)


def _walk_one(graph: CompiledGraph, trajectory: Points, *, bend: bool) -> tuple[Motion, float]:
    """Follow a trajectory (F,) at ten frames per second, and measure the fraction of kept foot contacts."""
    extended = _extended(trajectory)
    path = GroundPath(from_ground(extended))
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(extended)))])
    along = np.minimum(along, path.length)  # because of rounding
    timed = range(0, len(extended), round(TUNED.time_every * RATE))
    times = [(float(along[frame]), float(frame / RATE)) for frame in timed]
    # A walk that is bent onto its path afterwards needs no thorough search.
    settings = Settings(late=TUNED.late, width=TUNED.narrow if bend else None, tries=1 if bend else 3)
    walk = follow_path(graph, path, PathRequest(times=times), settings=settings).motion()
    walk = walk[: round((len(trajectory) - 1) / RATE * graph.fps) + 1]
    if bend:
        seconds = np.arange(len(walk)) / graph.fps
        planned_along = np.interp(seconds, np.arange(len(extended)) / RATE, along)
        walk = _bend_onto(walk, path, planned_along)
    cleaned = clean_feet(walk, lowest_heights(graph.source.clips))
    return cleaned, plants_kept(cleaned, walk)


def _extended(trajectory: Points) -> Points:
    """Extend a trajectory straight ahead by three seconds, so that a walk does not wait at its end."""
    last_second = trajectory[-1] - trajectory[-11]
    step = last_second / 10 if abs(last_second) > TUNED.least_step else TUNED.least_step
    steps = np.arange(1, round(TUNED.extension * RATE) + 1)
    return np.concatenate([trajectory, trajectory[-1] + step * steps])


def _bend_onto(walk: Motion, path: GroundPath, along: Array) -> Motion:
    """Transform each frame of a walk from the moving frames of its own path to those of another one."""
    source = ride_of(walk)
    target_frames = moving_frames(path, along)
    source_frames = moving_frames(source.path, source.along)
    return (target_frames @ source_frames.inverse()).apply_motion(walk)
