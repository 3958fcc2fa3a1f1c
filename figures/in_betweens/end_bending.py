"""A walk bent and stretched so that it ends at a place, turned by an angle, after a number of frames.

As in path editing [Gle01], the body is held relative to a frame that moves along its way, and the way is
changed. Here the frame is the root itself, and of the new way only the end is given. So the way is turned by
φ(t) and its steps are made σ(t) times as long, both smooth, with as little of both as possible:

min ∫ TURN φ̇² + STRETCH (ln σ)² dt   with   g(0) + ∫ σ exp(iφ) dg = the end's place,   φ(T) = Δ.

At both ends φ̇ = 0 and σ = 1, so that the walk starts and ends as fast as before. All of it is ours.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from mocap._shared.arrays import Array, Points
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.editing.displacements import spline_basis
from mocap.editing.retiming import at_frames

# By how much a walk may be changed to arrive: radians per second that are added to its own turning, and times
# which its steps are longer or shorter, and which it is played faster or slower.
MOST_TURN, MOST_STEPS, MOST_PACE = float(np.radians(60)), 1.25, 1.25
# What changes cost: times the squared radians per second of the turning that is added, and times the squared
# logarithm by which steps are lengthened or time is stretched; times seconds each.
TURN, STRETCH = 0.5, 8.0
WITHIN = 0.98  # of the limit of turning, because it is held at some frames only
ROUNDS = 30  # of the solver; 5 to 15 are enough where there is a way
KNOTS = 0.3  # seconds between the knots of φ and ln σ
FEWEST, SPANS = 10, 40  # spans between knots; three at each end are held level
RISE = 0.15  # the share of a walk over which its time comes to the new pace, at each end


class Arrived(NamedTuple):
    """A walk of F frames that was bent and retimed, and by how much.

    `turned` (F - 1,): the turning that was added, radians per second; `steps` (F - 1,): by which steps were
    lengthened; `pace` (F - 1,): times which it is played faster; `lack`: the metres by which its end misses
    its place; `price`: what the changes cost.
    """

    motion: Motion
    turned: Array
    steps: Array
    pace: Array
    lack: float
    price: float


def level_rise(count: int) -> Array:
    """Rise from 0 to 1 over some frames, level at both ends and steady between them.

    Examples
    --------
    >>> level_rise(5).round(3)
    array([0.  , 0.24, 0.5 , 0.76, 1.  ])
    """
    u = (np.arange(count - 1) + 0.5) / (count - 1)
    near = np.minimum(np.minimum(u, 1 - u) / RISE, 1.0)
    rate = near**2 * (3 - 2 * near)
    return np.concatenate([[0.0], np.cumsum(rate) / rate.sum()])


def bend_to(motion: Motion, frames: int, end: complex, apart: float) -> Arrived:
    """Play a walk in another number of frames, and bend it so that its root ends at a ground point, turned.

    Where `MOST_TURN` and `MOST_STEPS` leave no way, the end is missed, or the turning is faster.

    Parameters
    ----------
    motion : 2 frames or more; at both ends it keeps its own pace.
    frames : of the new motion, 2 or more.
    end : where its last root shall be, z + ix.
    apart : radians by which its last frame is turned.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:481:4]
    >>> bent = bend_to(walk, 130, on_ground(walk.root_positions[-1]) + 0.5j, 0.3)
    >>> bool(bent.lack < 1e-4), bool(np.degrees(abs(bent.turned).max()) < 30), len(bent.motion)
    (True, True, 130)
    """
    moments = np.arange(frames) + (len(motion) - frames) * level_rise(frames)
    pace = np.diff(moments)
    motion = motion if len(motion) == frames else at_frames(motion, moments)
    way = _Way(on_ground(motion.root_positions), apart, motion.fps)
    best = way.solve(end, held=False)
    if np.abs(way.turned(best)).max() > MOST_TURN:
        best = way.solve(end, held=True)
    phi, sigma, moved = way.points(best)
    roots, turns = motion.root_positions.copy(), motion.rotations.copy()
    roots[:, 2], roots[:, 0] = moved.real, moved.imag
    turns[:, 0] = rotations.multiply(rotations.about_y(phi), turns[:, 0])
    bent, turned = replace(motion, root_positions=roots, rotations=turns), np.diff(phi) * motion.fps
    logs = np.concatenate([np.log(sigma), np.log(pace)])
    price = (TURN * (turned @ turned) + STRETCH * (logs @ logs)) / motion.fps
    return Arrived(bent, turned, sigma, pace, float(abs(moved[-1] - end)), float(price))


class _Way:
    """The way of a walk of F frames as a function of x (2 K,): the splines of φ, then those of ln σ."""

    def __init__(self, ground: Points, apart: float, fps: float) -> None:
        self.ground, self.fps, frames = ground, fps, len(ground)
        spans = int(np.clip(round((frames - 1) / fps / KNOTS), FEWEST, SPANS))
        self.basis = spline_basis(frames, (frames - 1) / spans).toarray()[:, 3:-3]  # (F, K)
        self.middle = (self.basis[1:] + self.basis[:-1]) / 2
        self.rate, self.even = np.diff(self.basis, axis=0), apart * level_rise(frames)
        self.count = self.basis.shape[1]
        self.some = slice(None, None, max(1, (frames - 1) // (4 * spans)))  # four between two knots

    def solve(self, end: complex, *, held: bool) -> Array:
        """Find x by sequential quadratic programming; `held` says whether the turning has its limit."""
        most, rate = np.log(MOST_STEPS), self.rate[self.some] * self.fps
        slope, own = np.block([[-rate, 0 * rate], [rate, 0 * rate]]), self.turned(np.zeros(2 * self.count))
        room = WITHIN * MOST_TURN - np.concatenate([own[self.some], -own[self.some]])
        arrive = {"type": "eq", "fun": lambda x: self.miss(x, end), "jac": self.miss_slopes}
        turn = {"type": "ineq", "fun": lambda x: room + slope @ x, "jac": lambda _: slope}
        found = minimize(
            self.cost,
            np.zeros(2 * self.count),
            jac=True,
            method="SLSQP",
            bounds=[(None, None)] * self.count + [(-most, most)] * self.count,
            constraints=[arrive, turn] if held else [arrive],
            options={"maxiter": ROUNDS, "ftol": 1e-6},
        )
        return np.asarray(found.x)

    def turned(self, x: Array) -> Array:
        """Give the turning that is added, (F - 1,), radians per second."""
        return np.asarray((np.diff(self.even) + self.rate @ x[: self.count]) * self.fps)

    def points(self, x: Array) -> tuple[Array, Array, Points]:
        """Give φ (F,), σ (F - 1,), and the ground points (F,)."""
        phi, sigma = self.even + self.basis @ x[: self.count], np.exp(self.middle @ x[self.count :])
        steps = sigma * np.exp(0.5j * (phi[1:] + phi[:-1])) * np.diff(self.ground)
        return phi, sigma, self.ground[0] + np.concatenate([[0.0], np.cumsum(steps)])

    def cost(self, x: Array) -> tuple[float, Array]:
        """Give the cost and its gradient."""
        turned, log = self.turned(x), self.middle @ x[self.count :]
        cost = (TURN * (turned @ turned) + STRETCH * (log @ log)) / self.fps
        slope = [TURN * (self.rate.T @ turned), STRETCH / self.fps * (self.middle.T @ log)]
        return float(cost), 2 * np.concatenate(slope)

    def miss(self, x: Array, end: complex) -> Array:
        """Give the vector from the end's place to where the way ends."""
        lack = self.points(x)[2][-1] - end
        return np.array([lack.real, lack.imag])

    def miss_slopes(self, x: Array) -> Array:
        """Give the derivative of `miss`, shape (2, 2 K)."""
        along = np.diff(self.points(x)[2]) @ self.middle
        lean = np.concatenate([1j * along, along])
        return np.stack([lean.real, lean.imag])
