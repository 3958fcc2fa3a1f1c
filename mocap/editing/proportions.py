"""Bodies of other proportions."""

from dataclasses import replace

import numpy as np

from mocap._shared.quantities import described
from mocap.body.limbs import FEET
from mocap.editing.stances import Stance
from mocap.errors import MocapError


def proportioned(
    stance: Stance, *, legs: float = 1.0, trunk: float = 1.0, arms: float = 1.0, head: float = 1.0
) -> Stance:
    """Scale the legs, the trunk, the arms and the head of a body, such as to the proportions of a child.

    Parameters
    ----------
    stance : of the body.
    legs, trunk, arms, head : factors of lengths. The legs are all below the hips, the arms all below the
        shoulders, the head all above the first joint of the neck; the rest is the trunk.

    Returns
    -------
    The stance of the new body. The heights of its ankles and balls are scaled as its legs.

    Raises
    ------
    MocapError : for a factor that is not above 0.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing import stance_of
    >>> adult = stance_of(sample("walk_straight"))
    >>> child = proportioned(adult, legs=0.55, trunk=0.62, arms=0.58, head=0.85)
    >>> round(child.leg / adult.leg, 3)
    0.55
    >>> bool((proportioned(adult).points == adult.points).all())  # the same body
    True

    Notebook: 13-retargeting
    """
    if not isinstance(stance, Stance):
        remedy = "editing.stance_of(motion) finds one"
        raise MocapError(f"This takes a Stance, how a body stands, got {described(stance)}: {remedy}.")
    for name, factor in {"legs": legs, "trunk": trunk, "arms": arms, "head": head}.items():
        if not (np.isfinite(factor) and factor > 0):
            raise MocapError(f"The factor of the {name} must be above 0, got {factor}.")
    skeleton = stance.skeleton
    factor_below = {"hip": legs, "shoulder": arms, "neck": head}
    limbs = {joint: factor_below.get(role.split()[-1], 0) for role, joint in stance.roles.items()}
    factors = np.full(len(skeleton), float(trunk))
    for joint, parent in enumerate(skeleton.parents[1:], start=1):  # parents come before their children
        factors[joint] = limbs.get(parent) or factors[parent]
    body = replace(skeleton, offsets=skeleton.offsets * factors[:, None])
    return Stance(body, stance.roles, stance.turns, {role: legs * stance.heights[role] for role in FEET})
