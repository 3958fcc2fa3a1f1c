"""Two-bone inverse kinematics: from where a limb must end to how its bones turn, in closed form.

In its rest pose the limb hangs straight down: both bones along -y of their frames, the hinge along +x. So
bending turns the lower bone backwards, as a knee does.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.errors import MocapError


class TwoBone(NamedTuple):
    """A limb's pose: `middle` and `end` (..., 3) in metres, and the bones' global rotations (..., 4).

    Where `reached` (...) is False, the target is too far or too near; the limb still points at it.

    Examples
    --------
    >>> two_bone([0, 1, 0], [0, -2, 0], (0.5, 0.5), [0, 0, 1])._asdict()["reached"].tolist()
    False
    """

    middle: Array
    end: Array
    upper: Array
    lower: Array
    reached: NDArray[np.bool_]


def two_bone(start: ArrayLike, target: ArrayLike, lengths: tuple[float, float], bend: ArrayLike) -> TwoBone:
    """Bend a limb of two bones so that its end meets a target.

    With bones a and b and the target at distance d, the law of cosines gives the angle at the start,
    cos α = (a² + d² - b²) / (2 a d); the plane of the bend is the one that holds the target and `bend`.

    Parameters
    ----------
    start : shape (..., 3), metres: the hip.
    target : shape (..., 3), metres: where the ankle must be.
    lengths : of the upper and the lower bone, metres.
    bend : shape (..., 3): the direction the middle joint points to; forwards for a knee.

    Returns
    -------
    A `TwoBone`; its end is the target where `reached` is True.

    Raises
    ------
    MocapError : if a length is not above 0, the target is at the start, or `bend` points along the limb.

    Examples
    --------
    >>> leg = two_bone([0, 1, 0], [0, 0.2, 0], (0.5, 0.5), [0, 0, 1])
    >>> leg.middle.round(6), bool(leg.reached)
    (array([0. , 0.6, 0.3]), True)
    """
    upper, lower = lengths
    if not min(lengths) > 0:
        raise MocapError(f"Both bones need a length above 0, got {upper} and {lower}.")
    start, target, bend = np.broadcast_arrays(*(np.asarray(v, float) for v in (start, target, bend)))
    reach = np.linalg.norm(target - start, axis=-1, keepdims=True)
    if not np.all(reach > 1e-9):
        raise MocapError("A limb cannot end where it starts: move the target off the start.")
    along = (target - start) / reach
    across = bend - (bend * along).sum(-1, keepdims=True) * along
    width = np.linalg.norm(across, axis=-1, keepdims=True)
    if not np.all(width > 1e-9):
        raise MocapError("The bend points along the limb: it does not say which way the middle joint goes.")
    across = across / width
    length = np.clip(reach, abs(upper - lower), upper + lower)
    cosine = np.clip((upper**2 + length**2 - lower**2) / (2 * upper * length), -1, 1)
    middle = start + upper * (cosine * along + np.sqrt(1 - cosine**2) * across)
    end = start + length * along
    hinge = np.cross(across, along)
    down = -np.stack([(middle - start) / upper, (end - middle) / lower])
    hinge = np.broadcast_to(hinge, down.shape)
    thigh, shank = rotations.from_matrix(np.stack([hinge, down, np.cross(hinge, down)], axis=-1))
    return TwoBone(middle, end, thigh, shank, np.abs(reach - length)[..., 0] < 1e-9)
