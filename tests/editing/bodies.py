"""Bodies that tests make out of the bundled one: other rest poses, other names, fewer joints."""

from dataclasses import replace
from functools import cache

import numpy as np

from mocap.body import Motion, Skeleton, rotations
from mocap.body.kinematics import forward_kinematics
from mocap.datasets.samples import sample
from mocap.editing.proportions import proportioned
from mocap.editing.stances import Stance, stance_of
from tests.editing.wishes import between

# As cgspeed's conversions of the CMU clips name them, and as Bandai-Namco's files do.
LONG = {"root": "Hips", "lowerback": "LowerBack", "upperback": "Spine", "thorax": "Spine1"}
LONG |= {"lowerneck": "Neck", "upperneck": "Neck1", "head": "Head"}
# As in Biovision's own example, as Poser and Daz have it (cgspeed's second conversion), and as SMPL has it.
UP_AND_LOW = {"head": "Head"}
DAZ, SMPL = {"root": "hip", "lowerback": "abdomen", "thorax": "chest"}, {"root": "Pelvis", "head": "Head"}
UNDERSCORED = {"root": "Hips", "lowerback": "Spine", "thorax": "Chest", "lowerneck": "Neck", "head": "Head"}
for _side, _name, _end in (("l", "Left", "_L"), ("r", "Right", "_R")):
    _parts = ("clavicle", "humerus", "radius", "wrist", "femur", "tibia", "foot", "toes")
    _long = ("Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase")
    _short = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
    _low = ("Collar", "UpArm", "LowArm", "Hand", "UpLeg", "LowLeg", "Foot", "Toe")
    _daz = ("Collar", "Shldr", "ForeArm", "Hand", "Thigh", "Shin", "Foot", "Toe")
    _smpl = ("Collar", "Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle", "Foot")
    UP_AND_LOW |= {_side + old: _name + new for old, new in zip(_parts, _low, strict=True)}
    DAZ |= {_side + old: _side + new for old, new in zip(_parts, _daz, strict=True)}
    SMPL |= {_side + old: f"{_side.upper()}_{new}" for old, new in zip(_parts, _smpl, strict=True)}
    LONG |= {_side + old: _name + new for old, new in zip(_parts, _long, strict=True)}
    UNDERSCORED |= {_side + old: new + _end for old, new in zip(_parts, _short, strict=True)}
NAMINGS = (LONG, UNDERSCORED, UP_AND_LOW, DAZ, SMPL)


def renamed(motion: Motion, names: dict[str, str]) -> Motion:
    """Give joints other names."""
    old = motion.skeleton
    body = Skeleton([names.get(n, n) for n in old.names], old.parents, old.offsets, old.axes, old.dofs)
    contacts = {names.get(name, name): mark for name, mark in motion.contacts.items()}
    return replace(motion, skeleton=body, contacts=contacts)


def rested(motion: Motion, turns: np.ndarray) -> Motion:
    """Give the same motion on a skeleton that rests another way: at rest, joint j is turned by turns[j]⁻¹.

    The joints are where they were, in every frame; only the numbers that say so are other ones.
    """
    old = motion.skeleton
    above = rotations.inverse(np.concatenate([[rotations.IDENTITY], turns[old.parents[1:]]]))
    body = Skeleton(old.names, old.parents, rotations.rotate(above, old.offsets))
    local = rotations.multiply(above, rotations.multiply(motion.rotations, turns))
    return replace(motion, skeleton=body, rotations=local)


def along_x(skeleton: Skeleton) -> np.ndarray:
    """Turn each joint so that at rest its first bone lies along +x: a rest pose that means nothing."""
    turns = np.tile([1.0, 0, 0, 0], (len(skeleton), 1))
    for joint in range(len(skeleton)):
        bones = [skeleton.offsets[child] for child in skeleton.children(joint)]
        long = [bone for bone in bones if np.linalg.norm(bone) > 1e-6]
        if long:
            turns[joint] = rotations.between([1.0, 0, 0], long[0])
    return turns


def without(motion: Motion, *names: str) -> Motion:
    """Leave out joints: those below hang on what was above, turned in the world as they were."""
    old, world = motion.skeleton, rotations.from_matrix(forward_kinematics(motion).matrices)
    keep = [joint for joint, name in enumerate(old.names) if name not in names]
    parents, offsets, local = [-1], [old.offsets[0]], [world[:, 0]]
    for joint in keep[1:]:
        offset, above = old.offsets[joint], int(old.parents[joint])
        while above not in keep:
            offset, above = offset + old.offsets[above], int(old.parents[above])
        parents.append(keep.index(above))
        offsets.append(offset)
        local.append(rotations.multiply(rotations.inverse(world[:, above]), world[:, joint]))
    body = Skeleton([old.names[joint] for joint in keep], parents, offsets)
    return replace(motion, skeleton=body, rotations=np.stack(local, axis=1))


@cache
def walk(seconds: float = 4.0) -> Motion:
    """Give a bundled walk."""
    return sample("walk_straight")[: round(120 * seconds)]


@cache
def adult() -> Stance:
    """Say how the bundled body stands."""
    return stance_of(walk())


@cache
def child() -> Stance:
    """Say how a child stands: short legs and a large head."""
    return proportioned(adult(), legs=0.55, trunk=0.62, arms=0.58, head=0.85)


def bends(motion: Motion, who: dict[str, int]) -> np.ndarray:
    """Measure how far knees, elbows, hips and shoulders are bent, (F, 8), degrees.

    They are angles between bones, so they need no common rest pose.
    """
    at = {role: forward_kinematics(motion).positions[:, joint] for role, joint in who.items()}
    up = at["chest"] - (at["left hip"] + at["right hip"]) / 2
    angles = []
    for side in ("left", "right"):
        hip, knee, ankle, shoulder, elbow, wrist = (
            at[f"{side} {part}"] for part in ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")
        )
        angles += [
            between(knee - hip, ankle - knee),
            between(elbow - shoulder, wrist - elbow),
            between(-up, knee - hip),
            between(-up, elbow - shoulder),
        ]
    return np.stack(angles, axis=1)
