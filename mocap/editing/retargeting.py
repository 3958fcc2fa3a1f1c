"""A motion worn by another body: copied, then brought back to the floor by a smooth change [Gle98].

The paper's steps: start from the old motion, scale the root's way, choose how far apart the knots are, solve
for all frames at once, and solve again with more knots where something is not met. Here the start is a copy
of global turns, not of those against the parent: a joint that one body lacks costs nothing, and rest poses do
not matter. The last knots are the frames.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from mocap._shared.arguments import checked_by
from mocap._shared.arrays import Array
from mocap._shared.quantities import described
from mocap.body import rotations
from mocap.body.kinematics import GlobalPoses, forward_kinematics, joint_positions
from mocap.body.limbs import FEET, SIDES, heading_by_hips
from mocap.body.motion import Motion, require_motion
from mocap.body.skeleton import Skeleton
from mocap.editing.bodies import body_of
from mocap.editing.edits import floor_for, mark_met
from mocap.editing.pins import Pins, join_pins, pin_errors, plant_pins, with_plants
from mocap.editing.solver import Stage, closing_stages, solve
from mocap.editing.stances import Stance, stance_of, stance_of_zero
from mocap.editing.toes import bend_toes
from mocap.errors import MocapError, shortened, warn
from mocap.feet.footskate import clean_up

# The roles that a joint's bones lead to. Head, ankles and balls lead to none; a hand goes with its forearm.
BELOW = {
    "pelvis": ("waist", "chest", "left hip", "right hip"),
    "waist": ("chest",),
    "chest": ("neck", "head", "left shoulder", "right shoulder"),
    "neck": ("head",),
}
BONES = (*pairwise(("clavicle", "shoulder", "elbow", "wrist")), *pairwise(("hip", "knee", "ankle")))
BELOW |= {f"{side} {above}": (f"{side} {below}",) for side in SIDES for above, below in BONES}
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
    world = _copied_rotations(poses, source, target)
    parents = target.skeleton.parents
    local = rotations.multiply(rotations.inverse(world[:, parents]), world)
    local[:, 0] = world[:, 0]
    local /= np.linalg.norm(local, axis=-1, keepdims=True)
    start = Motion(target.skeleton, np.zeros((len(motion), 3)), local, motion.fps, motion.name, motion.labels)
    hips = _middle_of_hips(poses.positions, source)
    centre = hips[0] * [1, 0, 1]
    wanted = centre + (hips - centre) * [scale, 0, scale]
    wanted[:, 1] = target.height("ankle") + ratio * (hips[:, 1] - source.height("ankle"))
    roots = wanted - _middle_of_hips(joint_positions(start), target)
    contacts = {name: motion.contacts[old] for old, name in _contact_names(motion, source, target)}
    return replace(start, root_positions=roots, contacts=contacts)


def _copied_rotations(poses: GlobalPoses, source: Stance, target: Stance) -> Array:
    """Copy the global rotations of the source's joints, (F, J, 4), J joints of the target."""
    seen = rotations.from_matrix(poses.matrices)
    parents = target.skeleton.parents
    world = np.empty((len(seen), len(parents), 4))
    for joint, (image, turn) in enumerate(_bone_turns(source, target)):
        if image is not None:
            base = seen[:, image]
        elif joint:
            base = world[:, parents[joint]]
        else:
            base = rotations.about_y(heading_by_hips(poses.positions, source.legs))
        world[:, joint] = rotations.multiply(base, turn)
    return world


def _middle_of_hips(positions: Array, stance: Stance) -> Array:
    """Compute the middle of both hips, (F, 3), from positions of the stance's joints (F, J, 3)."""
    return np.asarray(positions[:, [leg.hip for leg in stance.legs]].mean(axis=1))


def _contact_names(motion: Motion, source: Stance, target: Stance) -> Iterator[tuple[str, str]]:
    """Yield the joints that have contacts, and the target's joints of the same roles, by name.

    The ball of a foot without toes is its ankle, and has that one's contacts.
    """
    feet = [leg.ankle for leg in target.legs if not leg.has_ball]
    for name in motion.contacts:
        for role, joint in source.roles.items():
            image = target.roles.get(role)
            is_extra = role.endswith("ball") and image in feet
            if motion.skeleton.names[joint] == name and image is not None and not is_extra:
                yield name, target.skeleton.names[image]


def _bone_turns(source: Stance, target: Stance) -> list[tuple[int | None, Array]]:
    """Find for each of the target's joints the source's joint, and C (4,), the turn between how both look.

    Joints belong together by role, or by name where they have none. A joint that has no other turns with the
    one above it, as it stands, and a root above the pelvis with the heading.
    """
    # Of a foot without toes, ankle and ball are one joint: it has the role of the ankle.
    role_of = {joint: role for role, joint in reversed([*target.roles.items()])}
    looks: list[tuple[int | None, Array]] = []
    for joint, name in enumerate(target.skeleton.names):
        role = role_of.get(joint)
        image = source.roles.get(role or "")
        if role is None and name in source.skeleton.names:
            image = source.skeleton.index(name)
        path = target.skeleton.path_to_root(joint)
        stands = target.turns[joint]
        if image is not None:
            hands = (side for side in SIDES if target.roles.get(f"{side} wrist") in path)
            role = next((f"{side} elbow" for side in hands), role)
            stands = rotations.multiply(_laid(role, source, target), stands)
            base = source.turns[image]
        else:
            base = target.turns[path[1]] if joint else rotations.IDENTITY
        looks.append((image, rotations.multiply(rotations.inverse(base), stands)))
    return looks


