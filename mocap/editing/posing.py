"""A key's pose, made by dragging joints: one frame, its other joints following.

[WP95] let an animator set a pose's angles. Here joints are put to places, and the solver turns the joints
above them [ours].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.bodies import Body, body_of, require_reachable
from mocap.editing.pins import Pins, join_pins, pin, plant_pins
from mocap.editing.solver import solve
from mocap.editing.steps import Basis
from mocap.errors import MocapError

# With this weight a key is met to a hundredth of a millimetre. A root that is held asks for about 40 passes,
# other poses for 7.
POSE = Basis(weight=3000.0, damping=1e-3, passes=60)
HEAVY = 1e10  # how many times its price a metre of a root costs that is held

# How many times their prices the root and the joints of the trunk cost. With 1 the trunk leans by 30° so that
# a hand moves by 30 cm, and the arm hardly turns; people move the arm first.
TRUNK = 16.0


def posed(
    motion: Motion,
    frame: int,
    places: Mapping[str, ArrayLike],
    *,
    feet: bool = True,
    still: Sequence[str] = (),
) -> Motion:
    """Drag joints to places in one frame, and let the rest of the body follow as little as it can.

    Parameters
    ----------
    motion : F frames; the whole clip shows which joints turn, and which are hinges.
    frame : which one.
    places : {joint: (x, y, z)}, metres; NaN leaves an axis free.
    feet : keep the feet that stand in this frame where they stand; asks for the motion's `contacts`.
    still : the names of joints that shall not turn; with "root" among them the root does not move either.

    Returns
    -------
    The pose: a motion of one frame, for a `Key`.

    Raises
    ------
    MocapError : for a frame or joints that are not there, places out of reach, and missing contacts.

    Warns
    -----
    MocapWarning : for places that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")
    >>> hand = joint_positions(walk[100:101])[0, walk.skeleton.index("lhand")]
    >>> pose = posed(walk, 100, {"lhand": hand + [0, 0.2, 0]})
    >>> float((joint_positions(pose)[0, walk.skeleton.index("lhand")] - hand).round(4)[1])
    0.2

    Notebook: 11-warping
    """
    if not (isinstance(frame, int | np.integer) and 0 <= frame < len(motion)):
        raise MocapError(f"Frame {frame} is none of '{motion.name}', which has {len(motion)}.")
    if not places:
        raise MocapError("A pose needs one joint or more to drag, got none.")
    dragged = [pin(motion, joint, [frame], *_box(place)) for joint, place in places.items()]
    standing = [_standing(motion).only([frame])] if feet else []
    pins = join_pins(*standing, *dragged)
    require_reachable(motion, pins)
    body = _body(motion, pins.joints, tuple(still))
    now = replace(motion[frame : frame + 1], name=f"{motion.name}[{frame}]")
    return replace(solve(now, pins.at([frame]), [POSE], body).motion, name=motion.name)


@lru_cache(maxsize=1)
def _standing(motion: Motion) -> Pins:
    """Pin the plants of a clip; kept, because a joint that is dragged asks for the same ones many times."""
    return plant_pins(motion)


@lru_cache(maxsize=1)
def _body(motion: Motion, pinned: tuple[int, ...], still: tuple[str, ...]) -> Body:
    """Choose the joints that turn; a root that is still does not move either."""
    body = body_of(motion, pinned, prices=dict.fromkeys(_trunk(motion.skeleton), TRUNK), still=still)
    root = HEAVY if motion.skeleton.names[0] in still else TRUNK
    return body._replace(price=np.append(root * body.price[:3], body.price[3:]))


def _trunk(skeleton: Skeleton) -> list[str]:
    """Name the joints with a third of the body, or more, below them; a leg or an arm has less."""
    below = np.ones(len(skeleton))
    for joint in range(len(skeleton) - 1, 0, -1):  # a parent stands before its children
        below[skeleton.parents[joint]] += below[joint]
    return [name for name, share in zip(skeleton.names, below / len(skeleton), strict=True) if share > 1 / 3]


def _box(place: ArrayLike) -> tuple[Array, Array]:
    """Hold the axes that are numbers, and free those that are NaN."""
    given = np.asarray(place, float)
    return np.where(np.isnan(given), -np.inf, given), np.where(np.isnan(given), np.inf, given)
