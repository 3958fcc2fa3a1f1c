"""Mirror images of motions, in which the left and the right side are exchanged.

With the reflection H of the body at rest, a rotation L becomes H L H, by the opposite angle about the
mirrored axis. That is enough for a symmetric skeleton with symmetric axes. In general a bone at rest is not
the mirror image of its partner: captured bodies are lopsided, and in files of some programs all bones point
along their own x. Therefore each joint also has a constant rotation K, which aligns the bones of its partner
with the mirror images of its own. The method is ours.
"""

import re
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.body import body_sides, rotations
from mocap.body.foot_joints import feet_of
from mocap.body.limb_partners import limb_partners
from mocap.body.limbs import roles, with_roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.poses import poses_of
from mocap.editing.toes import SLACK, bend_toes, lowest_allowed
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError, shortened, warn

PAIRED = 1e-3  # metres between a joint and its partner at rest, to show which way is left
IN_PLANE = 0.1  # of the ridge, for a direction in the plane, if bones are opposite
TINY = 1e-12  # square metres, for joints without bones
ROUNDS = 2  # in which what bones determine becomes exact
ACROSS = np.array([1.0, 0.0, 0.0])  # the world is mirrored in the plane x = 0
UP = np.array([0.0, 1.0, 0.0])
ENDING = "_mirrored"
OPPOSITE = {"left": "right", "right": "left", "Left": "Right", "Right": "Left"}


def symmetry(skeleton: Skeleton) -> tuple[NDArray[np.intp], Array, Array]:
    """Find the mirror symmetry of a skeleton: the partners of joints, and the plane between them.

    Partners are found by the sides in names, or else by the roles of limbs.

    Returns
    -------
    The partner of each joint (J,), itself for a joint in the middle; the unit vector from right to left in
    the body at rest, (3,); quaternions K (J, 4), which align the bones of the partner with the mirror images
    of the bones of each joint.

    Raises
    ------
    MocapError : for a skeleton without left and right limbs, or whose sides have different joints.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> symmetry(SKELETON)[1].tolist()
    [1.0, 0.0, 0.0]
    """
    joints = range(len(skeleton))
    parents = skeleton.parents
    images = body_sides.partners(skeleton)
    by_role = limb_partners(skeleton) if images == [*joints] else {}
    partners = np.array(images)
    for joint, partner in by_role.items():
        partners[joint] = partner
        partners[partner] = joint
    is_symmetric = partners[partners] == joints
    is_symmetric[1:] &= partners[parents[1:]] == parents[partners[1:]]
    is_symmetric |= props(skeleton, partners)
    if not is_symmetric.all():
        name = shortened(skeleton.names[int(is_symmetric.argmin())], 40)
        raise MocapError(f"'{name}' has no mirror image: its side has other joints than the other.")
    distances = skeleton.rest - skeleton.rest[partners]
    pairs = np.flatnonzero((partners < joints) & (np.linalg.norm(distances, axis=1) > PAIRED))
    if not len(pairs):
        raise MocapError(f"No left and right joints here: {shortened(', '.join(skeleton.names), 100)}.")
    across = distances[pairs[0]] / np.linalg.norm(distances[pairs[0]])
    first = int(pairs[0])
    is_left = first in by_role if by_role else body_sides.sides(skeleton)[first] == "left"
    across *= 1 if is_left else -1
    axis = int(np.abs(across).argmax())
    if abs(across[axis]) > np.cos(TUNED.mirror_axis):
        across = np.sign(across[axis]) * np.eye(3)[axis] + 0.0
    return partners, across, _turns(skeleton, partners, across)


