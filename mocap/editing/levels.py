"""From coarse to fine: inverse kinematics asks, and levels of splines with ever more knots answer [LS99].

At each level the pinned frames are brought to their pins, each by itself, and what that takes is fitted by a
spline with the level's knots and added: m_k = m_{k-1} ⊕ d_k. The fit is that of [LWS97]: local, without a
system to solve. Coarse levels move the body as a whole, fine ones add what is still asked.

Teach the levels, and use `solve` on splines: it is quicker, comes nearer, and undoes what it overshot. The
levels win where an editor drags and wants a coarse answer at once.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse

from mocap._shared.arrays import Array, Indices
from mocap.body.motion import Motion
from mocap.editing.bodies import Body
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.pins import Pins, pin_errors
from mocap.editing.solver import REACH, solve
from mocap.errors import MocapError

# Few passes of inverse kinematics at each level: what is left the next level asks again.
ASK = REACH._replace(passes=4)

TOLERANCE = 1e-3  # metres: a level is the last if no pin is missed by more


class Level(NamedTuple):
    """A level of `hierarchy`: seconds between `knots`, frames `asked`, and what was left of the gaps, metres.

    `worst` is over all pins, `rms` over those of frames in which something was asked.

    Examples
    --------
    >>> Level(knots=0.5, asked=80, worst=0.104, rms=0.025).worst
    0.104
    """

    knots: float
    asked: int
    worst: float
    rms: float


def scattered_fit(basis: sparse.csr_array, data: Array, at: Indices) -> Array:
    """Fit control points to data at some frames, each by itself [LWS97], as [LS99, scattered data].

    Alone, a datum u_j with the weights w_ij = B_i(t_j) would ask for β_ij = w_ij u_j / Σ_i w_ij² of control
    point i: the least change that meets it. A control point takes the mean of what its data ask for,

        c_i = Σ_j w_ij² β_ij / Σ_j w_ij²,

    and 0 where no datum is near. So the curve is bounded by its data, where least squares runs wild between
    them; it comes near them, and the next level goes on.

    Parameters
    ----------
    basis : B, shape (F, K), as from `spline_basis`.
    data : u, shape (N, n).
    at : shape (N,), their frames.

    Returns
    -------
    c, shape (K, n); the curve is B c.

    Examples
    --------
    >>> control = scattered_fit(spline_basis(11, 5), np.array([[1.0]]), np.array([5]))
    >>> control.round(3)[:, 0]
    array([0.   , 0.333, 1.333, 0.333, 0.   ])

    Notebook: 14-levels
    """
    weights = basis[at]
    squared = weights.power(2)
    above = (squared * weights).T @ (np.asarray(data, float) / squared.sum(axis=1)[:, None])
    below = squared.sum(axis=0)[:, None]
    return np.asarray(np.divide(above, below, out=np.zeros_like(above), where=below > 0))


def hierarchy(
    base: Motion, pins: Pins, *, knots: Sequence[float] = (0.5, 0.25, 0.125, 0.06, 0.03)
) -> tuple[Motion, list[Level]]:
    """Bring joints to their pins level by level, and end when they are met to a millimetre [LS99, levels].

    A number listens to a frame only if a joint that it moves is pinned there: a foot that stands says nothing
    about the arm. This is ours, and needed: else a hand that is asked for in three frames stays 28 cm off.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    knots : seconds between knots, level by level, each smaller than the one before.

    Returns
    -------
    The motion, and one `Level` for each level that was needed; the motion as it is where none was.

    Raises
    ------
    MocapError : as for `solve`, and for knots that do not fall.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")[:120]
    >>> hand = joint_positions(walk)[60, walk.skeleton.index("lwrist")]
    >>> _, levels = hierarchy(walk, pin(walk, "lwrist", [60], hand + [0, 0.2, 0]))
    >>> levels[-1].worst < 0.001
    True

    Notebook: 14-levels
    """
    if not len(knots) or not all(0 < b < a for a, b in zip((np.inf, *knots), knots, strict=False)):
        raise MocapError(f"From level to level the knots come nearer, above 0 s; got {tuple(knots)[:8]}.")
    motion, levels, errors = base, [], pin_errors(base, pins)
    body: Body | None = None
    for seconds in knots:
        if errors.max(initial=0.0) <= TOLERANCE:
            break
        asked = np.asarray(pins.held.any(axis=-1) | (errors > 0))  # (F, P)
        frames = np.asarray(asked.any(axis=1))
        _, _, change, body = solve(motion, pins.only(frames), [ASK], body, quiet=True)
        # The root's place listens to all frames, a joint's turns to those in which a joint below is pinned.
        below = [np.isin(body.joints, base.skeleton.path_to_root(joint)[1:]) for joint in pins.joints]
        who = np.hstack([np.repeat(frames[:, None], 3, axis=1), asked @ np.array(below)])  # (F, n)
        basis = spline_basis(len(base), seconds * base.fps)
        fits = [scattered_fit(basis, change[at, n, None], np.flatnonzero(at)) for n, at in enumerate(who.T)]
        motion = displaced(motion, body.displacement(basis @ np.hstack(fits), len(base.skeleton)))
        errors = pin_errors(motion, pins)
        rms = float(np.sqrt((errors[frames] ** 2).mean()))
        levels.append(Level(seconds, int(frames.sum()), float(errors.max()), rms))
    return motion, levels
