"""Left and right limbs joint by joint: which joints are mirror images of each other."""

from collections.abc import Sequence

import numpy as np

from mocap.body.limbs import SIDES, joints_of_limbs, other_side
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError

SIMILAR = 0.1  # of the longer bone: the largest difference of the bones of fingers that are mirror images


def limb_partners(skeleton: Skeleton) -> dict[int, int]:
    """Pair the joints of left and right limbs by their roles, {left joint: right joint}.

    Joints between those with roles, such as clavicles, are paired too, and the joints below, such as fingers,
    in the order of the tree. Others, such as a sword, are not paired; without limbs there are no pairs.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> pairs = limb_partners(SKELETON)
    >>> {SKELETON.names[left]: SKELETON.names[right] for left, right in [*pairs.items()][:3]}
    {'lfemur': 'rfemur', 'lhipjoint': 'rhipjoint', 'ltibia': 'rtibia'}
    """
    try:
        joints = joints_of_limbs(skeleton)
    except MocapError:
        return {}
    pairs: dict[int, int] = {}
    for role, joint in joints.items():
        image = joints.get(other_side(role), joint)
        if role.startswith(SIDES[0]):
            pairs |= _paired_paths(skeleton, joint, image)
    open_pairs = [*pairs.items()]
    for joint, image in open_pairs:
        below = [child for child in skeleton.children(joint) if child not in pairs]
        images = [child for child in skeleton.children(image) if child not in pairs.values()]
        new_pairs = _paired_children(skeleton, below, images)
        pairs |= new_pairs
        open_pairs += new_pairs.items()
    return pairs


def _paired_children(skeleton: Skeleton, below: Sequence[int], images: Sequence[int]) -> dict[int, int]:
    """Pair the joints below two partners, in the order of the tree.

    If one side has further joints, such as a sword, only joints with similar bones are paired.
    """
    if len(below) == len(images):
        return dict(zip(below, images, strict=True))
    pairs: dict[int, int] = {}
    for joint in below:
        free = [image for image in images if image not in pairs.values()]
        image = next((image for image in free if _are_similar(skeleton, joint, image)), None)
        if image is not None:
            pairs[joint] = image
    return pairs


def _are_similar(skeleton: Skeleton, joint: int, image: int) -> bool:
    """Check whether two joints have bones of nearly the same length and as many joints below them."""
    lengths = np.linalg.norm(skeleton.offsets[[joint, image]], axis=1)
    paths = [skeleton.path_to_root(end) for end in range(len(skeleton))]
    counts = [sum(top in path for path in paths) for top in (joint, image)]
    return bool(np.ptp(lengths) <= SIMILAR * lengths.max()) and counts[0] == counts[1]


def _paired_paths(skeleton: Skeleton, joint: int, image: int) -> dict[int, int]:
    """Pair two joints, and those above them up to the last joint that both hang on."""
    path = skeleton.path_to_root(joint)
    path_of_image = skeleton.path_to_root(image)
    above = [ancestor for ancestor in path if ancestor not in path_of_image]
    above_image = [ancestor for ancestor in path_of_image if ancestor not in path]
    return dict(zip(above, above_image, strict=True)) if len(above) == len(above_image) else {}
