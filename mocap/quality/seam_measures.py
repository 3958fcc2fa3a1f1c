"""How good is a seam? Measure it: jolts, sliding feet, and knees that turn.

A jolt is the change of velocity from one frame to the next, |x_{f+1} - 2 x_f + x_{f-1}| · fps in metres per
second, the RMS over the joints. Clips have jolts of their own: a foot that touches the ground stops. So
`seam_quality` compares those of a seam with what is usual in its clips.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.limbs import find_legs
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


def jumps(motion: Motion) -> Array:
    """Measure how velocity jumps at each frame: the RMS over all joints of |x_{f+1} - 2 x_f + x_{f-1}| · fps.

    Parameters
    ----------
    motion : F frames, at least three.

    Returns
    -------
    Shape (F,), m/s; 0 at both ends, where none can be measured.

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
    """What is usual in some clips: a seam between them is compared with it.

    `velocity`: how far velocity jumps in each frame, clip by clip, m/s; NaN where the data leap.
    """

    velocity: tuple[Array, ...]

    def within(self, frames: int) -> Array:
        """List the largest jump of velocity in each window of `frames` frames, sorted.

        A seam is a window, too: its largest jump is compared with the largest in other windows of its length,
        not with single frames. Windows in which the data leap are left out; a shorter clip is one window.

        Examples
        --------
        >>> Spread((np.array([1.0, 3, 2, np.nan, 4]),)).within(2)
        array([3., 3.])
        """
        windows = [sliding_window_view(jump, min(frames, len(jump))).max(axis=-1) for jump in self.velocity]
        largest = np.concatenate(windows)
        return np.sort(largest[np.isfinite(largest)])


def spread(clips: Sequence[Motion]) -> Spread:
    """Measure what is usual in some clips.

    Captured clips leap where a marker was lost or mistaken for another. A jump of velocity that is five times
    as large as nine in ten frames have is such a leap: it must neither excuse a seam nor be blamed on one.

    Parameters
    ----------
    clips : motions of one skeleton and one frame rate.

    Raises
    ------
    SkeletonMismatch, MocapError : for clips that do not go together, and no clips.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> usual = spread([sample("walk_straight")])
    >>> usual.within(40).max().round(2)  # m/s
    np.float64(0.17)

    Notebook: 04b-feet
    """
    clips = require_alike(clips)
    found = [jumps(clip) for clip in clips]
    leap = LEAP * float(np.percentile(np.concatenate(found), MOSTLY))
    return Spread(tuple(np.where(jump > leap, np.nan, jump) for jump in found))


class SeamQuality(NamedTuple):
    """A seam in two numbers; small is good.

    `velocity_jump` is the largest jump of velocity at the seam, divided by the jump that 99.9 % of the clips'
    own windows of its length stay below: up to 1 it is nothing special. `slide` is how far a planted joint is
    from its mean place over the ground, cm: at most in each plant, on average over the plants that the seam
    touches.
    """

    velocity_jump: float
    slide: float


def seam_quality(motion: Motion, seam: tuple[int, int], usual: Spread) -> SeamQuality:
    """Measure a seam against the clips that it joins.

    Parameters
    ----------
    motion : with the seam, and with contacts for the feet.
    seam : its first frame, and the first frame after it: (i, i + window) after `blending.join`.
    usual : what is usual in the clips, `spread(clips)`.

    Raises
    ------
    MocapError : for a seam that runs off the motion, clips that do not move, feet without contacts, and legs
        that cannot be found.

    Examples
    --------
    >>> from mocap.blending.joining import join
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> seam_quality(join(walk, 500, walk, 233, 40), (500, 540), spread([walk])).velocity_jump < 1
    True

    Notebook: 04b-feet
    """
    if not 0 <= seam[0] < seam[1] <= len(motion):
        none = f"no seam from {seam[0]} to {seam[1]}"
        raise MocapError(f"'{motion.name}' has {len(motion)} frames, and {none}.")
    found = jumps(motion)[max(seam[0] - 1, 0) : seam[1] + 1]
    largest = usual.within(len(found))
    if len(largest) == 0 or not largest[-1] > 0:
        raise MocapError("The clips do not move, so nothing at a seam can be measured against them.")
    slides = plant_slides(motion, feet_of(find_legs(motion.skeleton)))
    touched = [slide for slide in slides if slide.start < seam[1] and seam[0] < slide.stop]
    return SeamQuality(float(found.max() / np.percentile(largest, USUAL)), mean_slide(touched))


def knee_turns(motion: Motion) -> Array:
    """Measure how far each knee turns from one frame to the next, degrees, shape (F - 1, legs).

    A leg's bones are rigid, so its length says nothing about a knee that snaps; how fast the knee turns does.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = sample("walk_straight")
    >>> knee_turns(walk).shape, bool(knee_turns(walk).max() < 5)  # at 120 Hz
    ((1200, 2), True)

    Notebook: 09b-blend-window
    """
    knees = [leg.knee for leg in find_legs(motion.skeleton)]
    turned = motion.rotations[:, knees]
    return np.asarray(np.degrees(rotations.angle_between(turned[1:], turned[:-1])))