def props(skeleton: Skeleton, partners: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return whether each joint is of a prop that only one side has, such as a sword in one hand, (J,).

    A prop begins at a joint without a partner below a joint that has one. It has no role in the body.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> bool(props(SKELETON, symmetry(SKELETON)[0]).any())
    False
    """
    in_prop = np.zeros(len(skeleton), dtype=bool)
    for joint, parent in enumerate(skeleton.parents[1:], 1):
        is_paired = partners[parent] != parent
        in_prop[joint] = partners[joint] == joint and (is_paired or in_prop[parent])
    try:
        in_body = list(roles(skeleton).values())
    except MocapError:
        in_body = list(range(len(skeleton)))
    # What a joint with a role hangs from is of the body too.
    for joint in in_body:
        in_prop[skeleton.path_to_root(joint)] = False
    return in_prop


def _turns(skeleton: Skeleton, partners: NDArray[np.intp], across: Array) -> Array:
    """Compute K of each joint: the rotation that maximises Σ H o · K o', with bones o and the partner's o'.

    A single bone does not determine the rotation about itself. Then K is near 1, for axes that are mirror
    images, or near -H, for axes that are opposite; if both fit, it is as for the parent. Otherwise the same
    bend of a knee would have other angles, and a blend of both would rotate it by a full turn.
    """
    mirror = _reflection(across)
    upward = np.cross(across, np.roll(across, 1))  # any direction in the plane, for bones that are opposite
    matrices = np.zeros((len(skeleton), 3, 3))
    for child in np.flatnonzero(~props(skeleton, partners))[1:]:
        bone = mirror @ skeleton.offsets[child]
        matrices[skeleton.parents[child]] += np.outer(bone, skeleton.offsets[partners[child]])
    usual = np.tile(np.eye(3), (len(skeleton), 1, 1))
    for joint, matrix in enumerate(matrices):
        advantage = np.sum((np.eye(3) + mirror) * matrix)  # of 1 over -H
        if abs(advantage) > TUNED.mirror_margin * np.linalg.norm(matrix):
            usual[joint] = np.eye(3) if advantage > 0 else -mirror
        elif joint:
            usual[joint] = usual[skeleton.parents[joint]]
    ridge = TUNED.mirror_ridge * np.linalg.norm(matrices, axis=(-2, -1), keepdims=True) + TINY
    turns = rotations.nearest(matrices + ridge * (usual + IN_PLANE * np.outer(upward, upward)))
    for _ in range(ROUNDS):
        turns = rotations.nearest(matrices + ridge * turns)
    # A joint without bones has K of its parent. Then an end that never rotates does not in the mirror image.
    for joint in range(1, len(skeleton)):
        if not skeleton.children(joint):
            turns[joint] = turns[skeleton.parents[joint]]
    return rotations.from_matrix(turns)


def mirrored_name(name: str) -> str:
    """Return the name of the mirror image of a clip; of a mirror image, the name of the clip.

    Examples
    --------
    >>> mirrored_name("walk"), mirrored_name("walk_mirrored")
    ('walk_mirrored', 'walk')
    """
    return name.removesuffix(ENDING) if name.endswith(ENDING) else name + ENDING


def mirrored_label(name: str) -> str:
    """Return the label of a mirror image: the words left and right change places.

    Examples
    --------
    >>> mirrored_label("turn left"), mirrored_label("walk")
    ('turn right', 'walk')
    """
    return re.sub("|".join(OPPOSITE), lambda word: OPPOSITE[word[0]], name)


def mirror(motion: Motion) -> Motion:
    """Mirror a motion, in the body and on the ground: x becomes -x.

    A rotation L of joint j becomes K_p⁻¹ (H L H) K_j of its partner, with p its parent: a rotation by θ about
    the axis v becomes one by θ about -H v. The mirror image of the mirror image is the motion itself.

    Parameters
    ----------
    motion : F frames.

    Returns
    -------
    The mirror image, of the same skeleton: bones keep their lengths. Contacts change sides, and so do the
    words left and right in labels.

    Raises
    ------
    MocapError : as for `symmetry`.

    Warns
    -----
    MocapWarning : if a bone and its partner differ by more than 1 cm, with the bone and the difference; for a
        prop that only one side has, which stays on its side, and is held as it was.

    Examples
    --------
    >>> from mocap.body import heading
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_curve_1")
    >>> headings = [heading(clip.rotations[600, 0]) for clip in (walk, mirror(walk))]
    >>> bool(abs(sum(headings)) < 1e-9), mirror(walk).name
    (True, 'walk_curve_1_mirrored')
    """
    skeleton = with_roles(motion).skeleton
    partners, across, turns = symmetry(skeleton)
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    gaps = np.abs(lengths - lengths[partners])
    if gaps.max() > TUNED.lopsided:
        difference = f"{1e3 * gaps.max():.0f} mm ({shortened(skeleton.names[gaps.argmax()], 40)})"
        differ = f"'{shortened(motion.name, 60)}': left and right bones differ by up to {difference}"
        warn(f"{differ}, so its mirror image does not reach as far.")
    held = props(skeleton, partners)
    if held.any():
        prop = shortened(skeleton.names[int(held.argmax())], 40)
        warn(f"'{shortened(motion.name, 60)}': only one side has '{prop}', which stays there.")
    parent_turns = rotations.inverse(turns[skeleton.parents])
    parent_turns[0] = rotations.from_matrix(_reflection(ACROSS) @ _reflection(across))
    vectors = -motion.rotations[..., 1:] @ _reflection(across)  # (w, v) becomes (w, -H v)
    flipped = np.concatenate([motion.rotations[..., :1], vectors], axis=-1)
    local = rotations.multiply(parent_turns, rotations.multiply(flipped, turns))
    labels = {mirrored_label(name): mark for name, mark in motion.labels.items()}
    names = dict(zip(skeleton.names, (skeleton.names[joint] for joint in partners), strict=True))
    contacts = {names[joint]: mark for joint, mark in motion.contacts.items()}
    root_positions = motion.root_positions @ _reflection(ACROSS)
    name = mirrored_name(motion.name)
    local = np.where(held[:, None], motion.rotations, local[:, partners])
    mirrored = replace(motion, root_positions=root_positions, rotations=local, name=name)
    return replace(mirrored, labels=labels, contacts=contacts)


def mirror_above_floor(motion: Motion) -> Motion:
    """Mirror a motion, and keep a body whose legs differ in length above the floor.

    Toes bend as in `toes.bend_toes`. If that is not enough, the whole motion is raised, so that no joint is
    farther below the floor, y = 0, than the lowest joint of the motion.

    Parameters
    ----------
    motion : F frames.

    Raises
    ------
    MocapError : as for `symmetry`.

    Warns
    -----
    MocapWarning : as for `mirror`.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_curve_1")[:120]
    >>> bool((mirror_above_floor(walk).rotations == mirror(walk).rotations).all())  # its legs are alike
    True
    """
    partners, *_ = symmetry(with_roles(motion).skeleton)
    poses = poses_of(motion)
    mirrored = poses_of(mirror(motion))
    feet = feet_of(mirrored.motion)
    allowed = lowest_allowed(poses, feet)[:, partners]
    bent = mirrored.updated(bend_toes(mirrored, allowed, feet))
    lowest = min(0.0, float(poses.positions[..., 1].min()))
    rise = lowest - float(bent.positions[..., 1].min())
    if rise <= SLACK:
        return bent.motion
    return replace(bent.motion, root_positions=bent.motion.root_positions + rise * UP)


def _reflection(across: Array) -> Array:
    """Return the reflection in the plane perpendicular to a unit vector, (3, 3)."""
    return np.eye(3) - 2 * np.outer(across, across)
