"""Quality of a seam: foot sliding, jumps of velocity, and rotation of the knees.

The foot sliding distance is a measure of seams, motions and characters. A jump of velocity from one frame to
the next is |x_{f+1} - 2 x_f + x_{f-1}| · fps in metres per second, the RMS over the joints. Captured clips
also have such jumps, for example when a foot hits the ground. Therefore `seam_quality` compares the jumps at
a seam with the usual ones in its clips.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap._shared.arrays import Array, Mask, runs
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.concatenation import require_compatible
from mocap.body.kinematics import joint_positions
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud
from mocap.quality.limits import LIMITS


class FootSliding(NamedTuple):
    """The foot sliding distance of a joint in one footplant, from frame `start` to just before frame `stop`.

    `distance` is the joint's largest distance from its mean position on the ground, centimetres.
    """

    joint: str
    start: int
    stop: int
    distance: float


def foot_sliding(
    motion: Motion, joints: Sequence[int] | None = None, *, positions: Array | None = None
) -> list[FootSliding]:
    """Measure the foot sliding distance of each footplant, the largest from its mean position on the ground.

    Parameters
    ----------
    motion : F frames, with contacts for the joints.
    joints : the indices of joints, by default of all that have contacts.
    positions : the positions of all joints, shape (F, J, 3), metres. They are computed by default.

    Raises
    ------
    MocapError : for a joint without contacts in the motion.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> slides = foot_sliding(sample("walk_straight"))
    >>> len(slides) > 20, max(slide.distance for slide in slides) < 1e-6
    (True, True)

    Notebook: 18-motion-matching
    """
    if positions is None:
        positions = joint_positions(motion)
    ground = positions[..., [0, 2]]
    footplants = []
    for name, contacts in _contacts(motion, joints).items():
        for start, stop in runs(contacts):
            planted = ground[start:stop, motion.skeleton.index(name)]
            distances = np.linalg.norm(planted - planted.mean(axis=0), axis=-1)
            footplants.append(FootSliding(name, start, stop, 100 * float(distances.max())))
    return footplants


def mean_foot_sliding(footplants: Iterable[FootSliding]) -> float:
    """Average the foot sliding distance over footplants, cm, or 0 without any.

    Examples
    --------
    >>> footplants = [FootSliding("lfoot", 3, 9, 1.5), FootSliding("lfoot", 30, 39, 0.5)]
    >>> mean_foot_sliding(footplants), mean_foot_sliding([])
    (1.0, 0.0)
    """
    distances = [footplant.distance for footplant in footplants]
    return float(np.mean(distances)) if distances else 0.0


def sliding_per_frame(motion: Motion) -> Array:
    """Measure the foot sliding of planted joints from each frame to the next, cm.

    Parameters
    ----------
    motion : F frames, with `contacts` for the legs' ankles and balls.

    Returns
    -------
    Shape (F - 1, joints): the distance that each ankle and ball moves from each frame to the next if the
    joint is planted in both, else 0. Its sum is the foot sliding distance of all of them.

    Raises
    ------
    MocapError : if the legs cannot be found, or the feet have no contacts.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> bool(sliding_per_frame(walk).max() < 1e-6)  # in the bundled clips planted feet stand still
    True
    """
    feet = feet_of(find_legs(motion.skeleton))
    contacts = np.stack(list(_contacts(motion, feet).values()), axis=-1)
    ground = joint_positions(motion)[:, feet][..., [0, 2]]
    steps = np.linalg.norm(np.diff(ground, axis=0), axis=-1)
    return np.asarray(100 * steps * (contacts[1:] & contacts[:-1]))


def _contacts(motion: Motion, joints: Sequence[int] | None) -> dict[str, Mask]:
    """Return the contacts (F,) of joints by name, by default of all joints that have contacts."""
    names = motion.contacts if joints is None else [motion.skeleton.names[joint] for joint in joints]
    if missing := [name for name in names if name not in motion.contacts]:
        raise MocapError(f"'{motion.name}' does not say when '{missing[0]}' stands; mark_plants finds out.")
    return {name: motion.contacts[name] for name in names}


def feet_of(legs: Sequence[Leg]) -> list[int]:
    """List the legs' ankles and balls."""
    return [joint for leg in legs for joint in leg[2:]]


USUAL = 99.9  # percentile of the clips' windows: all but one window in a thousand are below

LEAP_PERCENTILE = 90  # of the frames' jumps of velocity, with which leaps in the data are compared


