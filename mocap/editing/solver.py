"""One solver for all edits: the smallest smooth change of a motion that meets its constraints.

The change x (F, n) holds translations of the root and rotations of a body's joints, and m = m₀ ⊕ x. It is a
curve x = B c, and

    Σ_f x_fᵀ M x_f  +  Σ_f τ⁴ ẍ_fᵀ M ẍ_f  +  w² Σ ‖r‖²

is minimised. M holds the body's prices, τ is the price of bends, w is a weight, and r are the residuals of
all constraints, of both kinds. With B = 1 and τ = 0 each frame is solved by itself: inverse kinematics. With
splines for B all frames are solved together: spacetime constraints [Gle98]. Several `Stage`s are solved one
after the other, each from the result of the one before [Gle98, finer knots]. Prices, τ, and the weight in
place of [Gle98]'s Lagrange multipliers are ours.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mocap._shared.arrays import Array, Indices, Mask
from mocap._shared.records import NamedTuple
from mocap._shared.tasks import one_blas_thread
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, body_of
from mocap.editing.constraint_checks import require_pins_of, require_reachable, warn_of_errors
from mocap.editing.constraints import Pins
from mocap.editing.displacements import displaced
from mocap.editing.poses import ROTATIONS, MotionOrPoses, Poses, motion_of, poses_of
from mocap.editing.stages import Curve, Stage
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError

MET = 5e-10  # metres: constraints with a smaller error are met
KEPT = 2  # frames on either side of those that may change: there a change and its rate are 0
EVERY_FRAME = slice(None)


class Solved(NamedTuple):
    """The result of the solver.

    Parameters
    ----------
    poses : the new motion, with its joints in the world.
    errors : shape (F, P + R), as from `pin_errors`, metres.
    worst : the largest error at first and after each iteration, metres.
    change : shape (F, n), the numbers of the body that the last stage added.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> Solved(poses_of(walk), np.zeros((9, 4)), [0.02, 0.0], np.zeros((9, 13))).motion is walk
    True
    """

    poses: Poses
    errors: Array
    worst: list[float]
    change: Array

    @property
    def motion(self) -> Motion:
        """The new motion."""
        return self.poses.motion


def solve(  # noqa: PLR0913 (a motion, constraints, how to solve, and two options)
    base: MotionOrPoses,
    pins: Pins,
    stages: Sequence[Stage],
    body: Body | None = None,
    *,
    quiet: bool = False,
    frames: slice = EVERY_FRAME,
) -> Solved:
    """Meet constraints by the smallest smooth change, in one stage after the other.

    In the paper: [Gle98, objective; finer knots], [LS99, inverse kinematics].

    Steps of Levenberg and Marquardt, `solver.Curve.step`, on the control points c. The time grows with F.

    Parameters
    ----------
    base : F frames.
    pins : constraints of F frames.
    stages : one or more. `REACH` solves each frame by itself; those that meet their constraints stay as they
        are.
    body : the joints that may rotate, and the prices; `body_of(base, pins)` by default. For a single frame,
        make it from the whole clip, which shows the hinges.
    quiet : whether to omit the warning of constraints that are missed.
    frames : those that may change, a single range. All others stay the same to the last bit, and the change
        begins and ends smoothly.

    Returns
    -------
    The new motion, and its errors; the motion as it is if all constraints are met.

    Raises
    ------
    MocapError : for constraints of another motion, constraints that no pose can meet, and no stage.

    Warns
    -----
    MocapWarning : for constraints that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import join_pins, pin, plant_pins
    >>> walk = sample("walk_straight")[:120]
    >>> hand = joint_positions(walk)[60, walk.skeleton.index("lwrist")]
    >>> requests = join_pins(plant_pins(walk), pin(walk, "lwrist", [60], hand + [0, 0.2, 0]))
    >>> solve(walk, requests, [Stage(knots=0.125)]).worst[-1] < 0.005
    True

    Notebook: 13-retargeting
    """
    motion = motion_of(base)
    require_pins_of(motion, pins)
    require_reachable(motion, pins)
    if not len(stages):
        raise MocapError("To solve takes a stage or more, got none.")
    start = poses_of(base)
    solved = solve_stages(start, pins, stages, body or body_of(start, pins), frames)
    if not quiet:
        warn_of_errors(motion, pins.indices, solved.errors)
    return solved


def solve_stages(
    start: Poses, pins: Pins, stages: Sequence[Stage], body: Body, frames: slice = EVERY_FRAME
) -> Solved:
    """Meet constraints as `solve` does; they are taken as checked, and nothing warns of those missed.

    Parameters
    ----------
    start, pins : F frames.
    stages, body, frames : as for `solve`.
    """
    stays = np.ones(len(start), bool)
    stays[frames] = False
    errors = pins.errors(start)
    no_change = np.zeros((len(start), len(body.price)))
    solved = Solved(start, errors, [float(errors.max(initial=0.0))], no_change)
    with one_blas_thread():  # more of them wait for each other: the blocks of the bands are small
        for stage in _with_damping_under_bars(stages, pins):
            solved = _solve_stage(stage, solved, pins, body, stays)
    return solved._replace(poses=solved.poses.with_frames_of(start, stays))


def _solve_stage(stage: Stage, last: Solved, pins: Pins, body: Body, stays: Mask) -> Solved:
    """Solve one stage from the result of the last one, and add its errors to those."""
    change = np.zeros_like(last.change)
    rows = _rows(stage, last.errors, stays)
    frames = len(stays[rows])
    curve = Curve(stage, frames, last.motion.fps, body.price, stays[rows])
    if not curve.basis.shape[1]:  # nothing to do, or no curve leaves the frames unchanged that must stay
        return last._replace(change=change)
    constraints = pins.led(last.poses, stage.lead) if stage.lead else pins
    problem = _Problem(last.poses[rows], constraints[rows], body, curve)
    end, worst = _descend(problem, stage)
    change[rows] = end.change
    poses = last.poses.with_part(end.poses, rows)
    errors = last.errors.copy()
    errors[rows] = _errors(end.residual, pins.bounded[rows])
    return Solved(poses, errors, last.worst + worst, change)


def _errors(residual: Array, bounded: Mask) -> Array:
    """Compute the errors (F, N), metres, of residuals (F, 3 N): on axes that are bounded, not only led."""
    components = np.where(bounded, residual.reshape(bounded.shape), 0.0)
    return np.asarray(np.linalg.norm(components, axis=-1))


def _rows(stage: Stage, errors: Array, stays: Mask) -> slice | Indices:
    """Return the frames that a stage solves for: none if all constraints are met.

    A framewise stage solves for frames that miss a constraint, another one for all that may change, with
    `KEPT` frames on either side.
    """
    is_missed = errors.max(axis=1, initial=0.0) > MET
    changes = np.flatnonzero(~stays)
    if not is_missed.any() or not len(changes):
        return slice(0, 0)
    if stage.is_framewise:
        return np.flatnonzero(is_missed & ~stays)
    return slice(max(int(changes[0]) - KEPT, 0), int(changes[-1]) + 1 + KEPT)


def _with_damping_under_bars(stages: Sequence[Stage], pins: Pins) -> Iterator[Stage]:
    """Yield the stages; the first one has more damping if positions have a ceiling."""
    has_ceiling = bool((np.isfinite(pins.high) & ~pins.positions.held).any())
    for number, stage in enumerate(stages):
        is_damped = number == 0 and has_ceiling
        yield replace(stage, damping=TUNED.bar_damping) if is_damped else stage


class _Iterate(NamedTuple):
    """Control points c (K, n), the change B c (F, n), and what m₀ ⊕ B c leads to."""

    c: Array
    change: Array
    poses: Poses
    residual: Array
    jacobian: Array
    cost: Array

    def or_where(self, is_better: Mask, trial: "_Iterate") -> "_Iterate":
        """Take the trial where it is better: in frames (F, 1), or as a whole (1, 1)."""
        if is_better.all():
            return trial
        if not is_better.any():
            return self
        c = _merged(is_better, trial.c, self.c)
        change = _merged(is_better, trial.change, self.change)
        poses = self.poses.with_frames_of(trial.poses, is_better[:, 0])
        residual = _merged(is_better, trial.residual, self.residual)
        jacobian = _merged(is_better, trial.jacobian, self.jacobian)
        return _Iterate(c, change, poses, residual, jacobian, np.where(is_better, trial.cost, self.cost))


def _merged(is_better: Mask, trial: Array, last: Array) -> Array:
    """Take the frames of a trial that are better, (F, 1), of arrays (F, ...)."""
    axes = tuple(range(1, trial.ndim - 1))
    return np.where(np.expand_dims(is_better, axes), trial, last)


class _Problem(NamedTuple):
    """The problem that a stage minimises: F frames, their constraints, and the curves that are allowed."""

    base: Poses
    pins: Pins
    body: Body
    curve: Curve

    def evaluate(self, c: Array) -> _Iterate:
        """Compute the iterate of control points c (K, n); zeros are the base itself."""
        motion = self.base.motion
        change = self.curve.basis @ c
        displacement = self.body.displacement(change, len(motion.skeleton))
        poses = poses_of(displaced(motion, displacement)) if c.any() else self.base
        residual, jacobian = self.pins.linearised(poses, self.body.world_axes(poses, displacement))
        return _Iterate(c, change, poses, residual, jacobian, self.curve.cost(c, residual))


def _descend(problem: _Problem, stage: Stage) -> tuple[_Iterate, list[float]]:
    """Minimise the cost by steps of Levenberg and Marquardt.

    Returns
    -------
    The last iterate, and the largest error after each iteration, metres.
    """
    iterate = problem.evaluate(np.zeros((problem.curve.basis.shape[1], len(problem.body.price))))
    errors: list[float] = []
    damping = np.full(iterate.cost.shape, stage.damping)
    while len(errors) < stage.passes:
        trial = problem.evaluate(_shortened_step(iterate, problem.curve, damping))
        gain = iterate.cost - trial.cost  # of each frame by itself, or of all together
        is_better = gain > 0
        is_large = np.abs(gain) > np.where(is_better, TUNED.gain, TUNED.loss) * iterate.cost
        goes_on = is_large | (is_better & (damping > 1))
        iterate = iterate.or_where(is_better, trial)
        damping = np.where(is_better, damping / TUNED.fall, damping * TUNED.rise)
        errors.append(_largest_error(iterate.residual))
        if not goes_on.any() or errors[-1] < MET:
            break
    return iterate, errors


def _shortened_step(iterate: _Iterate, curve: Curve, damping: Array) -> Array:
    """Compute the next control points c (K, n), so that no joint rotates by more than `TUNED.leap`."""
    step = curve.step(iterate.c, iterate.residual, iterate.jacobian, damping) - iterate.c
    angles = np.abs(curve.basis @ step)[:, ROTATIONS]
    if curve.is_framewise:
        largest = angles.max(axis=1, keepdims=True, initial=0)
    else:
        largest = angles.max(keepdims=True, initial=0)
    return np.asarray(iterate.c + step / np.maximum(1, largest / TUNED.leap))


def _largest_error(residual: Array) -> float:
    """Return the largest of errors whose components are residuals (F, m), metres."""
    return float(np.linalg.norm(residual.reshape(-1, 3), axis=-1).max())
