"""Hierarchical editing [LS99]: constraints met level by level, from coarse to fine splines."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy import sparse

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.records import NamedTuple
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, priced
from mocap.editing.constraint_checks import require_pins_of, require_reachable
from mocap.editing.constraints import Pins
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.poses import ROOT, ROTATIONS, poses_of
from mocap.editing.solver import solve_stages
from mocap.editing.stages import REACH
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError

TOLERANCE = 1e-3  # metres: a level is the last one if all errors are smaller


class Level(NamedTuple):
    """A level of `hierarchy`.

    Parameters
    ----------
    knots : seconds between them.
    asked : number of frames with constraints.
    worst : the largest error of all constraints after this level, metres.
    rms : the root mean square of the errors in frames with constraints, metres.

    Examples
    --------
    >>> Level(knots=0.5, asked=80, worst=0.104, rms=0.025).worst
    0.104
    """

    knots: float
    asked: int  # reads: name: public, and in notebook 14
    worst: float
    rms: float


def scattered_fit(
    basis: sparse.csr_array, data: Array, at: Indices
) -> Array:  # reads: name: public, and in notebook 14
    """Fit control points to data at some frames, each by itself [LWS97], as [LS99, scattered data].

    A single datum u_j with the weights w_ij = B_i(t_j) needs β_ij = w_ij u_j / Σ_i w_ij² of control point i,
    the least change that meets it. A control point is the mean of what its data need,

        c_i = Σ_j w_ij² β_ij / Σ_j w_ij²,

    and 0 if no datum is near. Therefore the curve is bounded by its data, while least squares oscillates
    between them. The curve only approximates them, and the next level continues.

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
    numerator = (squared * weights).T @ (np.asarray(data, float) / squared.sum(axis=1)[:, None])
    denominator = squared.sum(axis=0)[:, None]
    zeros = np.zeros_like(numerator)
    return np.asarray(np.divide(numerator, denominator, out=zeros, where=denominator > 0))


def hierarchy(
    base: Motion, pins: Pins, *, knots: Sequence[float] = (0.5, 0.25, 0.125, 0.06, 0.03)
) -> tuple[Motion, list[Level]]:
    """Meet constraints level by level, until all errors are below a millimetre [LS99, levels].

    At each level the constrained frames are solved, each by itself. A spline with the level's knots is fitted
    to these changes, and added: m_k = m_{k-1} ⊕ d_k. The fit is that of [LWS97]: local, without a system to
    solve. `solve` on splines is faster and more accurate, and corrects its overshoot. Levels are better if an
    editor drags a joint and wants a coarse answer at once.

    A number of the body is fitted to a frame only if a joint that it moves is constrained there: a foot that
    stands does not affect the arm. This is ours, and needed. Otherwise a hand that is constrained in three
    frames stays 28 cm off.

    Parameters
    ----------
    base : F frames.
    pins : constraints of F frames.
    knots : seconds between knots, level by level, each smaller than the one before.

    Returns
    -------
    The motion, and one `Level` for each level that was needed; the motion as it is if none was.

    Raises
    ------
    MocapError : as for `solve`, and for knots that do not decrease.

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
    from_coarse = [np.inf, *knots]
    if not len(knots) or not all(0 < fine < coarse for coarse, fine in pairwise(from_coarse)):
        raise MocapError(f"From level to level the knots come nearer, above 0 s; got {tuple(knots)[:8]}.")
    require_pins_of(base, pins)
    require_reachable(base, pins)
    poses = poses_of(base)
    errors = pins.errors(poses)
    body = priced(poses, pins.movers(base.skeleton), TUNED.level_trunk, TUNED.level_neck)
    stage = replace(REACH, passes=TUNED.level_passes)
    levels: list[Level] = []
    for seconds in knots:
        if errors.max(initial=0.0) <= TOLERANCE:
            break
        is_missed = errors.max(axis=1) > TOLERANCE  # in all other frames the spline shall stay where it is
        change = solve_stages(poses, pins.limited_to(is_missed), [stage], body).change
        requested = np.asarray(pins.held.any(axis=-1) | (errors > 0))  # (F, P + R)
        curve = _fitted(change, _fitted_frames(requested, body, pins, base), seconds * base.fps)
        moved = displaced(poses.motion, body.displacement(curve, len(base.skeleton)))
        poses = poses_of(moved)
        errors = pins.errors(poses)
        frames = requested.any(axis=1)
        rms = float(np.sqrt((errors[frames] ** 2).mean()))
        levels.append(Level(seconds, int(frames.sum()), float(errors.max()), rms))
    return poses.motion, levels


def _fitted_frames(requested: Mask, body: Body, pins: Pins, motion: Motion) -> Mask:
    """Tell to which frames each number of the body is fitted, (F, n), by the boxes requested (F, P + R).

    Translations of the root are fitted to all frames with requests, rotations of a joint to those in which a
    joint below it is constrained.
    """
    is_fitted = np.zeros((len(requested), len(body.price)), bool)
    is_fitted[:, ROOT] = requested.any(axis=1, keepdims=True)
    movers = pins.movers(motion.skeleton)
    is_mover = np.array([np.isin(body.joints, joints) for joints in movers])  # (P + R, A)
    is_fitted[:, ROTATIONS] = requested @ is_mover
    return is_fitted


def _fitted(change: Array, is_fitted: Mask, spacing: float) -> Array:
    """Fit splines with a spacing of knots, in frames, to a change in the frames chosen, both (F, n)."""
    basis = spline_basis(len(change), spacing)
    columns = []
    for number, frames in enumerate(is_fitted.T):
        columns.append(scattered_fit(basis, change[frames, number, None], np.flatnonzero(frames)))
    return np.asarray(basis @ np.hstack(columns))
