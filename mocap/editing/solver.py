"""One solver for all edits: the smallest smooth change of a motion that brings its joints to their pins.

The change x (F, n) holds the root's place and the turns of a body's joints, and m = m₀ ⊕ x. It is a curve
x = B c, and

    Σ_f x_fᵀ M x_f  +  Σ_f τ⁴ ẍ_fᵀ M ẍ_f  +  w² Σ ‖gap‖²

is least: M holds the body's prices, τ says what a bend costs, w is a weight. With B = 1 and τ = 0 each frame
is by itself: inverse kinematics. With splines for B all frames hang together: spacetime [Gle98]. Several such
`Basis` are solved one after the other, each from where the one before ended [Gle98, finer knots]. Prices, τ,
and the weight in place of [Gle98]'s Lagrange multipliers are ours.
"""

import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag, solveh_banded

from mocap._shared.arrays import Array
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.bodies import Body, body_of, require_reachable
from mocap.editing.displacements import displaced, right_jacobian, spline_basis
from mocap.editing.pins import Pins, Rows, pin_errors, require_pins_of
from mocap.errors import MocapError, MocapWarning

TOLERANCE = 0.005  # metres: what the solver may leave without a warning
MET = 5e-10  # metres: pins that are so near are met

# Metres: a joint so near to the end of its box shall keep to it in the next step. With 0 a head under a bar
# leaves the bar and comes back, and 100 passes do not end; with 1e-3 they end as soon.
NEAR = 1e-4

GAIN = 3e-5  # share of the cost: what a pass must gain, or it is the last; a hundredth where it does not help
FALL, RISE = 3.0, 10.0  # the damping falls so where a pass helps, and rises so where it does not

# Times the damping, at first, where pins hold a ceiling. The first pass is then one of a small weight, and
# the body bows. With the weight at once a neck folds by up to 360°.
CEILING = 1000.0

RIDGE = 1e-10  # of the least price: a clip of fewer frames than splines leaves some of them unseen


class Basis(NamedTuple):
    """How a change may run over time, and how it is solved for.

    Parameters
    ----------
    knots : seconds between the knots of its splines: 0.5 leaves centimetres, 0.125 millimetres, and below
        accelerations grow. With 0 each frame has its own numbers.
    calm : τ, seconds: a change dies away within about τ of a pin. With 0 bends cost nothing.
    weight : w, per metre. On splines 100 leaves 10 mm on a stone of 20 cm, 300 leaves 3 mm, 1000 no less.
    damping : λ at first, as a share of the prices: a step is one of the weight w / √(1 + λ).
    passes : at most.

    Examples
    --------
    >>> Basis(knots=0.125).alone, REACH.alone
    (False, True)

    Notebook: 14-levels
    """

    knots: float = 0.0
    calm: float = 0.0
    weight: float = 300.0
    damping: float = 1.0
    passes: int = 30

    @property
    def alone(self) -> bool:
        """Whether each frame is by itself."""
        return self.knots == self.calm == 0


REACH = Basis(weight=100.0, damping=1e-3, passes=16)
"""Each frame by itself: inverse kinematics, as [LS99] need it."""

CLOSE = Basis(calm=0.06, weight=1e6, damping=0.1)
"""What splines leave, closed to the last digit."""


class Solved(NamedTuple):
    """The solver's answer: the `motion`, and the worst gap at first and after each pass, metres.

    `change` (F, n) holds the numbers of the `body` that the last basis added.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> Solved(walk, [0.02, 0.001], np.zeros((9, 13)), body_of(walk, [4, 5])).worst[-1]
    0.001
    """

    motion: Motion
    worst: list[float]
    change: Array
    body: Body


