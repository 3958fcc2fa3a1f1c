"""Evidence of a clip's unit and vertical axis, from its bones and frames alone [ours].

A file of joints says neither in which unit it is written nor which axis is up. The frames do: a body that
stands is long along the vertical, its lowest joint stands still while the others move, and gravity gives the
size of whoever falls or walks. All lengths here are in the unit of the file.
"""

from __future__ import annotations

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask, frozen
from mocap._shared.records import NamedTuple
from mocap.body.limb_pairs import limb_pairs
from mocap.body.limb_tree import BodyTree, extents, largest_part
from mocap.files.tuned import TUNED

AXES = ("y", "z", "-y", "-z", "x", "-x")
GRAVITY = 9.81  # m/s²
NO_OFFSET: Array = frozen([0.0, 0.0, 0.0], np.float64)


class Stride(NamedTuple):
    """A cycle of a walk or run: its `period` in seconds, and its `length` in legs."""

    period: float
    length: float


class Evidence(NamedTuple):
    """The evidence of one clip; lengths are in the unit of its file.

    size : how tall the body is if it stands; else the longest chain of its bones, over that of a person of
        height 1.
    stands : whether the body is as tall as the chains of its bones allow.
    scores : for each axis, how much speaks for its pointing up.
    stillness : for each axis, how much slower the lowest joint moves than the others, as a logarithm.
    on_floor : whether the lowest joints are at 0 along the best axis.
    fall : acceleration in free fall, units/s²; None if the body never falls.
    stride : the cycle of the gait; None if there is none.
    floors : for each axis, the median height of the lowest joint.
    root_offset : the vector to which the positions of the root may be relative, shape (3,).
    """

    size: float
    stands: bool
    scores: dict[str, float]
    stillness: dict[str, float]
    on_floor: bool
    fall: float | None
    stride: Stride | None
    floors: dict[str, float]
    root_offset: Array

    def best_axis(self) -> str:
        """Return the axis with the highest score."""
        return max(self.scores, key=lambda axis: self.scores[axis])


CHAIN = 1.5  # longest chain of bones of a person / height from the lowest to the topmost joint: 1.38 to 1.66
CHAIN_SPREAD = 0.22  # of the logarithm of that ratio; dogs are at 2.5
LEG = 0.53  # of the height from the lowest to the topmost joint


def gather(
    parents: Indices, positions: Array, rate: float, root_offset: Array = NO_OFFSET
) -> Evidence | None:
    """Gather the evidence of a clip, or return None if its joints make no body.

    Parameters
    ----------
    parents : shape (J,), -1 for the root.
    positions : shape (F, J, 3), in the world, in the unit of the file, of `frames_to_look_at`.
    rate : of these frames, Hz.
    root_offset : the vector to which the positions of the root may be relative, shape (3,).
    """
    joints = main_body(parents, positions)
    points = positions[:, joints]
    if len(joints) < TUNED.least_joints or not extents(points).max() > 0:
        return None
    parents = _renumbered(parents, joints)
    scores, stillness, floors = _axis_scores(parents, points, rate)
    axis = max(scores, key=lambda name: scores[name])
    heights = points @ direction(axis)
    tall = float(np.quantile(np.ptp(heights, axis=1), 0.9))
    chain = longest_chain(parents, points)
    stands = bool(abs(np.log(chain / max(tall, 1e-12) / CHAIN)) < CHAIN_SPREAD)
    size = tall if stands else chain / CHAIN
    possible_floors = floors[axis] + np.array([0.0, root_offset @ direction(axis)])
    on_floor = bool(np.abs(possible_floors).min() < 0.1 * tall)
    fall = free_fall(heights, rate, size)
    cycle = stride(points, axis, rate, size)
    return Evidence(size, stands, scores, stillness, on_floor, fall, cycle, floors, root_offset)


def frames_to_look_at(root_positions: Array, fps: float) -> tuple[Indices, float]:
    """Choose the ten seconds in which the root travels furthest: frames, and their rate, about 30 Hz.

    Examples
    --------
    >>> frames, rate = frames_to_look_at(np.zeros((100, 3)), 120.0)
    >>> frames[:4], rate
    (array([ 0,  4,  8, 12]), 30.0)
    """
    step = max(1, round(fps / TUNED.looked_at_rate))
    frames = np.arange(0, len(root_positions), step)
    surplus = len(frames) - TUNED.looked_at_frames
    if surplus > 0:
        steps = np.linalg.norm(np.diff(root_positions[frames], axis=0), axis=1)
        travelled = np.append(0.0, np.cumsum(steps))
        start = int(np.argmax(travelled[TUNED.looked_at_frames - 1 :] - travelled[: surplus + 1]))
        frames = frames[start : start + TUNED.looked_at_frames]
    return frames, fps / step


