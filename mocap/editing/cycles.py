"""The best cycle in a clip, closed for repetition.

The pair of most similar frames is not a cycle: it is in a part of the clip in which the body hardly moves.
Therefore the cost of a cycle has two terms, in metres: the distance between its ends, and the mean distance
of the other frames of the clip from the nearest frame of the cycle. The weight of a frame in the mean is the
displacement of the body to the next frame, so that the cycle of a clip in which somebody mostly stands is a
step. The second term is large for a held pose, and for half a stride. In a clip that begins or ends with a
long stand, a held pose may still cost least: therefore a cycle moves at least three quarters as much as the
clip does. Method and cost are ours.
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
from mocap.body.concatenation import concatenate
from mocap.body.motion import Motion, require_motion, resample
from mocap.body.planar import PlanarTransform, align_frames, heading
from mocap.editing.foot_cleaning import clean_feet
from mocap.editing.path_editing import plants_kept
from mocap.editing.toes import lowest_heights
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, MocapWarning, shortened, warn
from mocap.feet.footplants import mark_plants
from mocap.matching import distance_grids
from mocap.matching.distance_grids import distance_grid
from mocap.matching.point_clouds import point_cloud
from mocap.matching.prepared_clouds import Floats

SHORTEST = 0.4  # seconds, the shortest cycle that is searched for by default
LONGEST = 3.0  # seconds, the longest one
STILL = 1e3  # metres: more than any cost. A held pose is chosen only if the bounds allow nothing else
TINY = 1e-9  # metres, and of the clip's motion: no weight is 0, and no average of nothing is 0 / 0

# m² and metres. In 32 bits D is exact to some 4e-7 m², so a D of less than `NOTHING` is 0. Costs are then
# exact to some 1e-5 m, and the first of equal cycles is taken: a clip that repeats itself has one a round.
NOTHING = 1e-6
EQUAL = 2e-5


class Loop(NamedTuple):
    """A cycle found in a clip.

    Parameters
    ----------
    first, last : its frames in the clip; the pose at `last` is similar to that at `first`.
    seam : the distance between them, RMS over the points of a window, metres.
    missed : the mean distance of the other frames of the clip from the nearest one of the cycle, weighted by
        the displacements of the body, metres.
    """

    first: int
    last: int
    seam: float
    missed: float


def find_loop(motion: Motion, *, seconds: tuple[float, float] = (SHORTEST, LONGEST)) -> Loop:
    """Find the shortest cycle whose sum of `seam` and `missed` is within a tenth of the least one.

    Parameters
    ----------
    motion : F frames.
    seconds : the shortest and the longest cycle, no shorter than the seam of 0.2 s.

    Raises
    ------
    MocapError : for a clip that is too short for such a cycle and its seam, or longer than five minutes, and
        for bounds in a wrong order.

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
    [(872, 1133), (432, 456)]
    """
    require_motion(motion)
    slow = resample(motion, TUNED.loop_rate) if motion.fps > TUNED.loop_rate else motion
    seam = TUNED.loop_seam
    if not seam <= seconds[0] <= seconds[1] < np.inf:
        raise MocapError(f"A cycle lasts {seam:g} s or more, from one bound to a larger one; got {seconds}.")
    window = max(2, round(seam * slow.fps))
    shortest = max(2, round(seconds[0] * slow.fps))
    longest = min(round(seconds[1] * slow.fps), len(slow) - window)
    if shortest > longest or slow.duration > TUNED.loop_longest:
        lasts = f"'{shortened(motion.name)}' lasts {motion.duration:.3g} s"
        bounds = f"{seconds[0] + seam:g} to {TUNED.loop_longest:g} s"
        raise MocapError(f"{lasts}: to find a cycle takes {bounds}.")
    points = point_cloud(slow)
    points = (points - points.mean(axis=(0, 1))).astype(np.float32)  # kilometres away 32 bits are too few
    grid = distance_grid(points, points, window=window)
    np.sqrt(np.where(grid < NOTHING, np.float32(0.0), grid), out=grid)
    first, length, missed = _best(grid, shortest, longest)
    ends = (first / slow.fps, (first + length) / slow.fps)
    return _refined(motion, ends, seconds[0], missed)


def _best(grid: Floats, shortest: int, longest: int) -> tuple[int, int, float]:
    """Find the first frame, the length and `missed` of the best cycle.

    Examples
    --------
    >>> swing = np.array([0, 1, 2, 1, 0, 1, 2, 1, 0])
    >>> distances = np.abs(np.subtract.outer(swing, swing)).astype(float)
    >>> _best(distances, 2, 6), [round(number, 3) for number in _best(distances, 2, 3)]
    ((0, 4, 0.0), [1, 2, 0.333])
    """
    count = len(grid)
    chosen = np.unique(np.linspace(0, count - 1, min(count, TUNED.loop_rows)).astype(int))
    displacements = np.append(np.diagonal(grid, 1), 0.0)  # of the body, to the next frame
    largest = np.percentile(displacements[chosen], TUNED.loop_percentile)
    displacements = np.minimum(displacements, largest) + TINY
    moved = np.concatenate([[0.0], np.cumsum(displacements, dtype=float)])  # before each frame
    least_per_frame = TUNED.loop_motion * moved[-1] / count
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
            motion_of_cycles = moved[length:-1] - moved[:starts]
            is_held = motion_of_cycles < length * least_per_frame
            costs = np.where(is_held, costs + STILL, costs)
            start = int(first_least(costs, EQUAL))
            cycles.append((float(costs[start]), start, length, float(missed[start])))
        np.minimum(nearest[:, :starts], rows[:, length:], out=nearest[:, :starts])
    largest_cost = TUNED.loop_slack * min(cost for cost, *_ in cycles) + EQUAL
    return next((start, length, missed) for cost, start, length, missed in cycles if cost <= largest_cost)


def _refined(motion: Motion, ends: tuple[float, float], shortest: float, missed: float) -> Loop:
    """Search for the most similar frames within one frame of the coarse search around both ends."""
    window = max(2, round(TUNED.loop_seam * motion.fps))
    reach = int(np.ceil(motion.fps / TUNED.loop_rate))  # frames
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

    The frames after the cycle in the clip are blended into its beginning, within 0.2 s, as in a transition of
    a motion graph. Therefore the cycle starts that much later than `found.first`, and all its frames are of
    the clip.

    Parameters
    ----------
    motion : F frames.
    found : the cycle, by default that of `find_loop(motion)`.
    straight : whether to remove the rotation of one round, evenly, so that the rounds go straight ahead.
        Standing feet then rotate with the body.
    clean : whether to mark footplants again and remove footskate, as in the middle of many rounds.

    Returns
    -------
    last - first + 1 frames. The last one is the first one, moved on the ground; `repeated` concatenates
    rounds.

    Raises
    ------
    MocapError : for frames that are too near for the seam, a value that is no motion or no cycle, and with
        `clean` for legs that are not found.

    Warns
    -----
    MocapWarning : for footplants of the cycle that are released.

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
    window = max(2, round(TUNED.loop_seam * motion.fps))
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
    window = max(2, round(TUNED.loop_seam * motion.fps))
    seam = repeated(cycle, 2)[max(len(cycle) - window - 2, 0) : len(cycle) + 2]
    usual = np.percentile(_accelerations(motion), 99)
    return float(_accelerations(seam).max() / max(usual, TINY))


def _accelerations(motion: Motion) -> Array:
    """Return the largest second difference of any joint's position in each frame, metres."""
    return np.asarray(np.linalg.norm(np.diff(motion.positions, 2, axis=0), axis=-1).max(axis=1))