def _laid(role: str | None, source: Stance, target: Stance) -> Array:
    """Find A, the smallest turn that lays the target's bones at a joint on the source's, (4,)."""
    shared = [end for end in BELOW.get(role or "", ()) if end in source.roles and end in target.roles]
    bones = np.array([[stance.bone(str(role), end) for end in shared] for stance in (target, source)])
    bones = bones.reshape(2, -1, 3)
    lengths = np.linalg.norm(bones, axis=-1, keepdims=True)
    bones = (bones / np.maximum(lengths, SHORT))[:, (lengths > SHORT).all(axis=(0, 2))]
    if not bones.size:
        return rotations.IDENTITY
    if bones.shape[1] == 1:
        return rotations.between(*bones[:, 0])
    # The three axes, with next to no weight, choose the smallest turn where the bones lie on one line.
    from_target, onto_source = (np.vstack([side, np.eye(3)]) for side in bones)
    weights = [1.0] * bones.shape[1] + [SMALL] * 3
    turn, _ = Rotation.align_vectors(onto_source, from_target, weights)
    return np.asarray(turn.as_quat(scalar_first=True))


# Less calm than an edit: with 0.2 the knees of a child with long steps straighten to 4°. Few passes are
# enough for plants.
RETARGET = (Stage(knots=0.125, decay=0.1, passes=5), *closing_stages())

# What turns of knees and of the trunk cost, as a share of what they move. With 1 the knees of a child that
# takes long steps straighten. A hand that reaches for a rail leans the body by 17° with 1, and by 12° with 4.
STIFF = 4.0

# Metres. Feet that move more while they stand are cleaned up first. Without that, up to 6 % of the planted
# frames of captured walks are let go on the new body; with it, none that stand on the old one.
STILL = 0.001

MOST = 0.5  # of a leg: hips that move by more to take the steps jump; a child's do at 3 times its own steps


def _require_stances(
    motion: object = None, body: object = None, source: object = None, **_options: object
) -> None:
    """Raise unless a motion comes with the stances of both bodies."""
    require_motion(motion)
    for stance in (body, source):
        if not isinstance(stance, Stance):
            needs = "This takes the stances of both bodies, body and source"
            raise MocapError(f"{needs}, got {described(stance)}: editing.wear(motion, skeleton) finds them.")


@checked_by(_require_stances)
def retarget(motion: Motion, body: Stance, source: Stance, *, scale: float | None = None) -> Motion:
    """Let another body wear a motion, with its feet planted on the floor where the old feet were planted.

    In the paper: [Gle98, method].

    The motion is copied; pins say where its feet must be; the smallest smooth change over all frames at once
    brings them there [Gle98]. Copied angle by angle, feet would slide, float and sink, and bodies with other
    rest poses would fold.

    Parameters
    ----------
    motion : F frames; its `contacts` say when feet stand, the new body's as well. Feet that slide are cleaned
        up first. Of a clip as it was read, `wear` finds out these and how its body stands.
    body, source : how the new body stands, and how the old one does.
    scale : of the way over the ground; by default the ratio of the legs. More makes the steps longer.

    Returns
    -------
    F frames of the new skeleton, with the motion's name and labels. It falls as fast as the scale says: for a
    child's jump `retime` by 1 / √scale.

    Raises
    ------
    MocapError : for what is no stance, contacts that are missing, and pins that no pose can meet.
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
    >>> adult = stance_of(walk)
    >>> worn = retarget(walk, proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85), adult)
    >>> [round(float(clip.root_positions[-1, 2] - clip.root_positions[0, 2]), 2) for clip in (walk, worn)]
    [2.54, 1.4]

    Notebook: 13-retargeting
    """
    planted = motion
    if pin_errors(motion, plant_pins(motion, source.legs)).max() > STILL:
        planted = clean_up(motion, source.legs)
    base = copied(planted, source, body, scale=scale)
    positions = joint_positions(motion)
    plants = floor_pins(base, body)
    wishes = join_pins(floor_under(positions, source, body), plants)
    prices = dict.fromkeys(_stiff_joints(body), STIFF)
    worn = solve(base, wishes, RETARGET, body_of(base, wishes, prices=prices), quiet=True).motion
    allowed = lowest_worn(positions, body.leg / source.leg, len(body.skeleton))
    floor = floor_for(bend_toes(worn, allowed), (), allowed)
    if floor.joints:
        floored = join_pins(floor, wishes)
        worn = solve(base, floored, RETARGET, body_of(base, floored, prices=prices), quiet=True).motion
    worn = bend_toes(worn, allowed)
    moved = np.abs(worn.root_positions - base.root_positions).max()
    if moved > MOST * body.leg:
        hips = f"the hips move by {100 * moved:.0f} cm to take these steps"
        legs = f"with legs of {100 * body.leg:.0f} cm: no leg takes them at ease"
        warn(f"'{shortened(motion.name)}': {hips}, {legs}.")
    return mark_met(worn, wishes, plants)


