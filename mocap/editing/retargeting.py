"""A motion worn by another body: copied, then brought back to the floor by a smooth change [Gle98].

The paper's steps: start from the old motion, scale the root's way, choose how far apart the knots are, solve
for all frames at once, and solve again with more knots where something is not met. Here the start is a copy
of global turns, not of those against the parent: a joint that one body lacks costs nothing, and rest poses do
not matter. The last knots are the frames.
"""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from mocap._shared.arrays import Array
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses, forward_kinematics, joint_positions
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.bodies import body_of
from mocap.editing.body_roles import FEET, SIDES
from mocap.editing.edits import let_go
from mocap.editing.pins import Pins, join_pins, pin_errors, plant_pins, with_plants
from mocap.editing.solver import CLOSE, Basis, solve
from mocap.editing.stances import Stance, heading_by_hips, stance_of, stance_of_zero
from mocap.errors import MocapError, shortened, warn
from mocap.feet.footskate import clean_up

# The roles that a joint's bones lead to. Head, ankles and balls lead to none; a hand goes with its forearm.
BELOW = {
    "pelvis": ("waist", "chest", "left hip", "right hip"),
    "waist": ("chest",),
    "chest": ("neck", "head", "left shoulder", "right shoulder"),
    "neck": ("head",),
}
LIMBS = ("clavicle", "shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
BELOW |= {f"{s} {above}": (f"{s} {below}",) for s in SIDES for way in LIMBS for above, below in pairwise(way)}
SHORT = 1e-6  # metres: a shorter bone points nowhere
SMALL = 1e-9


def copied(motion: Motion, source: Stance, target: Stance, *, scale: float | None = None) -> Motion:
    """Copy a motion onto another body: its turns, and the way of its hips, scaled [Gle98, scaled start].

    R_t(f) = R_s(f) C with C = R_s(stance)⁻¹ A R_t(stance). A is the smallest turn that lays the target's
    bones at that joint on the source's, both as they stand; hands go with their forearms, and there is none
    for head and feet. Joints without a role, but with the same name in both, take A = 1; others stay as they
    are to their parents. The middle of the hips goes `scale` times as far over the ground from where it
    starts, and its height over the standing ankles is the legs' ratio times the source's.

    Scaling the way about a centre is [Gle98]'s. Roles, stances and C are ours: the paper's bodies have the
    same tree and the same rest pose.

    Parameters
    ----------
    motion : F frames of the source's skeleton.
    source, target : how both bodies stand.
    scale : of the way over the ground; by default the ratio of the legs, which keeps the steps in proportion.

    Returns
    -------
    F frames of the target's skeleton, with the source's name, labels, and contacts under the target's names.

    Raises
    ------
    SkeletonMismatch : for a motion of another skeleton than the source's.
    MocapError : for a scale that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import stance_of
    >>> walk = sample("walk_straight")
    >>> stance = stance_of(walk)
    >>> same = copied(walk, stance, stance)
    >>> bool(abs(joint_positions(same) - joint_positions(walk)).max() < 1e-12)
    True

    Notebook: 13-retargeting
    """
    source.skeleton.require_same(motion.skeleton)
    ratio = target.leg / source.leg
    scale = ratio if scale is None else scale
    if not (np.isfinite(scale) and scale > 0):
        raise MocapError(f"A way over the ground needs a scale above 0, got {scale}.")
    poses = forward_kinematics(motion)
    local = _local(poses, source, target)
    start = Motion(target.skeleton, np.zeros((len(motion), 3)), local, motion.fps, motion.name, motion.labels)
    hips, own = (
        positions[:, [leg.hip for leg in stance.legs]].mean(axis=1)  # (F, 3)
        for positions, stance in ((poses.positions, source), (joint_positions(start), target))
    )
    centre = hips[0] * [1, 0, 1]
    wanted = centre + (hips - centre) * [scale, 0, scale]
    wanted[:, 1] = target.height("ankle") + ratio * (hips[:, 1] - source.height("ankle"))
    names = {motion.skeleton.names[j]: target.skeleton.names[target.roles[r]]
             for r, j in source.roles.items() if r in target.roles}  # fmt: skip
    contacts = {names[old]: mark for old, mark in motion.contacts.items() if old in names}
    return replace(start, root_positions=wanted - own, contacts=contacts)


def _local(poses: GlobalPoses, source: Stance, target: Stance) -> Array:
    """Turn the target's joints against their parents, (F, J, 4).

    A joint without a turn of its own keeps the stance's; a root above the pelvis turns with the heading only.
    """
    parents, looks = target.skeleton.parents, _bone_turns(source, target)
    seen = rotations.from_matrix(poses.matrices)
    world = np.empty((len(seen), len(parents), 4))
    facing = rotations.about_y(heading_by_hips(poses.positions, source.roles))
    world[:, 0] = rotations.multiply(facing, target.turns[0])
    for joint, above in enumerate(parents):
        if joint in looks:
            own, turn = looks[joint]
            world[:, joint] = rotations.multiply(seen[:, own], turn)
        elif joint:
            still = rotations.multiply(rotations.inverse(target.turns[above]), target.turns[joint])
            world[:, joint] = rotations.multiply(world[:, above], still)
    local = rotations.multiply(rotations.inverse(world[:, parents]), world)
    local[:, 0] = world[:, 0]
    return np.asarray(local / np.linalg.norm(local, axis=-1, keepdims=True))


def _bone_turns(source: Stance, target: Stance) -> dict[int, tuple[int, Array]]:
    """Find for each of the target's joints the source's joint, and C (4,), the turn between how both look.

    Joints belong together by role, or by name where they have none.
    """
    role_of = {joint: role for role, joint in target.roles.items()}
    looks = {}
    for joint, name in enumerate(target.skeleton.names):
        role = role_of.get(joint)
        own = source.roles.get(role or "")
        if role is None and name in source.skeleton.names:
            own = source.skeleton.index(name)
        if own is None:
            continue
        above = target.skeleton.path_to_root(joint)
        role = next((f"{side} elbow" for side in SIDES if target.roles.get(f"{side} wrist") in above), role)
        stands = rotations.multiply(_laid(role, source, target), target.turns[joint])
        looks[joint] = (own, rotations.multiply(rotations.inverse(source.turns[own]), stands))
    return looks


def _laid(role: str | None, source: Stance, target: Stance) -> Array:
    """Find A, the smallest turn that lays the target's bones at a joint on the source's, (4,)."""
    both = [below for below in BELOW.get(role or "", ()) if below in source.roles and below in target.roles]
    bones = np.array([[stance.bone(str(role), below) for below in both] for stance in (target, source)])
    bones = bones.reshape(2, -1, 3)
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    bones = (bones / np.maximum(lengths, SHORT))[:, (lengths > SHORT).all(axis=(0, 2))]
    if not bones.size:
        return rotations.IDENTITY
    if bones.shape[1] == 1:
        return rotations.between(*bones[:, 0])
    # The three axes, with next to no weight, choose the smallest turn where the bones lie on one line.
    weights = [1.0] * bones.shape[1] + [SMALL] * 3
    turn, _ = Rotation.align_vectors(np.r_[bones[1], np.eye(3)], np.r_[bones[0], np.eye(3)], weights)
    return np.asarray(turn.as_quat(scalar_first=True))


# Less calm than an edit: with 0.2 the knees of a child with long steps straighten to 4°. Few passes are
# enough for plants.
RETARGET = (Basis(knots=0.125, calm=0.1, passes=5), CLOSE, CLOSE)

# What turns of knees and of the trunk cost, as a share of what they move. With 1 the knees of a child that
# takes long steps straighten. A hand that reaches for a rail leans the body by 17° with 1, and by 12° with 4.
STIFF = 4.0

# Metres. Feet that move more while they stand are cleaned up first. Without that, up to 6 % of the planted
# frames of captured walks are let go on the new body; with it, none that stand on the old one.
STILL = 0.001

MOST = 0.5  # of a leg: hips that move by more to take the steps jump; a child's do at 3 times its own steps


def retarget(
    motion: Motion, body: Skeleton | Stance, source: Stance | None = None, *, scale: float | None = None
) -> Motion:
    """Let another body wear a motion, with its feet planted on the floor where the old feet were planted.

    In the paper: [Gle98, method].

    The motion is copied; pins say where its feet must be; the smallest smooth change over all frames at once
    brings them there [Gle98]. Copied angle by angle, feet would slide, float and sink, and bodies with other
    rest poses would fold.

    Parameters
    ----------
    motion : F frames; its plants are marked if they are not yet, and its feet cleaned up if they slide. Its
        plants are the new body's as well.
    body : how the new body stands; or its skeleton, whose rest pose must stand. Then its balls are as high
        over the floor as the source's, times the ratio of the legs.
    source : how the old body stands; by default `stance_of(motion)`.
    scale : of the way over the ground; by default the ratio of the legs. More makes the steps longer.

    Returns
    -------
    F frames of the new skeleton, with the motion's name and labels. It falls as fast as the scale says: for a
    child's jump `retime` by 1 / √scale.

    Raises
    ------
    MocapError : for legs that are not found, rest poses that do not stand, and pins that no pose can meet.
    SkeletonMismatch : for a motion of another skeleton than the source's.

    Warns
    -----
    MocapWarning : for steps that no leg takes: hips that move by more than half a leg, and pins that are
        missed by more than 0.1 mm; plants among them are let go.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import proportioned
    >>> walk = sample("walk_straight")[:240]
    >>> child = proportioned(stance_of(walk), legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    >>> worn = retarget(walk, child)
    >>> [round(float(clip.root_positions[-1, 2] - clip.root_positions[0, 2]), 2) for clip in (walk, worn)]
    [2.12, 1.17]

    Notebook: 13-retargeting
    """
    source = stance_of(motion) if source is None else source
    if isinstance(body, Skeleton):  # its balls are as high as the source's, times the ratio of the legs
        ratio = stance_of_zero(body, 0.0).leg / source.leg
        body = stance_of_zero(body, ratio * source.height("ball"))
    planted = with_plants(motion, source.legs)
    if pin_errors(planted, plant_pins(planted, source.legs)).max() > STILL:
        planted = clean_up(planted, source.legs)
    base = copied(planted, source, body, scale=scale)
    dips = {role: dip * body.leg / source.leg for role, dip in dips_of(motion, source).items()}
    wishes = floor_pins(base, body, dips)
    who, trunk = body.roles, body.skeleton.path_to_root(body.roles.get("chest", 0))
    stiff = [*(leg.knee for leg in body.legs), *(joint for joint in trunk if joint > who["pelvis"])]
    prices = dict.fromkeys((body.skeleton.names[joint] for joint in stiff), STIFF)
    priced = body_of(base, wishes.joints, prices=prices)
    worn = solve(base, wishes, RETARGET, priced, quiet=True).motion
    if (moved := np.abs(worn.root_positions - base.root_positions).max()) > MOST * body.leg:
        hips = f"the hips move by {100 * moved:.0f} cm to take these steps"
        legs = f"with legs of {100 * body.leg:.0f} cm: no leg takes them at ease"
        warn(f"'{shortened(motion.name)}': {hips}, {legs}.")
    return let_go(worn, wishes, floor_pins(base, body))


def floor_pins(motion: Motion, stance: Stance, dips: Mapping[str, float] | None = None) -> Pins:
    """Hold each plant at the height that its joint stands at, and keep feet above the floor.

    Feet differ: an ankle stands 4 cm over the ball in one body and 8 cm in another. So plants take their
    heights from how the new body stands, not from the old feet. A plant's place over the ground is the mean
    over its frames [Gle98]. The floor is level, at y = 0: a plant on a step comes down to it.

    Parameters
    ----------
    motion : the copied motion; its `contacts` say when ankles and balls stand.
    stance : how its body stands.
    dips : how far each ankle and ball may be lower than it stands, metres by role; without it there is no
        floor, only plants.

    Raises
    ------
    MocapError : for marks that are missing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> pins = floor_pins(walk, stance_of(walk))
    >>> ankle = pins.low[:, 0, 1]  # held at one height, or free
    >>> np.unique(ankle[np.isfinite(ankle)]).round(3)
    array([0.068])

    Notebook: 13-retargeting
    """
    heights = np.reshape([stance.heights[role] for role in FEET], (2, 2))
    free = np.full((len(motion), len(dips or ()), 3), np.inf)
    low = -free
    low[..., 1] = [stance.heights[role] - dip for role, dip in (dips or {}).items()]
    floors = Pins(tuple(stance.roles[role] for role in dips or ()), low, free)
    return join_pins(floors, plant_pins(motion, stance.legs, heights))


def dips_of(motion: Motion, stance: Stance) -> dict[str, float]:
    """Measure how far each ankle and ball ever is below where it stands, metres by role, 0 or more."""
    lowest = joint_positions(motion)[..., 1].min(axis=0)
    return {role: max(0.0, stance.heights[role] - float(lowest[stance.roles[role]])) for role in FEET}
