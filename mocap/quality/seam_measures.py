"""How good is a seam? Measure it: jolts, sliding feet, feet in the floor, a root off its path."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import Leg, legs_of
from mocap.body.motion import Motion, require_alike
from mocap.errors import MocapError
from mocap.matching.point_clouds import point_cloud
from mocap.quality.standing_feet import feet_of, mean_slide, plant_slides

# Percent of the clips' own windows: all but one window in a thousand.
USUAL = 99.9

# In broken data the velocity jumps this many times as far as `MOSTLY` percent of all frames do, or further.
# At 30 Hz, in the walks, runs and jumps of CMU's subject 16, leaps jump 20 times as far, all other frames
# but one at most 3.3 times.
LEAP, MOSTLY = 5.0, 90


class Spread(NamedTuple):
    """What is usual in some clips: a seam between them is compared with it.

    `velocity` (m/s) and `acceleration` (m/s²): how far they jump in each frame, clip by clip, NaN where the
    data leap. `leap`: a larger jump of velocity is a leap, m/s. `floor`: the lowest height of each leg's
    ankle and ball, metres.
    """

    velocity: tuple[Array, ...]
    acceleration: tuple[Array, ...]
    leap: float
    floor: Array

    def within(self, frames: int) -> tuple[Array, Array]:
        """List the largest jumps of velocity and of acceleration in each window of `frames` frames, sorted.

        A seam is a window, too: its largest jump is compared with the largest in other windows of its length,
        not with single frames. Windows in which the data leap are left out; a shorter clip is one window.

        Examples
        --------
        >>> usual = Spread((np.array([1.0, 3, 2, np.nan, 4]),), (np.zeros(5),), 9.0, np.zeros(4))
        >>> usual.within(2)[0]
        array([3., 3.])
        """
        return largest_jumps(self.velocity, frames), largest_jumps(self.acceleration, frames)


def largest_jumps(kind: Sequence[Array], frames: int) -> Array:
    """List the largest jump in each window of `frames` frames of some clips, sorted; NaN counts as a leap.

    Examples
    --------
    >>> largest_jumps([np.array([1.0, 3, 2]), np.array([0.5])], 2)
    array([0.5, 3. , 3. ])
    """
    windows = [sliding_window_view(jumps, min(frames, len(jumps))).max(axis=-1) for jumps in kind]
    largest = np.concatenate(windows)
    return np.sort(largest[np.isfinite(largest)])


class SeamQuality(NamedTuple):
    """A seam in five numbers; small is good.

    `velocity_jump` and `acceleration_jump` are the largest jumps at the seam, divided by the jump that 99.9 %
    of the clips' own windows of its length stay below: up to 1 they are nothing special. The others are in
    centimetres. `slide` is how far a planted joint is from its mean place over the ground, at most in each
    plant, on average over the plants that the seam touches; `depth` how far a foot sinks below its lowest
    height in the clips; `deviation` how far the root's path over the ground is from what it was before.

    Examples
    --------
    >>> SeamQuality(0.8, 0.9, 2.5, 0.1, 0.0).slide
    2.5
    """

    velocity_jump: float
    acceleration_jump: float
    slide: float
    depth: float
    deviation: float


def jumps(motion: Motion) -> tuple[Array, Array]:
    """Measure how velocity and acceleration jump from frame to frame: the RMS over all joints.

    With positions x, |x_{f+1} - 2 x_f + x_{f-1}| · fps is the jump of velocity at frame f, and
    |x_{f+1} - 3 x_f + 3 x_{f-1} - x_{f-2}| · fps² that of acceleration just before it.

    Parameters
    ----------
    motion : F frames, at least four.

    Returns
    -------
    Velocity jumps, m/s, and acceleration jumps, m/s², shape (F,) each; 0 at the ends, where none can be
    measured.

    Examples
    --------
    >>> from mocap.body.skeleton import Skeleton
    >>> dot = Skeleton(["root"], [-1], [[0, 0, 0]])
    >>> stop = Motion(dot, [[x, 1, 0] for x in (0, 1, 2, 2, 2)], np.tile([1.0, 0, 0, 0], (5, 1, 1)), 10.0)
    >>> jumps(stop)[0]
    array([ 0.,  0., 10.,  0.,  0.])

    Notebook: 04-blending
    """
    if len(motion) < 4:
        raise MocapError(f"To see accelerations jump takes four frames; '{motion.name}' has {len(motion)}.")
    points = point_cloud(motion)
    velocity, acceleration = (
        np.sqrt((np.diff(points, order, axis=0) ** 2).sum(-1).mean(-1)) * motion.fps ** (order - 1)
        for order in (2, 3)
    )
    return np.pad(velocity, 1), np.pad(acceleration, (2, 1))


def spread(clips: Sequence[Motion], legs: Sequence[Leg] | None = None) -> Spread:
    """Measure what is usual in some clips.

    Captured clips leap where a marker was lost or mistaken for another. A jump of velocity that is five times
    as large as nine in ten frames have is such a leap: it must neither excuse a seam nor be blamed on one.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.
    legs : found by name by default.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips that do not go together, no clips, and legs that cannot be found.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> usual = spread([sample("walk_straight")])
    >>> usual.floor.round(2)  # two ankles and two balls, metres
    array([0.07, 0.03, 0.07, 0.03])

    Notebook: 04-blending
    """
    if not clips:
        raise MocapError("A seam is measured against its clips; none were given.")
    require_alike(clips)
    feet = feet_of(legs_of(clips[0].skeleton, legs))
    velocity, acceleration = (tuple(kind) for kind in zip(*map(jumps, clips), strict=True))
    leap = LEAP * float(np.percentile(np.concatenate(velocity), MOSTLY))
    leaping = [jump > leap for jump in velocity]
    # The third difference at a frame uses one more frame than the second, so it leaps there as well.
    velocity = tuple(np.where(bad, np.nan, jump) for bad, jump in zip(leaping, velocity, strict=True))
    acceleration = tuple(
        np.where(bad | np.roll(bad, 1), np.nan, jump) for bad, jump in zip(leaping, acceleration, strict=True)
    )
    floor = np.min([joint_positions(clip)[:, feet, 1].min(axis=0) for clip in clips], axis=0)
    return Spread(velocity, acceleration, leap, np.asarray(floor))


def seam_quality(
    motion: Motion,
    seam: tuple[int, int],
    usual: Spread,
    *,
    before: Motion | None = None,
    legs: Sequence[Leg] | None = None,
) -> SeamQuality:
    """Measure a seam against the clips that it joins.

    Parameters
    ----------
    motion : with the seam, and with contacts for the feet.
    seam : its first frame, and the first frame after it: (i, i + window) after `blending.join`.
    usual : what is usual in the clips, `spread(clips)`.
    before : the same frames before they were changed, by a clean-up for instance; by default the motion.
    legs : found by name by default, as for `spread`.

    Raises
    ------
    SkeletonMismatch, MocapError : for a seam that runs off the motion, a `before` that is another motion,
        clips that do not move, feet without contacts, and legs that cannot be found.

    Examples
    --------
    >>> from mocap.blending.joining import join
    >>> from mocap.datasets.generated import generate
    >>> walk = generate("walk_straight")
    >>> seam_quality(join(walk, 500, walk, 233, 40), (500, 540), spread([walk])).velocity_jump < 1
    True

    Notebook: 04-blending
    """
    before = motion if before is None else before
    feet = feet_of(legs_of(motion.skeleton, legs))
    _check_seam(motion, seam, before)
    around = slice(max(seam[0] - 1, 0), seam[1] + 1)
    usually = usual.within(len(range(len(motion))[around]))
    velocity, acceleration = (
        float(kind[around].max() / _usual(largest))
        for kind, largest in zip(jumps(motion), usually, strict=True)
    )
    path, old = (m.root_positions[around][:, [0, 2]] for m in (motion, before))
    positions = joint_positions(motion)
    slides = plant_slides(motion, feet, positions=positions)
    depth = np.maximum(usual.floor - positions[around][:, feet, 1], 0.0).max()
    return SeamQuality(
        velocity,
        acceleration,
        mean_slide(one for one in slides if one.touches(seam)),
        100 * float(depth),
        100 * float(np.linalg.norm(path - old, axis=-1).max()),
    )


def _usual(largest: Array) -> float:
    """Give the jump that all but one window in a thousand stay below."""
    if len(largest) == 0 or not largest[-1] > 0:
        raise MocapError("The clips do not move, so nothing at a seam can be measured against them.")
    return float(np.percentile(largest, USUAL))


def _check_seam(motion: Motion, seam: tuple[int, int], before: Motion) -> None:
    """Raise an error unless the seam is in the motion, and `before` is the same motion."""
    if not 0 <= seam[0] < seam[1] <= len(motion):
        raise MocapError(
            f"'{motion.name}' has {len(motion)} frames, and no seam from {seam[0]} to {seam[1]}."
        )
    require_alike([motion, before])
    if len(before) != len(motion):
        raise MocapError(f"Before there were {len(before)} frames, now {len(motion)}: not the same motion.")
