"""A single pose, made by dragging joints to positions."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from mocap.body.motion import Motion
from mocap.editing.bodies import priced
from mocap.editing.constraint_checks import require_reachable, warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins, pin, plant_pins
from mocap.editing.poses import MotionOrPoses, Poses, poses_of
from mocap.editing.solver import solve_stages
from mocap.editing.stages import Stage
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError


def posed(motion: Motion, frame: int, places: Mapping[str, ArrayLike], *, feet: bool = True) -> Motion:
    """Drag joints to positions in one frame; the rest of the body follows with the smallest change.

    [WP95] let an animator set a pose's angles. Here joints are dragged, and the solver rotates the joints
    above them [ours].

    Parameters
    ----------
    motion : F frames; the whole clip shows which joints rotate, and which are hinges.
    frame : its number.
    places : {joint: (x, y, z)}, metres; NaN leaves an axis free.
    feet : whether feet that stand in this frame stay where they are; needs the motion's `contacts`.

    Returns
    -------
    The pose: a motion of one frame, for a `Key`.

    Raises
    ------
    MocapError : for a frame or joints that are not there, positions out of reach, and missing contacts.

    Warns
    -----
    MocapWarning : for positions that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> hand = joint_positions(walk[100:101])[0, walk.skeleton.index("lhand")]
    >>> pose = posed(walk, 100, {"lhand": hand + [0, 0.2, 0]})
    >>> float((joint_positions(pose)[0, walk.skeleton.index("lhand")] - hand).round(4)[1])
    0.2

    Notebook: 11-warping
    """
    poses = poses_of(motion)
    plants = plant_pins(poses) if feet else Pins((), *np.zeros((2, len(motion), 0, 3)))
    return posed_with(poses, frame, places, plants)


def posed_with(motion: MotionOrPoses, frame: int, places: Mapping[str, ArrayLike], plants: Pins) -> Motion:
    """Drag joints to positions in one frame, as `posed`, with feet where `plants` hold them."""
    poses = poses_of(motion)
    clip = poses.motion
    if not 0 <= frame < len(clip):
        raise MocapError(f"'{clip.name}' has {len(clip)} frames, none with number {frame}.")
    pins = plants.limited_to([frame])
    for joint, place in places.items():
        is_free = np.isnan(place)
        low = np.where(is_free, -np.inf, place)
        high = np.where(is_free, np.inf, place)
        pins = join_pins(pins, pin(clip, joint, [frame], low, high))
    require_reachable(clip, pins)
    body = priced(poses, pins.movers(clip.skeleton), TUNED.pose_trunk, TUNED.pose_neck)
    stage = Stage(weight=TUNED.pose_weight, damping=TUNED.pose_damping, passes=TUNED.pose_passes)
    pose = poses[frame : frame + 1]
    named = Poses(replace(pose.motion, name=f"{clip.name}[{frame}]"), pose.positions, pose.matrices)
    solved = solve_stages(named, pins[[frame]], [stage], body)
    warn_of_errors(named.motion, pins.indices, solved.errors)
    return replace(solved.motion, name=clip.name)