def direction(axis: str) -> Array:
    """Return the unit vector of a signed axis, shape (3,).

    Examples
    --------
    >>> direction("-z")
    array([ 0.,  0., -1.])
    """
    sign = -1.0 if axis.startswith("-") else 1.0
    vector = np.zeros(3)
    vector["xyz".index(axis[-1])] = sign
    return vector


def main_body(parents: Indices, positions: Array) -> Indices:
    """Return the joints of the body, parents first, without a chain above it such as a point on the floor.

    A root that stands still, targets of inverse kinematics and props move against their parents, and are no
    part of the body: see `body.limb_tree.largest_part`. Nor is a sword that keeps its distance from a hand.
    """
    joints = largest_part(parents, positions)
    while len(joints) > 1 and np.count_nonzero(parents[joints[1:]] == joints[0]) == 1:
        joints = joints[1:]
    carried = carried_joints(parents, positions) if len(joints) >= TUNED.least_joints else set()
    return np.array([joint for joint in joints if joint not in carried])


def carried_joints(parents: Indices, positions: Array) -> set[int]:
    """Return the joints beyond the end of a limb that are farther from it than any of its mirror image.

    A hand with a sword reaches much farther below the wrist than the other hand.
    """
    steps = max(1, len(positions) // TUNED.frames_of_props)
    tree = BodyTree(parents, positions[::steps], direction(AXES[0]))
    carried: set[int] = set()
    for limbs in limb_pairs(tree):
        shorter, longer = sorted((limb.end for limb in limbs), key=lambda end: tree.reach[end])
        surplus = tree.reach[longer] - tree.reach[shorter]
        if surplus > TUNED.carried_length * tree.height:
            distances = {longer: 0.0}
            for joint in tree.below(longer)[1:]:
                distances[joint] = distances[tree.parents[joint]] + float(tree.lengths[joint])
            farthest = tree.reach[shorter] + TUNED.carried_length * tree.height / 2
            carried |= {joint for joint, distance in distances.items() if distance > farthest}
    return carried


def longest_chain(parents: Indices, points: Array) -> float:
    """Measure the longest chain of bones from one end of a tree to another, from positions (F, J, 3)."""
    bones = _bone_lengths(parents, points)
    below = np.zeros(len(parents))  # longest chain from each joint to an end
    longest = 0.0
    for joint in range(len(parents) - 1, -1, -1):
        branches = sorted(below[child] + bones[child] for child in np.flatnonzero(parents == joint))
        below[joint] = branches[-1] if branches else 0.0
        longest = max(longest, sum(branches[-2:]))
    return float(longest)


def paired_joints(parents: Indices, points: Array) -> Mask:
    """Mark the joints of limbs with a mirror image: another chain of the same bones at the same joint."""
    bones = _bone_lengths(parents, points)
    chains: list[list[float]] = [[] for _ in parents]  # lengths of bones down the longest chain
    paired = np.zeros(len(parents), bool)
    for joint in range(len(parents) - 1, -1, -1):
        children = np.flatnonzero(parents == joint)
        longest = max((chains[child] for child in children), key=sum, default=[])
        chains[joint] = [bones[joint], *longest]
        for child in children:
            mirrored = any(_are_same(chains[child], chains[c]) for c in children if c != child)
            paired[child] |= mirrored
    for joint in range(1, len(parents)):
        paired[joint] |= paired[parents[joint]]
    return paired


def free_fall(heights: Array, fps: float, size: float) -> float | None:
    """Measure the acceleration downwards in the longest jump, units/s²; None if there is no jump.

    The mean of all joints falls about as fast as the centre of mass.

    Parameters
    ----------
    heights : of all joints, shape (F, J).
    fps : frames per second.
    size : of the body.
    """
    lowest = heights.min(axis=1)
    is_airborne = lowest > np.quantile(lowest, 0.05) + TUNED.airborne * size
    edges = np.flatnonzero(np.diff(np.pad(is_airborne.astype(int), 1)))
    shortest, longest = TUNED.air_time
    falls: list[tuple[int, float]] = []  # frames in the air, and acceleration in bodies per s²
    for start, stop in edges.reshape(-1, 2):
        frames = stop - start
        if frames >= TUNED.air_frames and shortest <= frames / fps <= longest:
            margin = frames // 6
            falls += _parabola(heights[start + margin : stop - margin].mean(axis=1) / size, fps)
    return max(falls)[1] * size if falls else None


def _parabola(centre: Array, fps: float) -> list[tuple[int, float]]:
    """Return the number of frames and the acceleration downwards of a fall, or nothing if it is none."""
    times = np.arange(len(centre)) / fps
    curve = np.polyfit(times, centre, 2)
    roughness = np.std(centre - np.polyval(curve, times))
    acceleration = float(-2 * curve[0])
    slowest, fastest = TUNED.fall_acceleration
    is_fall = roughness < TUNED.parabola_error and slowest < acceleration < fastest
    return [(len(centre), acceleration)] if is_fall else []


def stride(points: Array, axis: str, fps: float, size: float) -> Stride | None:
    """Find the cycle of a gait: the shortest time after which the body has nearly the same heights again.

    Parameters
    ----------
    points : of all joints, shape (F, J, 3).
    axis : that points up.
    fps : frames per second.
    size : of the body.
    """
    lag = _cycle(points @ direction(axis), fps)
    if lag is None:
        return None
    centre = np.delete(_centres(points), "xyz".index(axis[-1]), axis=1)
    lengths = np.linalg.norm(centre[lag:] - centre[:-lag], axis=1)
    return Stride(lag / fps, float(np.median(lengths) / (LEG * size)))


def _centres(points: Array) -> Array:
    """Return the mean of all joints in each frame, (F, 3)."""
    return np.full(points.shape[1], 1 / points.shape[1]) @ points


def _cycle(heights: Array, fps: float) -> int | None:
    """Return the first lag in frames after which all joints have nearly the same heights again."""
    frames = len(heights)
    pose = heights - heights.mean(axis=1, keepdims=True)
    pose = pose - pose.mean(axis=0)
    power = 2 * (pose**2).mean()
    if frames < TUNED.least_seconds * fps or power == 0:
        return None
    lags = range(1, min(int(TUNED.longest_cycle * fps), int(0.6 * frames)))
    changes = [((pose[lag:] - pose[:-lag]) ** 2).mean() / power for lag in lags]
    change = np.array([0.0, *changes])
    for lag in lags[int(TUNED.shortest_cycle * fps) : -1]:
        is_dip = change[lag] <= min(change[lag - 1], change[lag + 1])
        if is_dip and change[lag] < TUNED.repeated_pose * change[:lag].max():
            return lag
    return None


def _renumbered(parents: Indices, joints: Indices) -> Indices:
    """Return the parents of some joints, counted among these; -1 for those without a parent among them."""
    numbers = {int(joint): number for number, joint in enumerate(joints)}
    return np.array([numbers.get(int(parents[joint]), -1) for joint in joints])


def _bone_lengths(parents: Indices, points: Array) -> Array:
    """Return the median length of the bone above each joint, (J,); 0 for the root."""
    above = np.where(parents < 0, np.arange(len(parents)), parents)
    lengths = np.linalg.norm(points - points[:, above], axis=-1)
    return np.asarray(np.median(lengths, axis=0))


def _are_same(first: list[float], second: list[float]) -> bool:
    """Check whether two chains have as many bones, of nearly the same lengths."""
    if len(first) != len(second):
        return False
    return float(np.abs(np.subtract(first, second)).max()) < TUNED.mirrored_bones * max(first)


def _axis_scores(
    parents: Indices, points: Array, fps: float
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Score each signed axis, and return how still and how high the lowest joint is if the axis points up.

    An axis gains if the body is longest along it, if the lowest joint stands still, and if the lowest joints
    have a mirror image and the topmost one has none. It loses by travel along it.
    """
    boxes = extents(points)
    size = np.median(np.linalg.norm(boxes, axis=1))
    paired = paired_joints(parents, points).astype(float)
    lengths = np.median(boxes, axis=0) / size
    travel = np.ptp(_centres(points), axis=0) / size
    speeds = _horizontal_speeds(points, fps)
    usual_speeds = np.median(speeds, axis=(1, 2))
    scores = {}
    stillness = {}
    floors = {}
    for axis in AXES:
        index = "xyz".index(axis[-1])
        heights = points @ direction(axis)
        lowest = heights.argmin(axis=1)
        floors[axis] = float(np.median(heights.min(axis=1)))
        topmost = heights.argmax(axis=1)
        excess = lengths[index] - np.delete(lengths, index).max()
        feet_below = np.mean(paired[lowest] - paired[topmost])
        stillness[axis] = 0.0
        if usual_speeds[index] > TUNED.moving_speed * size:
            stillness[axis] = _stillness(speeds[index], usual_speeds[index], lowest)
        rising = np.clip(travel[index] - TUNED.sideways_travel, 0, 1.5)
        evidence = [2.0 * np.clip(2 * excess, -1, 1), 1.5 * stillness[axis], 1.5 * feet_below, -2.0 * rising]
        scores[axis] = float(sum(evidence))
    return scores, stillness, floors


def _horizontal_speeds(points: Array, fps: float) -> Array:
    """Return the speeds of joints across each axis, as if it were vertical, (3, F, J); 0 in a short clip."""
    if len(points) < max(0.3 * fps, 6):
        return np.zeros((3, *points.shape[:2]))
    squares = np.moveaxis(np.gradient(points, 1 / fps, axis=0) ** 2, -1, 0)
    return np.sqrt(squares[[1, 0, 0]] + squares[[2, 2, 1]])


def _stillness(speeds: Array, usual: float, lowest: Indices) -> float:
    """Return -log10 of the usual speed of the lowest joints, over that of all; at most 1.5."""
    at_lowest = np.take_along_axis(speeds, lowest[:, None], axis=1)
    return float(-np.log10(np.median(at_lowest) / usual + 0.03))
