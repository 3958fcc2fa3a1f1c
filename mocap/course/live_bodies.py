"""Small experiments on rotations and bodies that run on the pages of the course without Python.

Each function computes what one experiment shows, and each name that ends in `_data` is what its page is
filled with. `live.js` computes the same numbers, and draws them.
"""

from typing import Any

import numpy as np

from mocap import plain, resample
from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.euler import from_euler
from mocap.body.kinematics import joint_positions
from mocap.body.limbs import find_legs
from mocap.body.motion import Motion
from mocap.body.planar import PlanarTransform
from mocap.body.skeleton import Skeleton
from mocap.datasets.samples import sample
from mocap.matching.point_clouds import distinct_joints

HIP = 0.95  # metres above the ground
FORWARD = np.array([0, 0.3, 1])  # the direction in which a knee bends
FIRST = np.radians([20, -60, -70])  # Euler angles z, x and y of a bone
LAST = np.radians([-60, 50, 75])
POSE = 20  # the frame of the straight walk that is placed joint by joint
ORDERS = ("ZXY", "ZYX", "XYZ", "XZY", "YXZ", "YZX")  # of Euler angles; the first one is right


def placed(joint: float) -> dict[str, Any]:
    """Return the places of a pose's joints, metres, from the root to a joint, by forward kinematics.

    Examples
    --------
    >>> placed(joint=1)["message"]
    'joint 1, lhipjoint: its parent is 0, root'
    """
    skeleton, pose = _pose()
    number = int(joint)
    parent = int(skeleton.parents[number])
    whose = f"its parent is {parent}, {skeleton.names[parent]}" if number else "it has no parent"
    message = f"joint {number}, {skeleton.names[number]}: {whose}"
    return {"places": plain.joint_positions(pose)[0][: number + 1], "message": message}


def wrong_order(angle: float) -> dict[str, Any]:
    """Return the angle by which a rotation is off, degrees, if its Euler angles are read in a wrong order.

    All three angles are equal.

    Returns
    -------
    The angle for the worst and for the best of the five wrong orders.

    Examples
    --------
    >>> round(wrong_order(angle=40)["worst"])
    45
    """
    angles = np.radians([angle] * 3)
    right, *wrong = [from_euler(order, angles) for order in ORDERS]
    errors = [np.degrees(rotations.angle_between(right, rotation)) for rotation in wrong]
    return {"worst": max(errors), "best": min(errors)}


def turn(degrees: float) -> dict[str, Any]:
    """Return the best shift (x, z) of a window that is turned by an angle, metres, and its RMS distance, cm.

    Examples
    --------
    >>> round(turn(degrees=87)["distance"]), round(turn(degrees=-93)["distance"])
    (2, 47)
    """
    first, second = _windows_to_align()
    p, q = (positions.reshape(-1, 3) for positions in (first, second))
    turned = PlanarTransform(np.radians(degrees), 0.0, 0.0).apply_points(q)
    x, _, z = p.mean(0) - turned.mean(0)
    residuals = p - turned - [x, 0, z]
    return {"shift": [x, z], "distance": 100 * np.sqrt((residuals**2).sum(axis=1).mean())}


def lean(tip: float, towards: float, facing: float) -> dict[str, Any]:
    """Return the heading of a body that is tipped, by two formulas, degrees.

    Parameters
    ----------
    tip : the angle by which it is tipped, degrees.
    towards : the heading of the axis of tipping, degrees, from the x axis.
    facing : the heading before, degrees.

    Examples
    --------
    >>> upright = lean(tip=0, towards=0, facing=30)
    >>> round(upright["heading"]), round(upright["homework"])
    (30, 30)
    """
    axis = rotations.rotate(rotations.about_y(np.radians(towards)), [1.0, 0.0, 0.0])
    tipped = rotations.from_rotvec(np.radians(tip) * axis)
    root = rotations.multiply(rotations.about_y(np.radians(facing)), tipped)
    w, _, y, _ = root
    matrix = rotations.to_matrix(root)
    heading = np.degrees(np.arctan2(2 * w * y, w**2 - y**2))
    homework = np.degrees(np.arctan2(-matrix[2, 0], matrix[0, 0]))
    return {"root": root, "heading": heading, "homework": homework}


def gimbals(z: float, x: float, y: float) -> dict[str, Any]:
    """Return the angle between the rotations (0, x, 0) and (z, x, y), Euler angles in degrees.

    Examples
    --------
    >>> round(gimbals(z=0, x=40, y=30)["turned"])
    30
    """
    ghost = from_euler("ZXY", np.radians([0, x, 0]))
    solid = from_euler("ZXY", np.radians([z, x, y]))
    about_z = from_euler("ZXY", np.radians([z, 0, 0]))
    about_zx = from_euler("ZXY", np.radians([z, x, 0]))
    axes = [rotations.rotate(about_z, [1.0, 0.0, 0.0]), rotations.rotate(about_zx, [0.0, 1.0, 0.0])]
    turned = np.degrees(rotations.angle_between(ghost, solid))
    return {"ghost": ghost, "solid": solid, "carried": [[0.0, 0.0, 1.0], *axes], "turned": turned}


