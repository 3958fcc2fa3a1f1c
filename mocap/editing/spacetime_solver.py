"""All frames at once: the smoothest small change that meets the pins [Gle98].

The change is a spline, x = B c, and the sum over the frames f

    Σ_f x_fᵀ M x_f + w² Σ ‖gap‖²

is least: M holds the body's prices, and w is a weight. [Gle98] has Lagrange multipliers in place of the
weight; the weight, which rises in steps, is ours. The splines of two control points overlap only if they are
at most 3 apart, so the normal equations are banded, and the time is linear in F.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.linear_bodies import Body, linear
from mocap.editing.pins import Pins
from mocap.editing.reaching import Solved, cost, normal_equations, pared, ready, warn_of_gaps
from mocap.errors import MocapError

# Shares of the weight, one after the other. A bar under which a body ducks, with the weight at once: 69 mm
# are left after 4 passes, with accelerations 1.7 times as large, and 21 mm after 8. Pins that hold need fewer
# steps.
RAMP, SHORT_RAMP = (0.03, 0.1, 0.3, 1.0), (0.3, 1.0)

# At most, at each share and at the last one, which may need more where a foot steps high.
PASSES, LAST = 4, 8

# Share of the prices by which a pass is damped at first. With 0.1 the bar leaves 6 mm, not 0.5.
DAMPING = 1.0

# Share of the cost: what a pass must gain, or the next share's turn comes.
GAIN = 1e-3

# Of the largest diagonal: a clip of fewer frames than control points leaves some of them unseen.
RIDGE = 1e-10

KNOTS = 0.125  # seconds
WEIGHT = 300.0


def spacetime(
    base: Motion, pins: Pins, body: Body | None = None, *, knots: float = KNOTS, weight: float = WEIGHT
) -> Solved:
    """Bring joints to their pins by the smallest smooth change of the whole motion [Gle98, objective].

    Steps of Levenberg and Marquardt on the control points c of x = B c; the least of
    Σ_f x_fᵀ M x_f + w² Σ ‖gap‖². The time grows with the frames.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    body : which joints turn, at what price; `body_of(base, pins.joints)` by default.
    knots : seconds between knots: 0.5 s leaves centimetres, 0.125 s millimetres; below, accelerations grow.
    weight : w, per metre. 100 leaves 10 mm on a stone of 20 cm, 300 leaves 3 mm, 1000 no less.

    Returns
    -------
    A motion whose pins are met to millimetres; `edit` closes the rest. Without pins the motion as it is.

    Raises
    ------
    MocapError : for pins of another motion, pins that no pose can meet, knots or a weight not above 0.

    Warns
    -----
    MocapWarning : for pins that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import pin, plant_pins, join_pins
    >>> from mocap.body.kinematics import joint_positions
    >>> walk = sample("walk_straight")[:120]
    >>> hand = joint_positions(walk)[60, walk.skeleton.index("lwrist")]
    >>> wishes = join_pins(plant_pins(walk), pin(walk, "lwrist", [60], hand + [0, 0.2, 0]))
    >>> spacetime(walk, wishes).worst[-1] < 0.005
    True

    Notebook: 13-retargeting
    """
    body = ready(base, pins, body, weight)
    solved = solved_in_time(base, pins, body, (knots, weight))
    warn_of_gaps(solved.motion, pins)
    return solved


def refined(
    base: Motion,
    pins: Pins,
    body: Body | None = None,
    *,
    knots: Sequence[float] = (0.5, 0.25, 0.125),
    weight: float = WEIGHT,
) -> Motion:
    """Solve with few knots first, then from there with more: the paper's last step [Gle98, finer knots].

    Parameters
    ----------
    base, pins, body, weight : as for `spacetime`.
    knots : seconds between knots, solve after solve.

    Raises
    ------
    MocapError : as for `spacetime`, and for no knots.

    Warns
    -----
    MocapWarning : for pins that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.editing.pins import plant_pins
    >>> walk = sample("walk_straight")[:120]
    >>> pins = plant_pins(walk)
    >>> float(abs(refined(walk, pins).root_positions - walk.root_positions).max().round(6))
    0.0

    Notebook: 14-levels
    """
    motion = solved_again(base, pins, ready(base, pins, body, weight), knots, weight)
    warn_of_gaps(motion, pins)
    return motion


def solved_again(base: Motion, pins: Pins, body: Body, knots: Sequence[float], weight: float) -> Motion:
    """Solve with each spacing of knots from where the one before ended, without a word on what is left."""
    if not len(knots):
        raise MocapError("To solve takes knots: give the seconds between them, solve after solve.")
    for number, seconds in enumerate(knots):
        base = solved_in_time(base, pins, body, (seconds, weight), again=number > 0).motion
    return base


def solved_in_time(
    base: Motion, pins: Pins, body: Body, knots_and_weight: tuple[float, float], *, again: bool = False
) -> Solved:
    """Solve for all frames, without a word on what is left; `again` from where another solve ended."""
    knots, weight = knots_and_weight
    if not (np.isfinite(knots) and knots > 0):
        raise MocapError(f"Knots are above 0 seconds apart, got {knots}.")
    change = np.zeros((len(base), len(body.price)))
    if not pins.asked.any():
        return Solved(base, change, body, [0.0])
    boxes = np.any(~pins.held & (np.isfinite(pins.low) | np.isfinite(pins.high)))
    ramp = RAMP if boxes and not again else SHORT_RAMP
    task = Task(*pared(base, body, pins, slice(None)), Splines(spline_basis(len(base), knots * base.fps)))
    worst: list[float] = []
    for share in ramp:
        change, gaps = task.descend(change, share * weight, LAST if share == 1 else PASSES)
        worst += gaps
    return Solved(displaced(base, body.displacement(change, len(base.skeleton))), change, body, worst)


class Task(NamedTuple):
    """What is asked of a pared motion: bring its joints to their pins by a spline."""

    base: Motion
    body: Body
    pins: Pins
    splines: "Splines"

    def descend(self, change: Array, weight: float, passes: int) -> tuple[Array, list[float]]:
        """Improve a change (F, n) pass by pass: the new one, and the worst gap after each pass, metres."""
        here, damping, worst = linear(self.base, self.body, change, self.pins), DAMPING, []
        for _ in range(passes):
            before = cost(self.body, change, here.gap, weight).sum()
            new = self.splines.solve(*normal_equations(here, self.body, change, weight, damping))
            there = linear(self.base, self.body, new, self.pins)
            gain = before - cost(self.body, new, there.gap, weight).sum()
            damping = damping / 5 if gain > 0 else damping * 10
            if gain > 0:
                change, here = new, there
            worst.append(float(here.distances.max()))
            if 0 < gain < GAIN * before:
                break
        return change, worst


class Splines:
    """The least squares of a spline x = B c over all frames, by a banded system.

    Parameters
    ----------
    basis : B, shape (F, K).

    Examples
    --------
    >>> target = np.linspace(0.0, 1.0, 11)[:, None]
    >>> Splines(spline_basis(11, 5)).solve(np.ones((11, 1, 1)), target).round(6)[[0, 5, 10], 0]
    array([0. , 0.5, 1. ])
    """

    def __init__(self, basis: sparse.csr_array) -> None:
        self.basis, columns = basis, basis.tocsc()
        # b_k b_{k+d} in each frame, (K - d, F): splines further apart do not overlap.
        apart = range(min(4, basis.shape[1]))
        self.pairs = [(columns[:, : basis.shape[1] - d] * columns[:, d:]).T.tocsr() for d in apart]

    def solve(self, matrix: Array, pull: Array) -> Array:
        """Find the curve x (F, n) = B c with Σ_f b bᵀ ⊗ G_f c = Σ_f b ⊗ g_f, for G (F, n, n) and g (F, n)."""
        knots, n = self.basis.shape[1], pull.shape[1]
        flat = matrix.reshape(len(matrix), -1)
        # Column j of block column k, from its block on the diagonal downwards; the part above it is 0.
        columns = np.zeros((knots, n, 4, n))
        for d, pair in enumerate(self.pairs):
            columns[: knots - d, :, d] = (pair @ flat).reshape(-1, n, n)
        columns[:, :, 0] *= np.triu(np.ones((n, n)))
        # The lower form of solveh_banded wants each column from its diagonal entry on: column j is shifted by
        # j places, as a table of 4 n numbers a row is when it is read with 4 n + 1.
        band = np.zeros((knots, n * (4 * n + 1)))
        band[:, : 4 * n * n] = columns.reshape(knots, -1)
        band = band.reshape(knots * n, 4 * n + 1)[:, :-1].T
        band[0] += RIDGE * band[0].max()
        right = (self.basis.T @ pull).ravel()
        found = solveh_banded(band, right, lower=True, check_finite=False)
        return np.asarray(self.basis @ found.reshape(knots, n))
