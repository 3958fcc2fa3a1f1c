"""Strides, parametric spaces of motions, and the characters that they make."""

from functools import cache, partial

import numpy as np

from mocap import body, steering
from mocap.methods import match_webs, motion_matching, parametric_graphs
from mocap.methods.parametric_graphs.made_motions import make_motion, near_end
from mocap.methods.parametric_graphs.stride_changes import changing_strides
from tests.bundled import clips, walking
from tests.frozen.quantities import (
    DIRECTION,
    FRAME,
    QUATERNION,
    Axis,
    case,
    joint_axis,
    numbers,
    positions,
    roots,
    rotations,
)

ORDERS = [(0.0, 1.0), (1.2, 0.7), (-0.8, 1.3)]  # heading in radians, speed in metres a second
FRAMES_PER_ORDER = 25
PLACES = [[0, 106.0]] * 2  # of the grid of strides
STRIDE_AXES = {  # of what strides consist of
    "grid": ("sample",),
    "seconds": ("stride", "sample"),
    "speeds": ("stride", "sample"),
    "turning": ("stride", "sample"),
    "heights": ("stride", "sample"),
    "contacts": ("stride", "sample", "foot"),
    "values": ("stride", "parameter"),
}


@cache
def strides(name="walk_curve_2", **how):
    return parametric_graphs.cut_strides(clips(name), **how)


@cache
def space():
    return parametric_graphs.make_space(strides(), 0.4, -0.8, 0.8)


def hands(examples, count):
    """Sample blends by where a hand is in the middle."""
    reach = partial(match_webs.hand_target, at=0.5)
    return match_webs.sample_space(examples, reach, count=count, parameters=("left", "up", "ahead"))


def played(character, orders):
    """Steer a character, and lay its poses in a row."""
    poses = [character.step(*order) for order in orders for _ in range(FRAMES_PER_ORDER)]
    skeleton = poses[0].skeleton if hasattr(poses[0], "skeleton") else clips()[0].skeleton
    return {
        "root": roots([pose.root_position for pose in poses]),
        "rotations": rotations([pose.rotations for pose in poses], skeleton),
    }


def prefixed(prefix, quantities):
    return {f"{prefix}: {name}": quantity for name, quantity in quantities.items()}


def parts_of(made):
    """Name the numbers that strides consist of."""
    quantities = {}
    for name, part in vars(made).items():
        if isinstance(part, int | float):
            quantities[name] = numbers(part)
        elif name == "poses":
            axes = ("stride", "sample", joint_axis(made.skeleton), Axis("", QUATERNION))
            quantities[name] = numbers(part, *axes)
        elif isinstance(part, np.ndarray):
            quantities[name] = numbers(part, *STRIDE_AXES[name])
    return quantities


@case("strides")
def cut_by_contacts_and_curves():
    return prefixed("by contacts", parts_of(strides())) | prefixed(
        "by curves", parts_of(strides(by="curves"))
    )


@case("steps")
def steps():
    return {
        name: quantity
        for feet in ("lr", "rl")
        for name, quantity in prefixed(feet, parts_of(strides("sneak", feet=feet))).items()
    }


@case("sneaking strides")
def sneaking_strides():
    return parts_of(strides("sneak", label="sneak", margin=0.5))


@case("stride")
def stride():
    motion = strides().blend(np.eye(len(strides()))[0])
    return {"positions": positions(body.joint_positions(motion), motion.skeleton)}


@case("mixed strides")
def mixed_strides():
    root, poses, heading = strides().mixed(np.eye(len(strides()))[:2] - 0.01, np.array(PLACES))
    return {
        "root": numbers(root, "mixture", "place", DIRECTION, unit="m"),
        "rotations": numbers(poses, "mixture", "place", joint_axis(strides().skeleton), Axis("", QUATERNION)),
        "heading": numbers(heading, "mixture", "place"),
    }


@case("changing strides")
def strides_that_change():
    quantities = {}
    for stands in ("", "first", "second"):
        parts = parts_of(changing_strides(strides("jog"), strides(), stands=stands))
        kept = {name: parts[name] for name in ("values", "poses", "seconds", "contacts", "offset")}
        quantities |= prefixed(stands or "neither stands", kept)
    return quantities


@case("made stride")
def made_stride():
    made = make_motion(space(), np.array([0.3]))
    return {
        "phases": numbers(made.phases, FRAME),
        "heading": numbers(made.heading, FRAME),
        "values": numbers(made.values, "parameter"),
    }


@case("windows")
def windows():
    points, phases = near_end(space(), np.array([[0.3], [-0.2]]), 1.0)
    return {
        "points": numbers(points, "window", FRAME, "point", DIRECTION, unit="m"),
        "phases": numbers(phases, "window", FRAME),
    }


@case("parameters")
def parameters():
    """Reach for a position, then walk by commands of turn and speed, and of turn alone."""
    spaces = {"walk": space(), "hand": hands(strides(), 20)}
    spaces["any"] = match_webs.sample_space(
        strides("walk_curve_1"),
        lambda blend: [match_webs.heading_change(blend), match_webs.mean_speed(blend)],
        count=30,
        parameters=("turn", "speed"),
    )
    graph = parametric_graphs.build_parametric(spaces, good=0.06, sampling=(6, 50))
    character = parametric_graphs.ParametricController(graph, start="any")
    unaimed = played(character, [(0.0, 1.0, "hand")] * 2)
    character.aim(character.end.apply_points(spaces["hand"].reached.mean(axis=0)))
    labels = ("hand", "hand", "any", "any", "walk", "walk")
    aimed = played(character, [(-5.9, 0.7, label) for label in labels] + ORDERS)
    blended = [character.step(1.0, 0.7).blending for _ in range(60)]
    quantities = prefixed("without a target", unaimed) | prefixed("with a target", aimed)
    quantities["blending"] = numbers(blended, FRAME)
    for number, chosen in enumerate(character.chosen):
        for part, values in enumerate(chosen[1:]):
            quantities[f"choice {number}, part {part}"] = numbers(values, *["number"] * np.ndim(values))
    return quantities


@case("matcher")
def matcher():
    table = motion_matching.tabulate(clips("walk_curve_1", "walk_circle"))
    return played(motion_matching.MotionMatcher(table), ORDERS)


@case("pose table")
def pose_table():
    table = motion_matching.tabulate([clip[:60] for clip in clips("walk_curve_1", "jog")])
    return {
        "values": numbers(table.values, "row", "feature"),
        "mean": numbers(table.mean, "feature"),
        "scale": numbers(table.scale, "feature"),
        "usable": numbers(table.usable, "row"),
        "ground": numbers(table.ground, "row", unit="m"),
        "heading": numbers(table.heading, "row"),
        "drift": numbers(table.drift, "row"),
        "spin": numbers(table.spin, "row"),
        "speeds": numbers(table.speeds, "row", "joint or root", DIRECTION),
    }


@case("controller")
def controller():
    return played(steering.Controller(walking()), ORDERS)
