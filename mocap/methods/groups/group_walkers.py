"""Characters for a group: each member's way is walked by a motion graph, in place and in time."""

import warnings

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap._shared.progress import Progress
from mocap._shared.records import dataclass
from mocap.body.ground_path import GroundPath
from mocap.body.motion import Motion
from mocap.body.planar import from_ground, on_ground
from mocap.editing.path_editing import moving_frames, plants_kept, ride_of
from mocap.errors import MocapError, MocapWarning, warn
from mocap.feet.footskate import clean_up
from mocap.graphs.compiled_graph import CompiledGraph, compile_graph
from mocap.graphs.motion_graph import MotionGraph
from mocap.methods.groups.flocking import RATE, Configuration, nearest_two
from mocap.steering.path_following import follow_path
from mocap.steering.path_objective import Settings, Wishes
from mocap.synthesis.walk_to_motion import with_plants

LATE = 1.0  # m² per s²: in time, at 0.9 seams per second
EVERY = 1.0  # seconds between the places that are passed in time
KEPT = 0.9  # a smaller share of planted frames is warned of
NARROW = 40  # walks in a beam
BEYOND = 3.0  # seconds by which each way is carried on
MOVES = 0.05  # metres per second or more, to have a direction


@dataclass(frozen=True, eq=False)
class GroupWalkers:
    """A character for each member of a group; `walk_group` shows an example.

    Parameters
    ----------
    motions : one per member, F frames each.
    kept : the share of planted frames that the clean-up kept.
    wanted : shape (F, N), complex: where each should be in each frame.
    """

    motions: tuple[Motion, ...]
    kept: float
    wanted: Points

    @property
    def tracks(self) -> Points:
        """Where each root is, (F, N) complex."""
        return np.stack([on_ground(motion.root_positions) for motion in self.motions], axis=1)

    @property
    def off(self) -> Array:
        """Metres from where each should be by then, (F, N)."""
        return np.asarray(np.abs(self.tracks - self.wanted))

    @property
    def nearest(self) -> float:
        """The least distance of any two roots, metres."""
        return float(nearest_two(self.tracks).min())

    def report(self) -> str:
        """Say in one line how well the characters keep to the plan."""
        off = 100 * self.off
        return (
            f"{len(self.motions)} characters, {len(off) / self.motions[0].fps:.1f} s, {off.mean():.1f} cm "
            f"from where they should be by then (95 % within {np.percentile(off, 95):.0f} cm), "
            f"{self.nearest:.2f} m apart at least, {self.kept:.0%} of the planted frames kept"
        )


def walk_group(
    graph: MotionGraph | CompiledGraph, flock: Configuration, *, bend: bool = True, progress: Progress = iter
) -> GroupWalkers:
    """Walk each member's way by a character of a motion graph, in place and in time [ours].

    Each member's way is a path to follow, with a place to pass in each second: the bare lines would bring
    characters to 0.15 m of each other, although the members keep 0.9 m. With `bend` each walk is then put
    into the frame that moves as its member does, as in `editing.on_path` [ours]; at last the feet are
    cleaned.

    Parameters
    ----------
    graph : pruned.
    flock : where the members go, as `play_group` gives it.
    bend : put each walk exactly onto its member's way.
    progress : wraps the members, to show a bar.

    Returns
    -------
    One motion per member, which all last as long as the plan.

    Raises
    ------
    MocapError, NoWalk : as `steering.follow_path`, and for a plan of less than a second.

    Warns
    -----
    MocapWarning : where more than a tenth of the planted frames had to be let go.

    Examples
    --------
    >>> from mocap import body, datasets, graphs
    >>> clips = [body.resample(datasets.sample(name), 30) for name in ("walk_circle", "walk_curve_1")]
    >>> graph = graphs.prune(graphs.build(clips, window=10, threshold=0.04))
    >>> steps = 0.09 * np.arange(41)[:, None]
    >>> plan = Configuration(steps + [0j, 1.5j], np.full((41, 2), 0.9 + 0j))
    >>> walkers = walk_group(graph, plan)
    >>> for said in walkers.report().split(", "):
    ...     print(said)
    2 characters
    4.0 s
    3.7 cm from where they should be by then (95 % within 8 cm)
    1.50 m apart at least
    100% of the planted frames kept

    Notebook: 19-group-graphs
    """
    frames, members = flock.places.shape
    if not members or frames <= RATE:
        got = f"{members} and {max(frames - 1, 0) / RATE:g} s: does it lead away from where the group starts?"
        raise MocapError(f"A plan that is walked has a member or more and lasts 1 s or more, got {got}")
    source = graph.source if isinstance(graph, CompiledGraph) else graph
    marked = with_plants(source)
    compiled = compile_graph(graph if marked is source else marked)
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # one is given for all together
        walked = [_walk_one(compiled, places, bend=bend) for places in progress(list(flock.places.T))]
    motions = tuple(motion for motion, _ in walked)
    kept = float(np.mean([share for _, share in walked]))
    if kept < KEPT:
        warn(f"{1 - kept:.0%} of the planted frames were let go: these clips take other steps than the plan.")
    seconds, clock = np.arange(len(motions[0])) / compiled.fps, np.arange(frames) / RATE
    wanted = np.stack([np.interp(seconds, clock, places) for places in flock.places.T], axis=1)
    return GroupWalkers(motions, kept, wanted)


def _walk_one(graph: CompiledGraph, places: Points, *, bend: bool) -> tuple[Motion, float]:
    """Walk one member's way, (F,) complex at ten places per second; say which share of plants is kept."""
    # Carried on straight, so that a walk along it lasts until its end and does not wait there.
    step = (places[-1] - places[-11]) / 10 if abs(places[-1] - places[-11]) > MOVES else MOVES
    further = np.concatenate([places, places[-1] + step * np.arange(1, round(BEYOND * RATE) + 1)])
    path = GroundPath(from_ground(further))
    along = np.minimum(np.concatenate([[0.0], np.cumsum(np.abs(np.diff(further)))]), path.length)  # rounding
    some = np.arange(0, len(further), round(EVERY * RATE))
    times = [(float(along[k]), float(k / RATE)) for k in some]
    # A walk that is put onto its way need not be searched for so thoroughly.
    settings = Settings(late=LATE, width=NARROW if bend else None, tries=1 if bend else 3)
    found = follow_path(graph, path, Wishes(times=times), settings=settings)
    walked = found.motion()[: round((len(places) - 1) / RATE * graph.fps) + 1]
    if bend:
        ride = ride_of(walked)
        seconds = np.arange(len(walked)) / graph.fps
        asked = moving_frames(path, np.interp(seconds, np.arange(len(further)) / RATE, along))
        own = moving_frames(ride.path, ride.along)
        walked = (asked @ own.inverse()).apply_motion(walked)
    cleaned = clean_up(walked)
    return cleaned, plants_kept(cleaned, walked)
