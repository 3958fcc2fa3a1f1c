"""Heights of ankles and balls above the floor while they stand."""

from collections.abc import Iterable, Mapping
from contextlib import suppress

import numpy as np

from mocap.body.kinematics import joint_positions
from mocap.body.limbs import FEET, SIDES
from mocap.body.motion import Motion
from mocap.editing.pins import with_plants
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, shortened, warn


def heights_of_body(motion: Motion, joints: Mapping[str, int], clips: Iterable[Motion]) -> dict[str, float]:
    """Return the heights of standing feet: of a motion, or else of clips of its body, or else by its balls.

    Parameters
    ----------
    motion : with footplants.
    joints : the roles of its joints.
    clips : other motions of the same body.

    Raises
    ------
    MocapError : if no ball ever stands.

    Warns
    -----
    MocapWarning : if the heights are estimated from the balls alone.
    """
    try:
        return standing_heights(motion, joints)
    except MocapError as error:
        for clip in clips:
            if clip.skeleton == motion.skeleton and not is_pose(clip):
                with suppress(MocapError):
                    return standing_heights(with_plants(clip), joints)
        heights = heights_from_balls(motion, joints)
        warn(f"{error} Heights are estimated from the balls alone.")
        return heights


def is_pose(motion: Motion) -> bool:
    """Return whether a motion is so short that feet that stand and feet that swing look the same.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> is_pose(walk[:2]), is_pose(walk[:13])
    (True, False)
    """
    return len(motion) <= TUNED.pose_frames or motion.duration < TUNED.pose_seconds


def standing_heights(motion: Motion, joints: Mapping[str, int]) -> dict[str, float]:
    """Compute the median heights of ankles and balls of flat feet, or else of planted ones: {role: metres}.

    Parameters
    ----------
    motion : on a floor at y = 0, with `contacts` of ankles and balls.
    joints : the roles of its joints.

    Raises
    ------
    MocapError : for an ankle or a ball that never stands.
    """
    down = {role: motion.contacts[motion.skeleton.names[joints[role]]] for role in FEET}
    positions = joint_positions(motion)
    heights = {}
    for role in FEET:
        side = role.split()[0]
        flat = down[f"{side} ankle"] & down[f"{side} ball"]
        frames = flat if flat.any() else down[role]
        if not frames.any():
            raise MocapError(f"In '{motion.name}' the {role} never stands: give the stance of another clip.")
        heights[role] = float(np.median(positions[frames, joints[role], 1]))
    return heights


def heights_from_balls(motion: Motion, joints: Mapping[str, int]) -> dict[str, float]:
    """Estimate the heights of standing ankles and balls from balls alone: {role: metres}.

    In a run, heels may never stand. The height of an ankle above its ball is then the lower quartile over the
    frames in which the ball stands. If the ball of one side never stands, both sides have the heights of the
    other.

    Parameters
    ----------
    motion : on a floor at y = 0, with `contacts` of balls.
    joints : the roles of its joints.

    Raises
    ------
    MocapError : if no ball ever stands.

    Examples
    --------
    >>> from mocap.body.limbs import roles
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> heights = heights_from_balls(walk, roles(walk.skeleton))
    >>> round(heights["left ball"], 3), round(heights["left ankle"], 3)
    (0.026, 0.068)
    """
    positions = joint_positions(motion)
    plants = {side: motion.contacts[motion.skeleton.names[joints[f"{side} ball"]]] for side in SIDES}
    if not any(plant.any() for plant in plants.values()):
        name = shortened(motion.name)
        raise MocapError(f"In '{name}' no foot ever stands: give the stance of another clip.")
    heights: dict[str, float] = {}
    for side, opposite in (SIDES, SIDES[::-1]):
        standing = side if plants[side].any() else opposite
        frames = plants[standing]
        ball = positions[frames, joints[f"{standing} ball"], 1]
        rises = positions[frames, joints[f"{standing} ankle"], 1] - ball
        heights[f"{side} ball"] = float(np.median(ball))
        rise = float(np.percentile(rises, TUNED.run_percentile))
        heights[f"{side} ankle"] = heights[f"{side} ball"] + rise
    return heights
