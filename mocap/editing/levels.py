"""From coarse to fine: inverse kinematics asks, and levels of splines with ever more knots answer [LS99].

At each level the pinned frames are brought to their pins, each by itself, and what that takes is fitted by a
spline with the level's knots and added: m_k = m_{k-1} ⊕ d_k. The fit is that of [LWS97]: local, without a
system to solve. Coarse levels move the body as a whole, fine ones add what is still asked.

Teach the levels, and use `spacetime`: it is quicker, comes nearer, and undoes what it overshot. The levels
win where an editor drags and wants a coarse answer at once. Where few frames are pinned, coarse knots must
come first in either way: `spacetime` alone makes a hand fly, `refined` and the levels do not.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse

from mocap._shared.arrays import Array, Indices, Mask
from mocap.body.motion import Motion
from mocap.editing.displacements import displaced, spline_basis
from mocap.editing.linear_bodies import Body
from mocap.editing.pins import Pins, pin_errors
from mocap.editing.reaching import each_frame, ready
from mocap.errors import MocapError

WEIGHT = 100.0
PASSES = 4  # of inverse kinematics at each level: what is left the next level asks again


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

    Raises
    ------
    MocapError : for another number of data than of frames, and a frame that is not there.

    Examples
    --------
    >>> control = scattered_fit(spline_basis(11, 5), np.array([[1.0]]), np.array([5]))
    >>> control.round(3)[:, 0]
    array([0.   , 0.333, 1.333, 0.333, 0.   ])

    Notebook: 14-levels
    """
    _require_data(basis, data, at)
    return local_heights(basis[at], np.asarray(data, float))


def local_heights(weights: sparse.csr_array, data: Array) -> Array:
    """Give the control points c (K, n) of `scattered_fit`, from w (N, K) and u (N, n).

    Examples
    --------
    >>> local_heights(sparse.csr_array([[0.0, 0.5, 0.5]]), np.array([[1.0]])).T
    array([[0., 1., 1.]])

    Notebook: 14-levels
    """
    squared = weights.power(2)
    above = (squared * weights).T @ (data / squared.sum(axis=1)[:, None])
    below = squared.sum(axis=0)[:, None]
    heights = np.divide(above, below, out=np.zeros_like(above), where=below > 0)
    return np.asarray(heights)


def _require_data(basis: sparse.csr_array, data: Array, at: Indices) -> None:
    """Raise `MocapError` unless there is a frame of the basis for each datum."""
    if np.ndim(data) != 2 or np.shape(at) != np.shape(data)[:1]:
        raise MocapError(
            f"Each datum, a row of numbers, needs a frame; got {np.shape(data)}, {np.shape(at)}."
        )
    if np.size(at) and not (np.min(at) >= 0 and np.max(at) < basis.shape[0]):
        raise MocapError(f"Data stand at frames 0 to {basis.shape[0] - 1}, got {min(at)} to {max(at)}.")


def hierarchy(  # noqa: PLR0913 (the last one is for the notebook that shows why)
    base: Motion,
    pins: Pins,
    body: Body | None = None,
    *,
    knots: Sequence[float] = (0.5, 0.25, 0.125, 0.06, 0.03),
    tolerance: float = 1e-3,
    listen: bool = True,
) -> tuple[Motion, list[Level]]:
    """Bring joints to their pins level by level, and end when the pins are met [LS99, levels].

    A number listens to a frame only if a joint that it moves is pinned there: a foot that stands says nothing
    about the arm. This is ours, and needed: else a hand that is asked for in three frames stays 28 cm off.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    body : which joints turn, at what price; `body_of(base, pins.joints)` by default.
    knots : seconds between knots, level by level, each smaller than the one before.
    tolerance : metres: a level is the last if no pin is missed by more.
    listen : False lets each number listen to all frames.

    Returns
    -------
    The motion, and one `Level` for each level that was needed; the motion as it is where none was.

    Raises
    ------
    MocapError : as for `spacetime`, for knots that do not fall, and a tolerance that is not above 0.

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
    body, motion, levels = ready(base, pins, body, WEIGHT), base, []
    if not len(knots) or not all(0 < b < a for a, b in zip((np.inf, *knots), knots, strict=False)):
        raise MocapError(f"From level to level the knots come nearer, above 0 s; got {tuple(knots)[:8]}.")
    if not tolerance > 0:
        raise MocapError(f"A tolerance is above 0 metres, got {tolerance}.")
    errors = pin_errors(motion, pins)
    for seconds in knots:
        if errors.max(initial=0.0) <= tolerance:
            break
        asked = np.asarray(pins.held.any(axis=-1) | (errors > 0))  # (F, P)
        frames = np.asarray(asked.any(axis=1))
        change, _ = each_frame(motion, pins.only(frames), body, WEIGHT, PASSES)
        basis = spline_basis(len(base), seconds * base.fps)
        who = listeners(base, pins, body, asked) if listen else np.repeat(frames[:, None], len(body.price), 1)
        curve = basis @ fitted(basis, change, who)
        motion = displaced(motion, body.displacement(curve, len(base.skeleton)))
        errors = pin_errors(motion, pins)
        rms = float(np.sqrt((errors[frames] ** 2).mean()))
        levels.append(Level(seconds, int(frames.sum()), float(errors.max()), rms))
    return motion, levels


def listeners(base: Motion, pins: Pins, body: Body, asked: Mask) -> Mask:
    """Say which frames each of the body's numbers listens to, (F, n), where pins ask in `asked` (F, P).

    A joint's turns listen where a joint below it is pinned; the root's place listens to all.
    """
    listens = np.zeros((len(base), len(body.price)), bool)
    listens[:, :3] = np.any(asked, axis=1)[:, None]
    chains = [base.skeleton.path_to_root(joint)[1:] for joint in pins.joints]
    for joint, columns in zip(body.joints, body.columns, strict=True):
        below = [number for number, above in enumerate(chains) if joint in above]
        listens[:, columns] = np.any(asked[:, below], axis=1)[:, None]
    return listens


def fitted(basis: sparse.csr_array, change: Array, listens: Mask) -> Array:
    """Fit each of the body's numbers, a column of `change` (F, n), to the frames it listens to: (K, n)."""
    control = np.zeros((basis.shape[1], change.shape[1]))
    kinds, kind = np.unique(listens, axis=1, return_inverse=True)
    for number in range(kinds.shape[1]):
        frames, columns = np.flatnonzero(kinds[:, number]), np.flatnonzero(kind.ravel() == number)
        control[:, columns] = scattered_fit(basis, change[np.ix_(frames, columns)], frames)
    return control
