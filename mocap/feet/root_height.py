"""How far the root rises or falls so that planted feet change the knees little: step 3 of [KSG02]."""

from collections.abc import Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from mocap._shared.arrays import Array
from mocap.feet.ankle_targets import FADE, FootTarget
from mocap.feet.leg_track import LegTrack

# Metres: a plant that would move the root further is let go. With 0.01 6 % of the planted frames of skating
# clips are let go; with 0.04 runs keep 98 % instead of 93 %, but their root moves by up to 3.2 cm.
MOST = 0.02

# Radians: 5°. A knee that is bent less counts as bent by this, or 1 / sin² φ would let one straight leg
# decide alone. Half or twice as much changes the root's rise by 1 to 4 %.
STRAIGHT = np.radians(5.0)

# The cost of a metre of rise, where a knee's turn by a radian in a leg of a metre costs 1, both squared.
# With 1.5 the root of skating clips moves by 3.3 mm instead of 2.9 (rms), with 6 by 2.4 mm. With 1 they
# lose 0.3 % of their planted frames.
HEAVY = 3.0


def root_rise(tracks: Sequence[LegTrack], targets: Sequence[FootTarget]) -> Array:
    """Raise or lower the root so that the knees change little and both legs reach their targets.

    In the paper: [KSG02, step 3].

    A rise h makes the leg from a hip to its target d + g h long, where g is the upright share of its
    direction. A knee bent by φ turns by as much as the length changes, over sin φ. Least squares over the
    legs and the rise itself, Σ ((d + g h - d_before) / sin φ)² + 3 h², has the solution below.

    Parameters
    ----------
    tracks : the legs in F frames.
    targets : where each one's ankle must be.

    Returns
    -------
    Metres, shape (F,), below 0 where the root falls.
    """
    frames = len(targets[0].ankle)
    above, below = np.zeros(frames), np.full(frames, HEAVY)
    limit = np.full(frames, np.inf)
    for track, target in zip(tracks, targets, strict=True):
        apart = track.hip - target.ankle
        distance = np.linalg.norm(apart, axis=-1)
        upright = apart[:, 1] / distance
        stiffness = 1 / (np.sin(track.straight) ** 2 + np.sin(STRAIGHT) ** 2)
        above += stiffness * upright * (track.distance - distance)
        below += stiffness * upright**2
        limit = np.minimum(limit, track.highest(target.ankle, track.limit))
    rise = above / below
    radius = max(1, round(FADE * tracks[0].motion.fps))
    # The maximum is as wide as the bell that smooths it: so no frame keeps more than its limit.
    excess = maximum_filter1d(np.maximum(rise - limit, 0.0), 2 * radius + 1)
    return np.asarray(rise - gaussian_filter1d(excess, radius / 2, radius=radius))