def interpolations(fraction: float) -> dict[str, Any]:
    """Return a bone's tip and the angle from its start for slerp, quaternions on a line and Euler angles.

    Examples
    --------
    >>> [round(angle) for angle in interpolations(0)["turned"]]
    [0, 0, 0]
    """
    start = from_euler("ZXY", FIRST)
    end = from_euler("ZXY", LAST)
    line = (1 - fraction) * start + fraction * end
    euler = from_euler("ZXY", (1 - fraction) * FIRST + fraction * LAST)
    between = [plain.slerp(start, end, fraction), line / np.linalg.norm(line), euler]
    tips = [rotations.rotate(rotation, [0.0, 0.0, 1.0]) for rotation in between]
    turned = [np.degrees(rotations.angle_between(start, rotation)) for rotation in between]
    return {"tips": tips, "turned": turned}


def leg(ahead: float, height: float) -> dict[str, Any]:
    """Return knee and ankle (z, y) of a leg that reaches for a point, metres, and its bend, degrees.

    Examples
    --------
    >>> round(leg(ahead=0.9, height=0.5)["bend"])  # out of reach
    0
    """
    thigh, shank = _leg_lengths()
    hip = np.array([0, HIP, 0])
    offset = np.array([0, height, ahead]) - hip
    distance = min(float(np.linalg.norm(offset)), thigh + shank)
    along = offset / np.linalg.norm(offset)
    cosine = (distance**2 - thigh**2 - shank**2) / (2 * thigh * shank)
    bend = np.arccos(np.clip(cosine, -1, 1))
    across = FORWARD - (FORWARD @ along) * along
    across /= np.linalg.norm(across)
    knee = (thigh + shank * np.cos(bend)) * along + shank * np.sin(bend) * across
    places = hip + np.array([thigh / distance * knee, distance * along])
    return {"knee": places[0, [2, 1]], "ankle": places[1, [2, 1]], "bend": np.degrees(bend)}


def pose_data() -> dict[str, Any]:
    """Return what forward kinematics is computed from, and the names of the joints."""
    skeleton, pose = _pose()
    data = {"root": pose.root_positions[0], "rotations": pose.rotations[0], "offsets": skeleton.offsets}
    lists: dict[str, Any] = {name: values.tolist() for name, values in data.items()}
    return lists | {"parents": skeleton.parents.tolist(), "names": list(skeleton.names)}


def orders_data() -> dict[str, Any]:
    """Return the orders in which Euler angles are read."""
    return {"orders": ORDERS}


def turn_data() -> dict[str, Any]:
    """Return two windows, and the bones of their body as pairs of joints."""
    skeleton = sample("walk_curve_1").skeleton
    joints = distinct_joints(skeleton)
    first, second = _windows_to_align()
    return {"first": first.tolist(), "second": second.tolist(), "bones": _bones_between(skeleton, joints)}


def body_data() -> dict[str, Any]:
    """Return the joints of a body in its rest pose, relative to the root, metres, and their parents."""
    skeleton = sample("walk_straight").skeleton
    upright = np.tile([1.0, 0, 0, 0], (1, len(skeleton.names), 1))
    positions = joint_positions(Motion(skeleton, [[0, 0, 0]], upright, 30))[0]
    return {"positions": positions.round(4).tolist(), "parents": skeleton.parents.tolist()}


def ways_data() -> dict[str, Any]:
    """Return the first and the last Euler angles of a bone, radians."""
    return {"first": FIRST.tolist(), "last": LAST.tolist()}


def leg_data() -> dict[str, Any]:
    """Return the lengths of a leg and the height of its hip, metres."""
    thigh, shank = _leg_lengths()
    return {"thigh": thigh, "shank": shank, "hip": HIP}


def _pose() -> tuple[Skeleton, Motion]:
    """Return the body of the straight walk, and the pose that is placed."""
    walk = sample("walk_straight")
    return walk.skeleton, walk[POSE : POSE + 1]


def _windows_to_align() -> tuple[Array, Array]:
    """Return the joints of two windows of notebook 02, metres to four digits, shape (10, J, 3) each."""
    first, second = (resample(sample(name), 30) for name in ("walk_curve_1", "walk_curve_2"))
    joints = distinct_joints(first.skeleton)
    positions = joint_positions(first[47:57]), joint_positions(second[15:25])
    return positions[0][:, joints].round(4), positions[1][:, joints].round(4)


def _bones_between(skeleton: Skeleton, joints: list[int]) -> list[tuple[int, int]]:
    """Return pairs of positions in `joints`: each joint's with that of its nearest ancestor among them."""
    pairs = []
    for position, joint in enumerate(joints):
        ancestor = int(skeleton.parents[joint])
        while ancestor >= 0 and ancestor not in joints:
            ancestor = int(skeleton.parents[ancestor])
        if ancestor >= 0:
            pairs.append((joints.index(ancestor), position))
    return pairs


def _leg_lengths() -> tuple[float, float]:
    """Return the lengths of thigh and shank of the body of the samples, metres."""
    skeleton = sample("walk_straight").skeleton
    thigh, shank, _ = find_legs(skeleton)[1].lengths(skeleton)
    return float(thigh), float(shank)