def _straightened(cycle: Motion) -> Motion:
    """Rotate the frames by angles that increase evenly, until both ends have the same heading."""
    headings = np.unwrap(heading(cycle.rotations[:, 0]))
    corrections = -(headings[-1] - headings[0]) * np.linspace(0, 1, len(cycle))
    between_frames = (corrections[1:] + corrections[:-1]) / 2
    steps = PlanarTransform(between_frames, 0.0, 0.0).apply_points(np.diff(cycle.root_positions, axis=0))
    roots = cycle.root_positions[:1] + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    local = cycle.rotations.copy()
    local[:, 0] = rotations.multiply(rotations.about_y(corrections), local[:, 0])
    return replace(cycle, root_positions=roots, rotations=local)


def _cleaned(cycle: Motion, lowest: Array) -> Motion:
    """Clean up many rounds, and return the middle one, which no correction at the ends reaches."""
    neighbours = int(np.ceil(TUNED.loop_margin / cycle.duration))  # rounds on each side
    rounds = mark_plants(repeated(replace(cycle, contacts={}), 2 * neighbours + 1))
    start = neighbours * (len(cycle) - 1)
    middle = slice(start, start + len(cycle))
    with warnings.catch_warnings(action="ignore", category=MocapWarning):  # of frames in all rounds
        cleaned = clean_feet(rounds, lowest)[middle]
    kept = plants_kept(cleaned, rounds[middle])
    if kept < 1:
        released = f"'{shortened(cycle.name)}': {1 - kept:.0%} of the planted frames are let go"
        warn(f"{released}: to hold them would move the root by more than 2 cm, stretch a leg or jolt a knee.")
    return align_frames(cleaned, cycle).apply_motion(cleaned)


def repeated(cycle: Motion, times: int) -> Motion:
    """Concatenate rounds of a cycle.

    Parameters
    ----------
    cycle : its last frame is its first one, moved on the ground, as from `loop`; it is not repeated.
    times : the number of rounds, 1 or more.

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
