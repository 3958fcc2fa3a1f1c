"""The best cycle in a clip, closed: a stride that walks for ever.

The pair of frames with the smallest seam is the wrong one: it lies where the body hardly moves, and the cycle
is a held pose. So a cycle is judged by two lengths in metres: how far apart its ends are, and how far the
other frames of the clip are from the nearest of its own, on average. The average counts a frame by how far
the body moves there, so that a clip of somebody who mostly stands still gives a step, too. The second length
is large for a held pose, and for half a stride. In a clip that begins or ends with a long stand, a held pose
may still cost least: so a cycle must move at least half as much as the clip does. Method and measure are
ours.
"""

import warnings
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.quantities import described
from mocap._shared.records import NamedTuple
from mocap._shared.ties import first_least
from mocap.blending.joining import join
from mocap.body import rotations
from mocap.body.motion import Motion, concatenate, require_motion, resample
from mocap.body.planar import PlanarTransform, align_frames, heading
from mocap.editing.edits import raised
from mocap.editing.path_editing import plants_kept
from mocap.editing.toes import lowest_allowed, lowest_heights
from mocap.errors import MocapError, MocapWarning, shortened, warn
from mocap.feet.footplants import mark_plants
from mocap.feet.footskate import clean_up
from mocap.matching import distance_grids
from mocap.matching.distance_grids import Floats, distance_grid
from mocap.matching.point_clouds import point_cloud

COARSE = 30.0  # frames per second at which the whole clip is searched
LONGEST = 300.0  # seconds of a clip: the grid of all its windows takes 0.3 GB
ROWS = 600  # frames of the clip, evenly chosen, that a cycle may cover
MOSTLY = 90  # percent of the frames: where the data leap, a frame counts no more than these
ENOUGH = 1.1  # times the least cost: two strides are hardly better than one
LEAST_MOTION = 0.5  # of the clip's, on average over the frames: a cycle that moves less stands still
TINY = 1e-9  # metres, and of the clip's motion: no weight is 0, and no average of nothing is 0 / 0

# m² and metres. In 32 bits D is right to some 4e-7 m², so a D of less than `NOTHING` is 0. Costs are then
# right to some 1e-5 m, and the first of equal cycles is taken: a clip that repeats itself has one a round.
NOTHING = 1e-6
EQUAL = 2e-5

MARGIN = 3.0  # seconds: longer than any footplant of a walk, and than the reach of any correction
SEAM = 0.2  # seconds: the window in which two moments are compared, and in which the cycle is closed


class Loop(NamedTuple):
    """A cycle found in a clip.

    Parameters
    ----------
    first, last : its frames in the clip; the pose at `last` is nearly that at `first`.
    seam : how far apart they are, RMS over the points of a window, metres.
    missed : how far another frame of the clip is from the nearest one of the cycle, on average over the
        motion of the clip, metres.
    """

    first: int
    last: int
    seam: float
    missed: float


def find_loop(motion: Motion, *, seconds: tuple[float, float] = (0.4, 3.0)) -> Loop:
    """Find the cycle with the smallest sum of `seam` and `missed`; of all within a tenth of it, the shortest.

    Parameters
    ----------
    motion : F frames.
    seconds : the shortest and the longest cycle, no shorter than the seam of 0.2 s.

    Raises
    ------
    MocapError : for a clip that has no room for such a cycle and its seam, or lasts more than five minutes,
        and for bounds in a wrong order.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> found = find_loop(walk)
    >>> found.first, found.last, round(found.seam, 4), round(found.missed, 4)  # 1.2 s; metres
    (697, 828, 0.0069, 0.0187)
    >>> [find_loop(clip)[:2] for clip in (walk[994:1166], resample(walk, 20))]
    [(5, 136), (154, 176)]
    >>> [find_loop(walk, seconds=bounds)[:2] for bounds in ((2.0, 3.0), (0.2, 0.2))]  # two strides; the least
    [(872, 1133), (820, 844)]
    """
    require_motion(motion)
    slow = resample(motion, COARSE) if motion.fps > COARSE else motion
    if not SEAM <= seconds[0] <= seconds[1] < np.inf:
        raise MocapError(f"A cycle lasts {SEAM:g} s or more, from one bound to a larger one; got {seconds}.")
    window, shortest = (max(2, round(length * slow.fps)) for length in (SEAM, seconds[0]))
    longest = min(round(seconds[1] * slow.fps), len(slow) - window)
    if shortest > longest or slow.duration > LONGEST:
        lasts = f"'{shortened(motion.name)}' lasts {motion.duration:.3g} s"
        raise MocapError(f"{lasts}: to find a cycle takes {seconds[0] + SEAM:g} to {LONGEST:g} s.")
    points = point_cloud(slow)
    points = (points - points.mean(axis=(0, 1))).astype(np.float32)  # kilometres away 32 bits are too few
    grid = distance_grid(points, points, window=window)
    np.sqrt(np.where(grid < NOTHING, np.float32(0.0), grid), out=grid)
    first, length, missed = _best(grid, shortest, longest)
    ends = (first / slow.fps, (first + length) / slow.fps)
    return _refined(motion, ends, seconds[0], missed)