def _stiff_joints(body: Stance) -> list[str]:
    """Name the knees, and the joints of the trunk above the pelvis."""
    trunk = body.skeleton.path_to_root(body.roles.get("chest", 0))
    stiff = [leg.knee for leg in body.legs]
    stiff += [joint for joint in trunk if joint > body.roles["pelvis"]]
    return [body.skeleton.names[joint] for joint in stiff]


def wear(motion: Motion, body: Skeleton | Stance, *, clips: Iterable[Motion] = ()) -> Motion:
    """Retarget a motion as it was read: mark its footplants, find how both bodies stand, call `retarget`.

    Parameters
    ----------
    motion : F frames; its footplants are marked where it has none.
    body : the skeleton that takes over the motion, such as `mocap.load("child.bvh").skeleton`; or how it
        stands, from `stance_of`. The balls of a skeleton alone stand as high as the clip's, times the ratio
        of the legs.
    clips : other motions of the old body, for the heights of feet that never stand in this one.

    Returns
    -------
    F frames of the other body.

    Raises
    ------
    MocapError : for legs that are not found, a clip in which no foot ever stands, and as for `retarget`.

    Warns
    -----
    MocapWarning : as for `retarget`, and `stance_of`.

    Examples
    --------
    A body of 70 % of the size:

    >>> from dataclasses import replace
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:240]
    >>> child = replace(walk.skeleton, offsets=0.7 * walk.skeleton.offsets)
    >>> worn = wear(walk, child)
    >>> round(float(worn.root_positions[:, 1].mean() / walk.root_positions[:, 1].mean()), 1)
    0.7
    """
    motion = with_plants(motion)
    source = stance_of(motion, clips=clips)
    if isinstance(body, Skeleton):
        ratio = stance_of_zero(body, 0.0).leg / source.leg
        body = stance_of_zero(body, ratio * source.height("ball"))
    return retarget(motion, body, source)


def floor_pins(motion: Motion, stance: Stance) -> Pins:
    """Hold each plant at the height that its joint stands at.

    Feet differ: an ankle stands 4 cm over the ball in one body and 8 cm in another. So plants take their
    heights from how the new body stands, not from the old feet. A plant's place over the ground is the mean
    over its frames [Gle98]. The floor is level, at y = 0: a plant on a step comes down to it.

    Parameters
    ----------
    motion : the copied motion; its `contacts` say when ankles and balls stand.
    stance : how its body stands.

    Raises
    ------
    MocapError : for marks that are missing.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> upstairs = replace(walk, root_positions=walk.root_positions + [0, 0.2, 0])
    >>> ankle = floor_pins(upstairs, stance_of(walk)).low[:, 0, 1]  # held at one height, or free
    >>> np.unique(ankle[np.isfinite(ankle)]).round(3)
    array([0.068])

    Notebook: 13-retargeting
    """
    return plant_pins(motion, stance.legs, np.reshape([stance.heights[role] for role in FEET], (2, 2)))


def lowest_worn(positions: Array, ratio: float, joints: int) -> Array:
    """Compute how low the joints of another body may be, (F, joints), metres.

    They may be on the floor, y = 0, or as far under it as the lowest joint of the source is in that frame, in
    proportion to the legs.

    Parameters
    ----------
    positions : of the source's joints, (F, J, 3), metres.
    ratio : of the length of the new legs to that of the old ones.
    joints : how many joints the other body has.

    Examples
    --------
    >>> lowest_worn(np.array([[[0.0, 0.02, 0.0]], [[0.0, -0.02, 0.0]]]), 0.5, 2)
    array([[ 0.  ,  0.  ],
           [-0.01, -0.01]])
    """
    lowest = np.minimum(ratio * positions[..., 1].min(axis=1), 0.0)
    return np.repeat(lowest[:, None], joints, axis=1)


def floor_under(positions: Array, source: Stance, body: Stance) -> Pins:
    """Keep ankles and balls above where they stand, or as far below as they ever were, for the body's size.

    They are no farther under the floor at y = 0 than they ever were. `positions` (F, J, 3), metres, are those
    of the source's joints.
    """
    lowest = positions[..., 1].min(axis=0)
    sides = [side for side, leg in zip(SIDES, body.legs, strict=True) if not leg.has_ball]
    feet = [role for role in FEET if role not in [f"{side} ball" for side in sides]]
    high = np.full((len(positions), len(feet), 3), np.inf)
    low = -high
    for column, role in enumerate(feet):
        dip = max(0.0, source.heights[role] - lowest[source.roles[role]])
        low[:, column, 1] = body.heights[role] - dip * body.leg / source.leg
        depth = body.leg / source.leg * min(0.0, lowest[source.roles[role]])
        low[:, column, 1] = np.maximum(low[:, column, 1], depth)
    return Pins(tuple(body.roles[role] for role in feet), low, high)
