"""Bending and retiming of a walk so that it ends at a position, with a heading, after a number of frames.

As in path editing [Gle01], the body is held relative to a frame that moves along a path, and the path is
changed. Here the frame is the root itself, and only the end of the new path is known. The path is rotated by
φ(t), and its steps are scaled by σ(t). Both are smooth and as small as possible:

    min ∫ turn φ̇² + stretch (ln σ)² dt   subject to   g(0) + ∫ σ exp(iφ) dg = the target,   φ(T) = Δ

At both ends φ̇ = 0 and σ = 1, so that the walk starts and ends with its own velocity. All of this is ours.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from mocap._shared.arrays import Array, Points
from mocap._shared.records import NamedTuple
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.planar import on_ground
from mocap.editing.displacements import spline_basis
from mocap.editing.retiming import at_frames
from mocap.methods.in_betweening.tuned import TUNED

LEVEL = 3  # splines at each end whose coefficients stay 0, so that φ and ln σ are level there


class Arrived(NamedTuple):
    """A walk of F frames that was bent and retimed, and the size of these changes.

    Parameters
    ----------
    motion : the walk.
    turned : shape (F - 1,), the additional angular speed, radians per second.
    steps : shape (F - 1,), the factor of the lengths of the steps.
    pace : shape (F - 1,), the factor of the playback speed.
    lack : the distance between the end of the walk and the target, metres.
    price : the cost of the changes.
    """

    motion: Motion
    turned: Array
    steps: Array
    pace: Array
    lack: float
    price: float


def level_rise(count: int) -> Array:
    """Compute a curve from 0 to 1 that is level at both ends and linear between them.

    Examples
    --------
    >>> level_rise(5).round(3)
    array([0.  , 0.24, 0.5 , 0.76, 1.  ])
    """
    u = (np.arange(count - 1) + 0.5) / (count - 1)
    edge = np.minimum(np.minimum(u, 1 - u) / TUNED.rise, 1.0)
    rate = edge**2 * (3 - 2 * edge)
    return np.concatenate([[0.0], np.cumsum(rate) / rate.sum()])


def bend_to(motion: Motion, frames: int, end: complex, rotation: float) -> Arrived:
    """Retime a walk to a number of frames, and bend it so that it ends at a ground point and heading.

    If the limits of turning and of the steps admit no solution, the end is missed or the angular speed
    exceeds its limit.

    Parameters
    ----------
    motion : 2 frames or more. At both ends it keeps its own pace.
    frames : the number of frames of the new motion, 2 or more.
    end : the position of its last root, z + ix, metres.
    rotation : the additional rotation of its last frame, radians.

    Examples
    --------
    A walk of 121 frames ends half a metre farther to the left:

    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:481:4]
    >>> bent = bend_to(walk, 130, on_ground(walk.root_positions[-1]) + 0.5j, 0.3)
    >>> len(bent.motion), round(bent.lack, 4), float(np.degrees(abs(bent.turned).max()).round())
    (130, 0.0, 12.0)
    """
    moments = np.arange(frames) + (len(motion) - frames) * level_rise(frames)
    pace = np.diff(moments)
    motion = motion if len(motion) == frames else at_frames(motion, moments)
    path = _BentPath(on_ground(motion.root_positions), rotation, motion.fps)
    best = path.solve(end, limited=False)
    if np.abs(path.turned(best)).max() > TUNED.most_turn:
        best = path.solve(end, limited=True)
    phi = path.angles(best)
    points = path.points(best)
    roots = motion.root_positions.copy()
    roots[:, 2] = points.real
    roots[:, 0] = points.imag
    turns = motion.rotations.copy()
    turns[:, 0] = rotations.multiply(rotations.about_y(phi), turns[:, 0])
    turned = np.diff(phi) * motion.fps
    sigma = path.step_factors(best)
    logs = np.concatenate([np.log(sigma), np.log(pace)])
    price = (TUNED.turn * (turned @ turned) + TUNED.stretch * (logs @ logs)) / motion.fps
    bent = replace(motion, root_positions=roots, rotations=turns)
    return Arrived(bent, turned, sigma, pace, float(abs(points[-1] - end)), float(price))


class _BentPath:
    """The path of a walk of F frames as a function of x (2 K,): the splines of φ, then those of ln σ."""

    def __init__(self, ground: Points, turn: float, fps: float) -> None:
        self.ground = ground
        self.fps = fps
        frames = len(ground)
        spans = int(np.clip(round((frames - 1) / fps / TUNED.knots), TUNED.fewest_spans, TUNED.most_spans))
        self.basis = spline_basis(frames, (frames - 1) / spans).toarray()[:, LEVEL:-LEVEL]  # (F, K)
        self.middle = (self.basis[1:] + self.basis[:-1]) / 2
        self.rate = np.diff(self.basis, axis=0)
        self.even = turn * level_rise(frames)
        self.count = self.basis.shape[1]
        self.constrained = slice(None, None, max(1, (frames - 1) // (TUNED.per_span * spans)))

    def solve(self, end: complex, *, limited: bool) -> Array:
        """Find x by sequential quadratic programming, with or without the limit of the angular speed."""
        log_limit = np.log(TUNED.most_steps)
        free = [(None, None)] * self.count
        bounds = free + [(-log_limit, log_limit)] * self.count
        constraints = [{"type": "eq", "fun": lambda x: self.residual(x, end), "jac": self.residual_jacobian}]
        if limited:
            constraints.append(self._turn_limit())
        settings = {"method": "SLSQP", "options": {"maxiter": TUNED.solver_rounds, "ftol": 1e-6}}
        start = np.zeros(2 * self.count)
        solution = minimize(self.cost, start, jac=True, bounds=bounds, constraints=constraints, **settings)
        return np.asarray(solution.x)

    def _turn_limit(self) -> dict[str, object]:
        """Return the constraint that bounds the additional angular speed in both directions."""
        rate = self.rate[self.constrained] * self.fps
        jacobian = np.block([[-rate, 0 * rate], [rate, 0 * rate]])
        even = self.turned(np.zeros(2 * self.count))[self.constrained]
        room = TUNED.within * TUNED.most_turn - np.concatenate([even, -even])
        return {"type": "ineq", "fun": lambda x: room + jacobian @ x, "jac": lambda _: jacobian}

    def turned(self, x: Array) -> Array:
        """Return the additional angular speed, (F - 1,), radians per second."""
        return np.asarray((np.diff(self.even) + self.rate @ x[: self.count]) * self.fps)

    def angles(self, x: Array) -> Array:
        """Return φ, shape (F,), radians."""
        return np.asarray(self.even + self.basis @ x[: self.count])

    def step_factors(self, x: Array) -> Array:
        """Return σ, shape (F - 1,)."""
        return np.asarray(np.exp(self.middle @ x[self.count :]))

    def points(self, x: Array) -> Points:
        """Return the ground points of the path, shape (F,)."""
        phi = self.angles(x)
        turned = np.exp(0.5j * (phi[1:] + phi[:-1]))  # each step is rotated by the mean of φ at its ends
        steps = self.step_factors(x) * turned * np.diff(self.ground)
        return np.asarray(self.ground[0] + np.concatenate([[0.0], np.cumsum(steps)]))

    def cost(self, x: Array) -> tuple[float, Array]:
        """Return the cost and its gradient."""
        turned = self.turned(x)
        log = self.middle @ x[self.count :]
        cost = (TUNED.turn * (turned @ turned) + TUNED.stretch * (log @ log)) / self.fps
        by_angles = TUNED.turn * (self.rate.T @ turned)
        by_steps = TUNED.stretch / self.fps * (self.middle.T @ log)
        return float(cost), 2 * np.concatenate([by_angles, by_steps])

    def residual(self, x: Array, end: complex) -> Array:
        """Return the vector from the target to the end of the path, (2,), metres."""
        lack = self.points(x)[-1] - end
        return np.array([lack.real, lack.imag])

    def residual_jacobian(self, x: Array) -> Array:
        """Return the derivative of `residual`, shape (2, 2 K)."""
        along = np.diff(self.points(x)) @ self.middle
        columns = np.concatenate([1j * along, along])
        return np.stack([columns.real, columns.imag])