def _best(grid: Floats, shortest: int, longest: int) -> tuple[int, int, float]:
    """Find the first frame and the length of the best cycle, and its `missed`.

    Examples
    --------
    >>> swing = np.array([0, 1, 2, 1, 0, 1, 2, 1, 0])
    >>> distances = np.abs(np.subtract.outer(swing, swing)).astype(float)
    >>> _best(distances, 2, 6), [round(number, 3) for number in _best(distances, 2, 3)]
    ((0, 4, 0.0), [1, 2, 0.333])
    """
    count = len(grid)
    chosen = np.unique(np.linspace(0, count - 1, min(count, ROWS)).astype(int))
    displacements = np.append(np.diagonal(grid, 1), 0.0)  # of the body, to the next frame
    displacements = np.minimum(displacements, np.percentile(displacements[chosen], MOSTLY)) + TINY
    moved = np.concatenate([[0.0], np.cumsum(displacements, dtype=float)])  # before each frame
    least_per_frame = LEAST_MOTION * moved[-1] / count
    displacements = displacements[chosen]
    weights = displacements / displacements.sum()
    cumulated = np.concatenate([[0.0], np.cumsum(np.bincount(chosen, weights, count))])
    rows = grid[chosen]
    nearest = rows.copy()  # [f, i]: from frame f to the nearest of the cycle that starts at i
    cycles = []
    for length in range(1, longest + 1):
        starts = count - length
        if length >= shortest:
            weight_inside = cumulated[length:-1] - cumulated[:starts]
            missed = weights @ nearest[:, :starts] / np.maximum(1 - weight_inside, TINY)
            costs = np.diagonal(grid, length) + missed
            moves_enough = moved[length:-1] - moved[:starts] >= length * least_per_frame
            if moves_enough.any():
                costs = np.where(moves_enough, costs, np.inf)
            start = int(first_least(costs, EQUAL))
            cycles.append((float(costs[start]), start, length, float(missed[start])))
        np.minimum(nearest[:, :starts], rows[:, length:], out=nearest[:, :starts])
    largest_cost = ENOUGH * min(cost for cost, *_ in cycles) + EQUAL
    return next((start, length, missed) for cost, start, length, missed in cycles if cost <= largest_cost)


def _refined(motion: Motion, ends: tuple[float, float], shortest: float, missed: float) -> Loop:
    """Move both ends by less than a coarse frame to where they are closest."""
    window = max(2, round(SEAM * motion.fps))
    reach = int(np.ceil(motion.fps / COARSE))  # frames
    latest = len(motion) - window - 1  # a frame must follow the window
    candidates = []
    for time in ends:
        middle = min(round(time * motion.fps), latest)
        candidates.append(range(max(0, middle - reach), min(middle + reach, latest) + 1))
    firsts, lasts = candidates
    parts = [motion[frames[0] : frames[-1] + window] for frames in candidates]
    grid = distance_grid(*parts, window=window)
    grid[np.subtract.outer(firsts, lasts) > -shortest * motion.fps] = np.inf
    nearest = int(first_least(grid, distance_grids.EQUAL))
    i, j = divmod(nearest, len(lasts))
    seam = float(np.sqrt(max(grid[i, j], 0.0)))
    return Loop(firsts[i], lasts[j], seam, missed)


def loop(  # reads: name: `found` is a parameter that users may give by its name
    motion: Motion, found: Loop | None = None, *, straight: bool = False, clean: bool = False
) -> Motion:
    """Cut a cycle out of a clip and close it.

    What follows the cycle in the clip passes into its beginning, within 0.2 s, as a transition of a motion
    graph does. So the cycle starts that much later than `found.first`, and no frame is invented.

    Parameters
    ----------
    motion : F frames.
    found : from `find_loop`, which is the default, or frames of your own choice.
    straight : whether to take out the turn of one round, evenly, so that the cycle goes on straight ahead.
        Feet that stand are then turned with the body.
    clean : whether to mark the plants anew and remove footskate, as it would be in the midst of many rounds.

    Returns
    -------
    last - first + 1 frames. The last one is the first one, moved over the ground; `repeated` lays one round
    behind the other.

    Raises
    ------
    MocapError : for frames that leave no room for the seam, what is no motion or no cycle, and with `clean`
        for legs that are not found.

    Warns
    -----
    MocapWarning : for plants of the cycle that are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[120:600]
    >>> round_ = loop(walk, straight=True)
    >>> turn = heading(round_.rotations[[0, -1], 0])
    >>> bool(abs(turn[1] - turn[0]) < 1e-9), len(round_)
    (True, 129)
    >>> len(loop(walk, Loop(0, 24, 0, 0))), len(loop(walk, Loop(400, 455, 0, 0)))  # the seam takes 24 frames
    (25, 56)
    """
    require_motion(motion)
    if not isinstance(found, tuple | None):
        remedy = "editing.repeated(editing.loop(motion), times) repeats one"
        raise MocapError(
            f"found is a cycle from editing.find_loop(motion), got {described(found)}: {remedy}."
        )
    first, last, *_ = found or find_loop(motion)
    window = max(2, round(SEAM * motion.fps))
    if not 0 <= first < last < len(motion) - window or last - first < window:
        frames = f"from frame {first} to {last} of {len(motion)}"
        raise MocapError(f"A cycle {frames} leaves no room for a seam of {window} frames.")
    joined = join(motion, last, motion, first, window)
    cycle = joined[first + window : last + window + 1]
    cycle = replace(cycle, name=f"{motion.name}_loop")
    if straight:
        cycle = _straightened(cycle)
    if clean:
        cycle = _cleaned(cycle, lowest_heights([motion]))
    return cycle


