"""The centre of mass of a body, and the acceleration with which it falls in a flight.

In the air only gravity accelerates the centre of mass. Therefore its height is a parabola, with -g/2 as the
coefficient of t². A body in a clip whose heights were changed, but not its times, falls with another g: it
looks heavy or floating.
"""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError

Part = tuple[str, str, float, float]
"""The upper and the lower joint of a body segment, its fraction of the body's mass, and the position of its
centre of mass as a fraction of the line from the upper joint to the lower one."""


_SIDED: tuple[Part, ...] = (
    ("femur", "humerus", 0.497 / 2, 0.5),  # the trunk, from the hips to the shoulders
    ("femur", "tibia", 0.100, 0.433),
    ("tibia", "foot", 0.0465, 0.433),
    ("foot", "toes", 0.0145, 0.5),
    ("humerus", "radius", 0.028, 0.436),
    ("radius", "wrist", 0.016, 0.430),
    ("wrist", "fingers", 0.006, 0.506),
)


def _of_side(part: Part, side: str) -> Part:
    """Return a part of the left side, "l", or the right side, "r"."""
    above, below, mass, centre = part
    return side + above, side + below, mass, centre


SEGMENTS: tuple[Part, ...] = (
    *(_of_side(part, side) for part in _SIDED for side in "lr"),
    ("head", "head_end", 0.081, 0.5),  # with the neck
)
"""The segments of CMU's skeletons, with the masses of [Winter09, Table 4.1] (after Dempster)."""


def centre_of_mass(motion: Motion, segments: Sequence[Part] = SEGMENTS) -> Array:
    """Compute the centre of mass of a body from its segments, Σ m p / Σ m.

    Parameters
    ----------
    motion : F frames.
    segments : the body's segments, by default those of CMU's skeletons and the bundled clips.

    Returns
    -------
    Shape (F, 3), metres.

    Raises
    ------
    MocapError : for a segment whose joints the skeleton lacks.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> float(centre_of_mass(sample("walk_straight")[:1])[0, 1].round(2))
    0.98

    Notebook: 11-warping
    """
    weights = np.zeros(len(motion.skeleton))
    for above, below, mass, centre in segments:
        weights[motion.skeleton.index(above)] += mass * (1 - centre)
        weights[motion.skeleton.index(below)] += mass * centre
    return np.asarray(np.einsum("j,fjk->fk", weights / weights.sum(), joint_positions(motion)))


def gravity(motion: Motion, first: int, last: int, segments: Sequence[Part] = SEGMENTS) -> float:
    """Estimate the gravitational acceleration in a flight, by a parabola through the centre of mass.

    Parameters
    ----------
    motion : F frames.
    first, last : the first and the last frame of a flight, a few frames away from take-off and landing, in
        which the feet still push.
    segments : see `centre_of_mass`.

    Returns
    -------
    g, m/s²: 9.81 for a body that falls freely.

    Raises
    ------
    MocapError : for frames outside the clip, or fewer than four of them.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> abs(gravity(walk, 0, 60)) < 2  # a walk does not fall
    True

    Notebook: 11-warping
    """
    if not 0 <= first <= last < len(motion) or last - first < 3:
        got = f"'{motion.name}', which has {len(motion)}; got {first} to {last}"
        raise MocapError(f"A fall is fitted to four frames or more of {got}.")
    heights = centre_of_mass(motion[first : last + 1], segments)[:, 1]
    seconds = np.arange(len(heights)) / motion.fps
    return float(-2 * np.polyfit(seconds, heights, 2)[0])