def solve(base: Motion, pins: Pins, bases: Sequence[Basis], body: Body | None = None) -> Solved:
    """Bring joints to their pins by the smallest smooth change, in one basis after the other.

    In the paper: [Gle98, objective; finer knots], [LS99, inverse kinematics].

    Steps of Levenberg and Marquardt, `plain_step`, on the control points c of x = B c. The time grows with
    the frames.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    bases : one or more. `REACH` brings each frame by itself to its pins; those without pins stay as they are.
    body : which joints turn, at what price; `body_of(base, pins.joints)` by default. For a single frame, make
        it from the whole clip, which shows the hinges.

    Returns
    -------
    The new motion, and how near it comes; without pins the motion as it is.

    Raises
    ------
    MocapError : for pins of another motion, pins that no pose can meet, no basis, and numbers of a basis that
        are not above 0.

    Warns
    -----
    MocapWarning : for pins that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import join_pins, pin, plant_pins
    >>> walk = sample("walk_straight")[:120]
    >>> hand = joint_positions(walk)[60, walk.skeleton.index("lwrist")]
    >>> wishes = join_pins(plant_pins(walk), pin(walk, "lwrist", [60], hand + [0, 0.2, 0]))
    >>> solve(walk, wishes, [Basis(knots=0.125)]).worst[-1] < 0.005
    True

    Notebook: 13-retargeting
    """
    solved = solve_quietly(base, pins, bases, body)
    warn_of_gaps(solved.motion, pins)
    return solved


def solve_quietly(base: Motion, pins: Pins, bases: Sequence[Basis], body: Body | None = None) -> Solved:
    """Solve as `solve` does, without a word on what is left."""
    _check(base, pins, bases)
    body = body or body_of(base, pins.joints)
    if not (body.joints < len(base.skeleton)).all():
        raise MocapError(f"The body turns joints that '{base.name}' lacks: it has {len(base.skeleton)}.")
    change, worst = np.zeros((len(base), len(body.price))), [float(pin_errors(base, pins).max(initial=0.0))]
    for number, way in enumerate(bases):
        if number == 0 and not way.alone and (np.isfinite(pins.high) & ~pins.held).any():
            way = way._replace(damping=CEILING * way.damping)
        missed = pin_errors(base, pins).max(axis=1, initial=0.0) > MET
        rows = np.flatnonzero(missed) if way.alone else slice(None)
        change = np.zeros_like(change)
        if missed.any():
            change[rows], left = _descend(*_pared(base, pins, body, rows), way)
            base = displaced(base, body.displacement(change, len(base.skeleton)))
            worst += left
    return Solved(base, worst, change, body)


def _descend(base: Motion, pins: Pins, body: Body, way: Basis) -> tuple[Array, list[float]]:
    """Improve the change (F, n) pass by pass; also give the worst gap after each pass, metres."""
    curve, worst = Curve(way, base, body.price), []
    c = np.zeros((curve.basis.shape[1], len(body.price)))
    damping = np.full((len(base) if way.alone else 1, 1), way.damping)
    now = linear(base, body, curve.basis @ c, pins)
    while len(worst) < way.passes:
        new = curve.step(c, now, damping)
        then = linear(base, body, curve.basis @ new, pins)
        before = curve.cost(c, now.gap)
        gain = before - curve.cost(new, then.gap)  # of each frame by itself, or of all together
        helps = gain > 0
        c, now = np.where(helps, new, c), now.replaced(helps, then)
        more = (np.abs(gain) > np.where(helps, GAIN, GAIN / 100) * before) | (helps & (damping > 1))
        damping = np.where(helps, damping / FALL, damping * RISE)
        worst.append(now.worst)
        if not more.any() or now.worst < MET:
            break
    return curve.basis @ c, worst


class Linear(NamedTuple):
    """What is left to do in each frame, `gap` (F, m), metres, and how it closes with x, `slopes` (F, m, n).

    Rows of axes for which nothing is to do are 0: free ones, and boxes that the joint is in.
    """

    gap: Array
    slopes: Array

    @property
    def worst(self) -> float:
        """The largest distance of a joint from its pin, metres."""
        return float(np.linalg.norm(self.gap.reshape(len(self.gap), -1, 3), axis=-1).max())

    def replaced(self, helps: Array, other: "Linear") -> "Linear":
        """Take the frames (F, 1), or all (1, 1), where it helps from another one."""
        slopes = np.where(helps[..., None], other.slopes, self.slopes)
        return Linear(np.where(helps, other.gap, self.gap), slopes)