def seam_jolt(motion: Motion, cycle: Motion) -> float:
    """Return the largest acceleration of a joint in the seam of a cycle, relative to that of its clip.

    Parameters
    ----------
    motion : the clip.
    cycle : from `loop`.

    Returns
    -------
    The largest acceleration of any joint in the last 0.2 s of a round and the first two frames of the next,
    divided by the 99th percentile of the largest acceleration in each frame of the clip.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> round(seam_jolt(walk, loop(walk)), 1)
    0.7
    """
    window = max(2, round(SEAM * motion.fps))
    seam = repeated(cycle, 2)[max(len(cycle) - window - 2, 0) : len(cycle) + 2]
    usual = np.percentile(_accelerations(motion), 99)
    return float(_accelerations(seam).max() / max(usual, TINY))


def _accelerations(motion: Motion) -> Array:
    """Return the largest second difference of any joint's position in each frame, metres."""
    return np.asarray(np.linalg.norm(np.diff(motion.positions, 2, axis=0), axis=-1).max(axis=1))


def _straightened(cycle: Motion) -> Motion:
    """Turn each step a little more than the previous one, until both ends have the same heading."""
    headings = np.unwrap(heading(cycle.rotations[:, 0]))
    corrections = -(headings[-1] - headings[0]) * np.linspace(0, 1, len(cycle))
    between_frames = (corrections[1:] + corrections[:-1]) / 2
    steps = PlanarTransform(between_frames, 0.0, 0.0).apply_points(np.diff(cycle.root_positions, axis=0))
    roots = cycle.root_positions[:1] + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    local = cycle.rotations.copy()
    local[:, 0] = rotations.multiply(rotations.about_y(corrections), local[:, 0])
    return replace(cycle, root_positions=roots, rotations=local)


def _cleaned(cycle: Motion, lowest: Array) -> Motion:
    """Clean up many rounds, of which the middle one has neighbours as far as any correction reaches."""
    neighbours = int(np.ceil(MARGIN / cycle.duration))  # rounds on each side
    rounds = mark_plants(repeated(replace(cycle, contacts={}), 2 * neighbours + 1))
    start = neighbours * (len(cycle) - 1)
    middle = slice(start, start + len(cycle))
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # of frames in all rounds
        cleaned = raised(clean_up(rounds), lowest_allowed(rounds, lowest))[middle]
    kept = plants_kept(cleaned, rounds[middle])
    if kept < 1:
        released = f"'{shortened(cycle.name)}': {1 - kept:.0%} of the planted frames are let go"
        warn(f"{released}: to hold them would move the root by more than 2 cm, stretch a leg or jolt a knee.")
    return align_frames(cleaned, cycle).apply_motion(cleaned)


def repeated(cycle: Motion, times: int) -> Motion:
    """Lay a cycle behind itself, so many times.

    Parameters
    ----------
    cycle : its last frame is its first one, farther on, as `loop` makes it; that frame is counted once.
    times : 1 or more.

    Raises
    ------
    MocapError : for another number of times, and a cycle of a single frame.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> stride = loop(sample("walk_straight"), straight=True)
    >>> rounds = repeated(stride, 3)
    >>> len(stride), len(rounds)  # the last frame of a round is the first of the next
    (132, 394)
    >>> [round(float(clip.root_positions[-1, 2] - clip.root_positions[0, 2]), 2) for clip in (stride, rounds)]
    [1.38, 4.13]
    """
    if times < 1 or len(cycle) < 2:
        raise MocapError(f"A cycle of {len(cycle)} frames cannot be repeated {times} times.")
    copies = [cycle]
    for _ in range(times - 1):
        last = copies[-1]
        copies.append(align_frames(cycle, last, len(last) - 1).apply_motion(cycle))
    return concatenate([*(copy[:-1] for copy in copies), copies[-1][-1:]])
