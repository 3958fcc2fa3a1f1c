"""A body with other proportions: a child has short legs and a large head."""

import numpy as np

from mocap.body.skeleton import Skeleton
from mocap.editing.body_roles import FEET
from mocap.editing.upright_bodies import Stance
from mocap.errors import MocapError


def proportioned(
    stance: Stance, *, legs: float = 1.0, trunk: float = 1.0, arms: float = 1.0, head: float = 1.0
) -> Stance:
    """Make the legs, the trunk, the arms and the head of a body longer or shorter.

    Parameters
    ----------
    stance : how the body stands.
    legs, trunk, arms, head : new lengths as shares of the old ones. The legs are all below the hips, the arms
        all below the shoulders, the head all above the neck's first joint; the rest is the trunk.

    Returns
    -------
    How the new body stands; its ankles and balls are as high as its legs are long.

    Raises
    ------
    MocapError : for a share that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import stance_of_walk
    >>> adult = stance_of_walk(sample("walk_straight"))
    >>> child = proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    >>> round(child.leg / adult.leg, 3)
    0.55

    Notebook: 13-retargeting
    """
    given = {"legs": legs, "trunk": trunk, "arms": arms, "head": head}
    for name, share in given.items():
        if not (np.isfinite(share) and share > 0):
            raise MocapError(f"The share of the {name} must be above 0, got {share}.")
    parts = [("legs", "hip"), ("arms", "shoulder")]
    tops = {stance.roles[f"{side} {part}"]: name for name, part in parts for side in ("left", "right")
            if f"{side} {part}" in stance.roles}  # fmt: skip
    tops |= {stance.roles["neck"]: "head"} if "neck" in stance.roles else {}
    old = stance.skeleton
    shares = np.full(len(old), float(trunk))
    for joint in range(1, len(old)):
        over = [tops[above] for above in old.path_to_root(joint)[1:] if above in tops]
        shares[joint] = given[over[0]] if over else trunk
    body = Skeleton(old.names, old.parents, old.offsets * shares[:, None], old.axes, old.dofs)
    return Stance(body, stance.roles, stance.turns, {role: legs * stance.heights[role] for role in FEET})
