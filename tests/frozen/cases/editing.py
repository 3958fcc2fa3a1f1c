"""Edits, constraints, warps, bent paths, other bodies."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from mocap import body, datasets, editing
from mocap.editing.line_rounding import round_line
from mocap.editing.turning import places_on
from mocap.editing.warp_plans import load_plan, warp
from tests.bundled import clips
from tests.frozen.cases.feet import WALK, displacements
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

SHORTLY = [editing.Stage(0.125, 0.1, passes=4, lead=0.2), replace(editing.REACH, passes=2)]
PLAN = "at 100 lhand 0.1 0.2 0\nat 1.5s level\ntime 0 0\ntime 1 1.5\ntime 2 2.4"
JOINTS = joint_axis(WALK.skeleton)


def reached(frames=240):
    """Return a walk and constraints: a hand reaches, the head stays below a bar."""
    walk = WALK[:frames]
    hand = body.joint_positions(walk)[100, walk.skeleton.index("lwrist")]
    below = editing.pin(walk, "head", range(50, 80), [-np.inf] * 3, [np.inf, 1.45, np.inf])
    held = editing.pin(walk, "lwrist", range(95, 105), np.add(hand, [0.1, 0.4, 0.2]))
    return walk, editing.join_pins(held, below)


def bent_to(clip, *points):
    """Bend a walk to a line, and measure it there."""
    bent = editing.bend(clip, body.GroundPath(points))
    return {
        "positions": positions(body.joint_positions(bent.motion), bent.motion.skeleton),
        "off the line": numbers(bent.off, FRAME, unit="m"),
        "along the line": numbers(bent.along, FRAME, unit="m"),
        "turned": numbers(bent.turned, FRAME),
        "rounded": numbers(bent.rounded, FRAME),
    }


@case("edited")
def edited():
    return {"displacements": displacements(editing.edit(*reached()), WALK[:240])}


@case("in levels")
def in_levels():
    return {"displacements": displacements(editing.hierarchy(*reached(160))[0], WALK[:160])}


@case("posed")
def posed():
    wrist = reached()[1].low[100, 0]
    return {"displacements": displacements(editing.posed(WALK, 100, {"lwrist": wrist}), WALK[100:101])}


@case("solved")
def solved():
    result = editing.solve(*reached(160), SHORTLY)
    worst = numbers(result.worst, "pass")
    return {"costs": worst, "short of": numbers(result.change, FRAME, "constraint")}


@case("keys")
def keys():
    quantities = {}
    for start in (0, 1):
        root, turns = editing.offsets(WALK[:60], [editing.Key(start, WALK[90:91]), editing.Key(40)])
        quantities[f"root from key {start}"] = roots(root)
        quantities[f"rotation vectors from key {start}"] = numbers(turns, FRAME, JOINTS, DIRECTION)
    return quantities


@case("warped")
def warped():
    with TemporaryDirectory() as folder:
        file = Path(folder, "keys.txt")
        file.write_text(PLAN)
        plan = load_plan(file, WALK[:300])
    return {"displacements": displacements(warp(WALK[:300], plan), WALK[:241])}


@case("slower")
def slower():
    return {"root": roots(editing.retime(WALK, [(0, 0), (0.5, 1), (3, 2)]).root_positions)}


@case("loop")
def loop():
    looped = editing.loop(WALK)
    return {"displacements": displacements(looped, editing.loop(WALK, straight=True, clean=True))}


@case("ride")
def ride():
    return {"handles": numbers(editing.ride_of(WALK[:300]).handles, "handle", Axis("", ("x", "z")), unit="m")}


@case("bent")
def bent():
    return bent_to(WALK, [0, 0], [0, 3], [3, 4])


@case("bent back")
def bent_back():
    return bent_to(clips("walk_curve_1")[0][:300], [0, 0], [0, 3], [2, 1])


@case("rounded")
def rounded():
    quantities = {}
    for x in (0.1, 1.5, 2.5):
        line = body.GroundPath([[0, 0], [0, 3], [x, 1.5], [2, 3]])
        parts = round_line(line, editing.ride_of(WALK), 120, 1.0)[1:]
        quantities |= {f"part {part} to {x} m": numbers(row, "point") for part, row in enumerate(parts)}
    return quantities


@case("slowed")
def slowed_in_corners():
    line = body.GroundPath([[0, 0], [0, 2], [1, 0]])
    parts = places_on(line, editing.ride_of(datasets.sample("stop_and_go")), 120, 1.5)
    return {f"part {part}": numbers(row, FRAME) for part, row in enumerate(parts)}


@case("mirrored")
def mirrored():
    return {"rotations": rotations(editing.mirror(WALK).rotations, WALK.skeleton)}


@case("worn")
def worn():
    small = editing.proportioned(editing.stance_of(WALK), legs=0.6, arms=0.7, trunk=0.8)
    motion = editing.retarget(WALK[:120], small, editing.stance_of(WALK[:120]))
    return {"positions": positions(body.joint_positions(motion), motion.skeleton)}


@case("stance")
def stance():
    return {"rotations": numbers(editing.stance_of(WALK, mean=True).turns, JOINTS, Axis("", QUATERNION))}


@case("limits")
def limits():
    joints = ("ltibia", "lowerneck")
    high = editing.limit_turns(WALK, list(joints)).rotations.high
    return {"upper limits": numbers(high, FRAME, Axis("joint", joints), DIRECTION)}
