"""Bring a leg's ankle to another place, and change the leg as little as that allows: step 4 of [KSG02].

`two_bone_ik` poses a limb from nothing; here there is a pose to begin with. The knee, a hinge, turns until
hip and ankle are as far apart as they must be. Then the whole leg swings at the hip.
"""

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.errors import MocapError
from mocap.feet.leg_track import ROUNDING, LegTrack


def bend_and_swing(track: LegTrack, wanted: Array) -> tuple[Array, Array]:
    """Turn a shank about its knee, then the whole leg about its hip, so that its ankle comes where wanted.

    Parameters
    ----------
    track : the leg in F frames.
    wanted : from the hip to where the ankle must be, (F, 3), metres; out of reach, the leg points there.

    Returns
    -------
    The two rotations in the world's frame, (F, 4) each.
    """
    hinge, (thigh, shank) = track.hinge, track.bones
    distance = np.minimum(np.linalg.norm(wanted, axis=-1), hinge.reach)
    bend = rotations.from_rotvec(hinge.turn(distance)[:, None] * hinge.axis)
    return bend, rotations.between(thigh + rotations.rotate(bend, shank), wanted)


def pose_leg(track: LegTrack, ankle: Array, turn: ArrayLike) -> Array:
    """Pose a leg so that its ankle is where it must be, and its foot turned [KSG02, step 4].

    Parameters
    ----------
    track : the leg in F frames, its root where it must be.
    ankle : shape (F, 3), metres: where the ankle must be.
    turn : shape (F, 3), rotation vectors in the world's frame: how the foot is turned beyond what it was.

    Returns
    -------
    The rotations of hip, knee and ankle relative to their parents, shape (F, 3, 4).

    Raises
    ------
    MocapError : for an ankle that is out of the leg's reach.
    """
    motion, leg, hinge = track.motion, track.leg, track.hinge
    wanted = ankle - track.hip
    distance = np.linalg.norm(wanted, axis=-1)
    if np.any(far := distance > hinge.reach + ROUNDING):
        frame = int(far.argmax())
        raise MocapError(
            f"'{motion.name}', frame {frame}: '{track.names[2]}' would have to be "
            f"{100 * (distance - hinge.reach)[frame]:.2g} cm out of its leg's reach; are its contacts true?"
        )
    bend, swing = bend_and_swing(track, wanted)
    # In the world, each joint turns by what its parent does not turn it already.
    carried = rotations.multiply(swing, bend)
    sole = rotations.multiply(rotations.inverse(carried), rotations.from_rotvec(turn))
    posed = []
    above = (motion.skeleton.parents[leg.hip], leg.hip, leg.knee)
    for parent, joint, more in zip(above, leg[:3], (swing, bend, sole), strict=True):
        # The same turn, seen from the parent's frame, comes on top of the joint's own rotation.
        above_it = rotations.from_matrix(track.poses.matrices[:, parent])
        local = rotations.multiply(rotations.multiply(rotations.inverse(above_it), more), above_it)
        posed.append(rotations.multiply(local, motion.rotations[:, joint]))
    return np.stack(posed, axis=1)
