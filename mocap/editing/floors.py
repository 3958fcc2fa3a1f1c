"""Where a retargeted body's feet may be: on the floor, each plant in one place, and never far below.

Feet differ: an ankle stands 4 cm over the ball in one body and 8 cm in another. So plants take their heights
from how the new body stands, not from the old feet.
"""

from collections.abc import Mapping

import numpy as np

from mocap.body.kinematics import joint_positions
from mocap.body.motion import Motion
from mocap.editing.body_roles import FEET
from mocap.editing.pins import Pins, join_pins, pin
from mocap.editing.upright_bodies import Stance
from mocap.feet.ankle_targets import place_plants
from mocap.feet.footskate import settled_marks


def floor_pins(motion: Motion, stance: Stance, dips: Mapping[str, float] | None = None) -> Pins:
    """Hold each plant at the height that its joint stands at, and keep feet above the floor.

    A plant's place over the ground is the mean over its frames [Gle98]; of an ankle and a ball that stand
    together, as far apart as the flat foot is long. The floor is level, at y = 0: a plant on a step comes
    down to it.

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
    >>> from mocap.editing.stances import stance_of_walk
    >>> walk = sample("walk_straight")
    >>> pins = floor_pins(walk, stance_of_walk(walk))
    >>> ankle = pins.low[:, 0, 1]  # held at one height, or free
    >>> np.unique(ankle[np.isfinite(ankle)]).round(3)
    array([0.068])

    Notebook: 13-retargeting
    """
    positions, several = joint_positions(motion), []
    settled = settled_marks(motion, stance.legs)
    for side, leg, marks in zip(("left", "right"), stance.legs, settled, strict=True):
        joints, heights = (
            (leg.ankle, leg.ball),
            [stance.heights[f"{side} {part}"] for part in ("ankle", "ball")],
        )
        length = float(leg.lengths(motion.skeleton)[2])
        on_ground = positions[:, joints] * [1, 0, 1]
        level = np.sqrt(length**2 - (heights[0] - heights[1]) ** 2)
        places = place_plants((on_ground[:, 0], on_ground[:, 1]), (marks[0], marks[1]), level)
        places[..., 1] = np.array(heights)[:, None]
        several += [pin(motion, j, mark, at[mark]) for j, mark, at in zip(joints, marks, places, strict=True)]
    return join_pins(*_floors(motion, stance, dips or {}), *several)


def _floors(motion: Motion, stance: Stance, dips: Mapping[str, float]) -> list[Pins]:
    """Keep ankles and balls above the floor in all frames."""
    free = np.full(3, np.inf)
    return [
        pin(motion, stance.roles[role], slice(None), [-np.inf, stance.heights[role] - dip, -np.inf], free)
        for role, dip in dips.items()
    ]


def dips_of(motion: Motion, stance: Stance) -> dict[str, float]:
    """Measure how far each ankle and ball ever is below where it stands, metres by role, 0 or more.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.stances import stance_of_walk
    >>> walk = sample("walk_straight")
    >>> max(dips_of(walk, stance_of_walk(walk)).values()) < 0.01
    True
    """
    lowest = joint_positions(motion)[..., 1].min(axis=0)
    return {role: max(0.0, stance.heights[role] - float(lowest[stance.roles[role]])) for role in FEET}
