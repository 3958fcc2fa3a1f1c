"""What a frame is like, in 27 numbers: the feet, the hips, and the way ahead, as the body sees them.

The body's frame is the root's ground track and heading, smoothed so that the sway of a step does not count as
turning. All numbers are seen from there: x to the body's left, y up, z ahead.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mocap._shared.arrays import Array, Points
from mocap.body.kinematics import joint_positions, velocities
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import heading, on_ground

AHEAD = np.array([1 / 3, 2 / 3, 1.0])  # seconds: Holden's 20, 40 and 60 frames at 60 Hz
SMOOTH = 0.2  # seconds, the standard deviation of a Gaussian; without it 27 % more cuts on CMU 16's walks
GROUPS = {
    "feet": slice(0, 6),
    "foot velocities": slice(6, 12),
    "hip velocity": slice(12, 15),
    "places ahead": slice(15, 21),
    "directions ahead": slice(21, 27),
}
FUTURE = slice(15, 27)  # places and directions ahead


def body_track(motion: Motion) -> tuple[Points, Array]:
    """Follow the body over the ground, without the sway of its steps: places z + ix and headings, (F,).

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> ground, facing = body_track(sample("walk_straight"))
    >>> ground.shape
    (1201,)
    """
    ground = on_ground(motion.root_positions)
    facing = np.unwrap(heading(motion.rotations[:, 0]))
    rows = np.stack([ground.real, ground.imag, facing])
    ahead, left, facing = gaussian_filter1d(rows, SMOOTH * motion.fps, mode="nearest")
    return ahead + 1j * left, facing


def features(motion: Motion) -> Array:
    """Describe each frame by 27 numbers [Hol20]: what the body does, and where it will be.

    Both ankles' places (6) and velocities (6), the hips' velocity (3), where the body will be after 1/3, 2/3
    and 1 s (6), and which way it will face then (6). A clip's last second looks ahead to the last frame.

    Parameters
    ----------
    motion : F frames, two legs that `body.find_legs` knows.

    Returns
    -------
    Shape (F, 27), metres, metres per second and shares of 1, in the order of `GROUPS`.

    Raises
    ------
    MocapError : for a skeleton whose legs are not found.

    Examples
    --------
    >>> from mocap.datasets.samples import sample
    >>> walk = features(sample("walk_straight"))
    >>> walk.shape, walk[100, 20].round(1)  # after one second she is 1 m ahead
    ((1201, 27), np.float64(1.0))

    Notebook: 18-motion-matching
    """
    (ground, facing), positions = body_track(motion), joint_positions(motion)
    speeds, back = velocities(positions, motion.fps), np.exp(-1j * facing)
    ankles = [leg.ankle for leg in find_legs(motion.skeleton)]
    columns = [_seen(positions[:, ankle], back, ground) for ankle in ankles]
    columns += [_seen(speeds[:, joint], back) for joint in (*ankles, 0)]
    frames = np.arange(len(motion))[:, None]
    then = np.minimum(frames + np.round(AHEAD * motion.fps).astype(int), len(motion) - 1)
    way = (ground[then] - ground[:, None]) * back[:, None]
    turned = np.exp(1j * (facing[then] - facing[:, None]))
    return np.hstack([*columns, ahead_columns(way), ahead_columns(turned)])


def ahead_columns(ahead: Points) -> Array:
    """Write complex numbers z + ix, (..., 3) of them, as the six columns (x, z, x, z, x, z).

    Notebook: 18-motion-matching
    """
    return np.stack([ahead.imag, ahead.real], axis=-1).reshape(*ahead.shape[:-1], -1)


def _seen(vectors: Array, back: Points, origin: Points | float = 0.0) -> Array:
    """See vectors (F, 3) from the body, which is turned back: to its left, up, ahead."""
    seen = (on_ground(vectors) - origin) * back
    return np.stack([seen.imag, vectors[:, 1], seen.real], axis=-1)