def linear(base: Motion, body: Body, x: Array, pins: Pins) -> Linear:
    """Measure the P pinned joints' gaps at m₀ ⊕ x, and how they close with x (F, n), in all frames at once.

    A joint at p_j, turned in the world by R_j and by d_j already, turns about its own axis a: a joint e below
    moves by ∂p_e = (R_j J(d_j) a) × (p_e - p_j), with J the right Jacobian. The root's place moves all by 1.
    """
    change = body.displacement(x, len(base.skeleton))
    poses = forward_kinematics(displaced(base, change))
    spins = poses.matrices @ right_jacobian(change.turns)
    axes = np.einsum("ftij,tj->fti", spins[:, body.joints], body.axes)  # in the world, (F, T, 3)
    slopes = np.zeros((len(base), len(pins.joints), 3, x.shape[1]))
    slopes[..., :3] = np.eye(3)
    for number, end in enumerate(pins.joints):
        above = np.flatnonzero(np.isin(body.joints, base.skeleton.path_to_root(end)[1:]))
        arms = poses.positions[:, [end]] - poses.positions[:, body.joints[above]]
        slopes[:, number][..., 3 + above] = np.swapaxes(np.cross(axes[:, above], arms), 1, 2)
    places = poses.positions[:, list(pins.joints)]
    slopes *= (places != np.clip(places, pins.low + NEAR, pins.high - NEAR))[..., None]
    return Linear(pins.gap(poses.positions).reshape(len(base), -1), slopes.reshape(len(base), -1, x.shape[1]))


def plain_step(curve: "Curve", c: Array, now: Linear, damping: float) -> Array:
    """Take one step of Levenberg and Marquardt: the next control points c (K, n).

    With the slopes J by c, and the price P of c, the sum ‖c'‖²_P + w² ‖gap - J (c' - c)‖² + λ ‖c' - c‖²_P is
    least where

        (w² JᵀJ + (1 + λ) P) c' = w² Jᵀ (gap + J c) + λ P c.

    `Curve.step` finds the same, without the zeros of these large matrices.

    Parameters
    ----------
    curve : says how x = B c may run, and what it costs.
    c : shape (K, n).
    now : gaps and slopes at x = B c.
    damping : λ.

    Notebook: 14-levels
    """
    n = c.shape[1]
    B, bends = (np.kron(matrix.toarray(), np.eye(n)) for matrix in (curve.basis, curve.bends))
    M = np.diag(np.tile(curve.price, len(now.gap)))
    bent = np.diag(np.tile(curve.price, curve.bends.shape[0]))
    P = B.T @ M @ B + bends.T @ bent @ bends
    J = curve.weight * block_diag(*now.slopes) @ B
    gap = curve.weight * now.gap.ravel()
    found = np.linalg.solve(
        J.T @ J + (1 + damping) * P, J.T @ (gap + J @ c.ravel()) + damping * P @ c.ravel()
    )
    return np.asarray(found.reshape(-1, n))