def jumps(motion: Motion) -> Array:
    """Compute the jump of velocity in each frame, the RMS over joints of |x_{f+1} - 2 x_f + x_{f-1}| · fps.

    Parameters
    ----------
    motion : F frames, at least three.

    Returns
    -------
    Shape (F,), m/s. The first and the last frame, which have only one neighbour, have 0.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> stop = Motion(dot, [[x, 1, 0] for x in (0, 1, 2, 2, 2)], np.tile([1.0, 0, 0, 0], (5, 1, 1)), 10.0)
    >>> jumps(stop)
    array([ 0.,  0., 10.,  0.,  0.])

    Notebook: 04-blending
    """
    if len(motion) < 3:
        raise MocapError(f"To see velocity jump takes three frames; '{motion.name}' has {len(motion)}.")
    changes = np.diff(point_cloud(motion), 2, axis=0)
    return np.pad(np.sqrt((changes**2).sum(axis=-1).mean(axis=-1)) * motion.fps, 1)


class Spread(NamedTuple):
    """The usual jumps of velocity in some clips, with which a seam between them is compared.

    `velocity`: the jump in each frame, clip by clip, m/s, NaN for leaps in the data.
    """

    velocity: tuple[Array, ...]

    def within(self, frames: int) -> Array:
        """List the largest jump of velocity in each window of `frames` frames, in ascending order.

        A seam is also a window: its largest jump is compared with the largest in other windows of its length,
        not with single frames. Windows with leaps in the data are left out. A shorter clip is one window.

        Examples
        --------
        >>> Spread((np.array([1.0, 3, 2, np.nan, 4]),)).within(2)
        array([3., 3.])
        """
        windows = [sliding_window_view(jump, min(frames, len(jump))).max(axis=-1) for jump in self.velocity]
        largest = np.concatenate(windows)
        return np.sort(largest[np.isfinite(largest)])


def spread(clips: Sequence[Motion]) -> Spread:
    """Measure the usual jumps of velocity in some clips.

    Captured clips leap if a marker was lost or mistaken for another. A jump of velocity above five times the
    90th percentile counts as such a leap. It must neither excuse a seam nor be attributed to one.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips of several skeletons or frame rates, and for no clips.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> usual = spread([sample("walk_straight")])
    >>> usual.within(40).max().round(2)  # m/s
    np.float64(0.2)

    Notebook: 04b-feet
    """
    clips = require_compatible(clips)
    velocity_jumps = [jumps(clip) for clip in clips]
    leap = LIMITS.leap * float(np.percentile(np.concatenate(velocity_jumps), LEAP_PERCENTILE))
    return Spread(tuple(np.where(of_clip > leap, np.nan, of_clip) for of_clip in velocity_jumps))


class SeamQuality(NamedTuple):
    """The quality of a seam in two numbers, both small for a good seam.

    `velocity_jump` is the largest jump of velocity at the seam, divided by the 99.9th percentile of the
    clips' windows of its length. Up to 1 it is usual. `foot_sliding` is the foot sliding distance, cm, the
    mean over the footplants that overlap the seam.
    """

    velocity_jump: float
    foot_sliding: float


def seam_quality(motion: Motion, seam: tuple[int, int], usual: Spread) -> SeamQuality:
    """Measure the quality of a seam relative to the clips that it joins.

    Parameters
    ----------
    motion : with the seam, and with contacts for the feet.
    seam : its first frame, and the first frame after it: (i, i + window) after `blending.join`.
    usual : the usual jumps in the clips, `spread(clips)`.

    Raises
    ------
    MocapError : for a seam that is not within the motion, clips that do not move, feet without contacts, and
        legs that cannot be found.

    Examples
    --------
    >>> from mocap.blending.joining import join
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> seam_quality(join(walk, 500, walk, 242, 40), (500, 540), spread([walk])).velocity_jump < 1
    True

    Notebook: 04b-feet
    """
    if not 0 <= seam[0] < seam[1] <= len(motion):
        none = f"no seam from {seam[0]} to {seam[1]}"
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, and {none}.")
    seam_jumps = jumps(motion)[max(seam[0] - 1, 0) : seam[1] + 1]
    largest = usual.within(len(seam_jumps))
    if len(largest) == 0 or not largest[-1] > 0:
        raise MocapError("The clips do not move, so nothing at a seam can be measured against them.")
    footplants = foot_sliding(motion, feet_of(find_legs(motion.skeleton)))
    touched = [slide for slide in footplants if slide.start < seam[1] and seam[0] < slide.stop]
    return SeamQuality(float(seam_jumps.max() / np.percentile(largest, USUAL)), mean_foot_sliding(touched))


def knee_rotations(motion: Motion) -> Array:
    """Measure the rotation of each knee from one frame to the next, degrees, shape (F - 1, legs).

    The lengths of a leg's rigid bones do not reveal a knee that snaps, but its rotation does.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> knee_rotations(walk).shape, bool(knee_rotations(walk).max() < 5)  # at 120 Hz
    ((1157, 2), True)

    Notebook: 09b-blend-window
    """
    knees = [leg.knee for leg in find_legs(motion.skeleton)]
    of_knees = motion.rotations[:, knees]
    return np.asarray(np.degrees(rotations.angle_between(of_knees[1:], of_knees[:-1])))
