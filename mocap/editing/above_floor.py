"""The one pass of all edits: constraints are solved for, toes bend, and joints stay above a floor.

`edit`, `retargeting.retarget` and `foot_cleaning.keep_above_floor`, which `bend` calls, differ in how they
solve and in the heights that they allow. They hand both to `meet_above_floor`.
"""

from collections.abc import Callable, Sequence

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.body.foot_joints import Feet
from mocap.editing.bodies import Body
from mocap.editing.constraint_checks import require_reachable
from mocap.editing.constraints import Pins
from mocap.editing.pins import join_pins
from mocap.editing.poses import Poses
from mocap.editing.solver import EVERY_FRAME, solve_stages
from mocap.editing.stages import Stage
from mocap.editing.toes import SLACK, bend_toes


class Heights(NamedTuple):
    """The lowest heights that are allowed after an edit.

    Parameters
    ----------
    feet : the toes that bend.
    toes : shape (F, J), metres, for the tips of the toes.
    floor : shape (F, J), metres, for all joints: those that are lower even with bent toes are raised.
    watched : joints that are kept above the floor when any joint is raised, also if they are not too low.
    tolerance : metres. Joints that are lower by less stay as they are.
    """

    feet: Feet
    toes: Array
    floor: Array
    watched: Sequence[int] = ()
    tolerance: float = SLACK


class Solving(NamedTuple):
    """The way in which an edit solves for its constraints.

    Parameters
    ----------
    stages : of the solver.
    body_for : returns the joints that may rotate to meet constraints, and their prices.
    frames : those that may change, a single range.
    first_frame : the number of the first frame in the clip, which errors count from.
    """

    stages: Sequence[Stage]
    body_for: Callable[[Pins], Body]
    frames: slice = EVERY_FRAME
    first_frame: int = 0

    def solve(self, base: Poses, pins: Pins) -> Poses:
        """Change a motion so that it meets constraints, both of F frames."""
        require_reachable(base.motion, pins, self.first_frame)
        return solve_stages(base, pins, self.stages, self.body_for(pins), self.frames).poses


def meet_above_floor(
    base: Poses, pins: Pins, solving: Solving, heights: Heights, solved: Poses | None = None
) -> Poses:
    """Change a motion so that it meets constraints, and no joint is lower than allowed.

    The constraints are solved for. Then toes bend. If joints are still too low, the constraints are solved
    for again, together with a floor, and toes bend again.

    Parameters
    ----------
    base, pins : F frames.
    solving : how the constraints are solved for.
    heights : the heights that are allowed.
    solved : a motion that meets the constraints, if there is one already.
    """
    if solved is None:
        solved = solving.solve(base, pins)
    bent = solved.updated(bend_toes(solved, heights.toes, heights.feet))
    floor = floor_for(bent, heights)
    if floor.errors(bent).max(initial=0.0) <= heights.tolerance:
        return bent
    raised = solving.solve(base, join_pins(floor, pins))
    return raised.updated(bend_toes(raised, heights.toes, heights.feet))


def floor_for(poses: Poses, heights: Heights) -> Pins:
    """Return constraints that keep watched joints, and all that are too low, above their heights.

    Examples
    --------
    >>> from mocap.body.foot_joints import feet_of
    >>> from mocap.datasets import sample
    >>> from mocap.editing.poses import poses_of
    >>> walk = sample("walk_straight")[:9]
    >>> head = walk.skeleton.index("head")
    >>> floor = np.zeros((9, 38))
    >>> floor[:, head] = 1.8  # metres, higher than the head is
    >>> floor_for(poses_of(walk), Heights(feet_of(walk), floor, floor)).joints == (head,)
    True
    """
    is_low = (poses.positions[..., 1] < heights.floor - 2 * SLACK).any(axis=0)
    joints = sorted({*heights.watched, *np.flatnonzero(is_low).tolist()})
    low = np.full((len(poses), len(joints), 3), -np.inf)
    low[..., 1] = heights.floor[:, joints]
    return Pins(joints, low, np.full_like(low, np.inf))