class Curve:
    """How a change x = B c may run over F frames, and the least squares of its control points c (K, n).

    `basis` is B (F, K), `bends` are τ² times its second differences (F - 2, K). Splines that are far apart
    share no frame and no bend. So the equations are banded, and the time is linear in F.
    """

    def __init__(self, way: Basis, base: Motion, price: Array) -> None:
        frames, identity = len(base), sparse.eye_array(len(base), format="csr")
        self.weight, self.price, self.alone = way.weight, price, way.alone
        self.basis = spline_basis(frames, way.knots * base.fps) if way.knots else identity
        knots, ends = self.basis.shape[1], max(frames - 2, 0)
        second = self.basis[:ends] - 2 * self.basis[1 : ends + 1] + self.basis[2 : ends + 2]
        self.bends = (way.calm * base.fps) ** 2 * second
        near = (self.basis.T @ self.basis + abs(self.bends.T) @ abs(self.bends)).tocoo()
        apart = range(1 + int((near.col - near.row).max()))
        both = (self.basis.tocsc(), self.bends.tocsc())
        # b_k b_{k+d} in each frame, (K - d, F), and the same of the bends, added up.
        self.pairs, bent = ([(b[:, : knots - d] * b[:, d:]).T.tocsr() for d in apart] for b in both)
        self.bent = [pair.sum(axis=1) for pair in bent]

    def step(self, c: Array, now: Linear, damping: Array) -> Array:
        """Find the next control points c (K, n), as `plain_step` does; λ is (1, 1), or (F, 1) by frame."""
        (knots, n), diagonal = c.shape, np.arange(c.shape[1])
        x, upward = self.basis @ c, self.weight**2 * np.swapaxes(now.slopes, 1, 2)
        matrix = upward @ now.slopes
        matrix[:, diagonal, diagonal] += (1 + damping) * self.price
        wanted = now.gap + np.einsum("fmn,fn->fm", now.slopes, x)
        pull = np.einsum("fnm,fm->fn", upward, wanted) + damping * self.price * x
        right = self.basis.T @ pull + damping * self.price * (self.bends.T @ (self.bends @ c))
        band = np.zeros((len(self.pairs) * n, knots * n))  # lower form: entry (i, j) stands at (i - j, j)
        for d, (pair, bent) in enumerate(zip(self.pairs, self.bent, strict=True)):
            blocks = (pair @ matrix.reshape(len(matrix), -1)).reshape(-1, n, n)  # of splines k and k + d
            if not self.alone:
                blocks[:, diagonal, diagonal] += (1 + damping) * bent[:, None] * self.price
            for j in range(n):
                top = max(d * n - j, 0)
                band[top : (d + 1) * n - j, j : (knots - d) * n : n] = blocks[:, j, top + j - d * n :].T
        band[0] += RIDGE * self.price.min()
        return np.asarray(
            solveh_banded(band, right.ravel(), lower=True, check_finite=False).reshape(knots, n)
        )

    def cost(self, c: Array, gap: Array) -> Array:
        """Add up what is to be least, for each frame by itself (F, 1), or for all together (1, 1)."""
        each = ((self.basis @ c) ** 2) @ self.price + self.weight**2 * (gap**2).sum(axis=1)
        if self.alone:
            return np.asarray(each[:, None])
        return np.array([[each.sum() + (((self.bends @ c) ** 2) @ self.price).sum()]])


def _pared(base: Motion, pins: Pins, body: Body, rows: Rows) -> tuple[Motion, Pins, Body]:
    """Keep some frames, and only joints that are pinned or turn, and those above: the others play no part."""
    skeleton = base.skeleton
    kept = sorted({0}.union(*(skeleton.path_to_root(int(joint)) for joint in (*pins.joints, *body.joints))))
    number = {joint: n for n, joint in enumerate(kept)}
    small = Skeleton(
        [skeleton.names[joint] for joint in kept],
        np.array([number.get(int(skeleton.parents[joint]), -1) for joint in kept]),
        skeleton.offsets[kept],
    )
    motion = Motion(small, base.root_positions[rows], base.rotations[rows][:, kept], base.fps, base.name)
    own = Pins(tuple(number[joint] for joint in pins.joints), pins.low[rows], pins.high[rows])
    return motion, own, body._replace(joints=np.searchsorted(kept, body.joints))


def _check(base: Motion, pins: Pins, bases: Sequence[Basis]) -> None:
    """Raise `MocapError` for what cannot be solved."""
    require_pins_of(base, pins)
    require_reachable(base, pins)
    if not len(bases):
        raise MocapError("To solve takes a basis or more, got none.")
    for way in bases:
        if not (0 <= way.knots < np.inf and 0 <= way.calm < np.inf and 0 < way.weight < np.inf):
            raise MocapError(f"A basis needs knots and calm of 0 s or more, and a weight above 0, got {way}.")
        if not (way.passes >= 1 and 0 <= way.damping < np.inf):
            raise MocapError(f"A basis needs a pass or more, and a damping of 0 or more, got {way}.")


def warn_of_gaps(motion: Motion, pins: Pins, tolerance: float = TOLERANCE) -> None:
    """Warn of the pin that is missed by most beyond a tolerance, metres."""
    errors = pin_errors(motion, pins)
    if errors.max(initial=0.0) > tolerance:
        frame, joint = np.unravel_index(errors.argmax(), errors.shape)
        warnings.warn(
            f"'{motion.name}', frame {frame}: '{motion.skeleton.names[pins.joints[joint]]}' is "
            f"{1000 * errors[frame, joint]:.3g} mm off its pin, and pins of "
            f"{int((errors > tolerance).any(1).sum())} "
            "frames are missed: are they within reach, and do they agree?",
            MocapWarning,
            stacklevel=3,
        )
