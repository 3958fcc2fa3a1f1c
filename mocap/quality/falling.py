"""Does a body fall as bodies fall? Its centre of mass, and the gravity that a flight shows.

In the air nothing but gravity moves the centre of mass, so its height is a parabola with -g/2 in front of t².
A clip whose height was changed, but not its time, falls with another g, and looks heavy or floating.
"""

from collections.abc import Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.errors import MocapError

Part = tuple[str, str, float, float]
"""Two joints, one above the other, a share of the body's mass, and at which share of the way down it sits."""


_SIDED: tuple[Part, ...] = (
    ("femur", "humerus", 0.497 / 2, 0.5),  # the trunk, from the hips to the shoulders
    ("femur", "tibia", 0.100, 0.433),
    ("tibia", "foot", 0.0465, 0.433),
    ("foot", "toes", 0.0145, 0.5),
    ("humerus", "radius", 0.028, 0.436),
    ("radius", "wrist", 0.016, 0.430),
    ("wrist", "fingers", 0.006, 0.506),
)
SEGMENTS: tuple[Part, ...] = (
    *((side + above, side + below, mass, at) for above, below, mass, at in _SIDED for side in "lr"),
    ("head", "head_end", 0.081, 0.5),  # with the neck
)
"""The body's masses by [Winter09], Table 4.1, after Dempster; the joints are those of CMU's skeletons."""


def centre_of_mass(motion: Motion, segments: Sequence[Part] = SEGMENTS) -> Array:
    """Weigh the body's parts: where its centre of mass is, Σ m p / Σ m.

    Parameters
    ----------
    motion : F frames.
    segments : the body's parts; those of CMU's skeletons and the bundled clips by default.

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
    for above, below, mass, at in segments:
        weights[motion.skeleton.index(above)] += mass * (1 - at)
        weights[motion.skeleton.index(below)] += mass * at
    return np.asarray(np.einsum("j,fjk->fk", weights / weights.sum(), joint_positions(motion)))


def gravity(motion: Motion, first: int, last: int, segments: Sequence[Part] = SEGMENTS) -> float:
    """Fit a parabola to the height of the centre of mass in the air: how fast it falls.

    Parameters
    ----------
    motion : F frames.
    first, last : the first and the last frame of a flight, a few frames away from take-off and landing, where
        the feet still push.
    segments : see `centre_of_mass`.

    Returns
    -------
    g, m/s²: 9.81 for a body that falls freely.

    Raises
    ------
    MocapError : for frames that are not on the clip, or fewer than four of them.

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
