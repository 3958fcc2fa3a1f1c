"""The feet of a skeleton: its legs, the ankles with all joints below them, and the tips of its toes."""

from mocap._shared.records import NamedTuple
from mocap.body.legs import Leg
from mocap.body.limbs import find_legs, with_roles
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.errors import MocapError


class Feet(NamedTuple):
    """The feet of a skeleton.

    Parameters
    ----------
    legs : both legs; none for a body without legs.
    tips : of each leg, the joints that end its toes.
    joints : the ankles and all joints below them.

    Examples
    --------
    >>> Feet((Leg(2, 3, 4, 5),), ([6],), [4, 5, 6]).legs[0].ankle
    4
    """

    legs: tuple[Leg, ...]
    tips: tuple[list[int], ...]
    joints: list[int]


def feet_of(motion: Motion) -> Feet:
    """Find the feet of a motion's skeleton; none for a body without legs.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> [walk.skeleton.names[joint] for joint in feet_of(walk).joints]
    ['lfoot', 'ltoes', 'ltoes_end', 'rfoot', 'rtoes', 'rtoes_end']
    """
    try:
        skeleton = with_roles(motion).skeleton
        legs = find_legs(skeleton)
    except MocapError:
        return Feet((), (), [])
    ankles = {leg.ankle for leg in legs}
    joints = [joint for joint in range(len(skeleton)) if ankles & {*skeleton.path_to_root(joint)}]
    return Feet(legs, tuple(toe_tips(skeleton, leg) for leg in legs), joints)


def toe_tips(skeleton: Skeleton, leg: Leg) -> list[int]:
    """List the joints that end the toes of a leg: those below its ball that have no joint below them.

    Examples
    --------
    >>> from mocap.datasets.samples import SKELETON
    >>> [SKELETON.names[tip] for leg in find_legs(SKELETON) for tip in toe_tips(SKELETON, leg)]
    ['ltoes_end', 'rtoes_end']
    """
    if not leg.has_ball:
        return []
    below = [joint for joint in range(len(skeleton)) if leg.ball in skeleton.path_to_root(joint)[1:]]
    return [joint for joint in below if not skeleton.children(joint)]
