"""One step of the solver: how joints move when a body turns a little, and the change that closes gaps."""

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array
from mocap.body.kinematics import forward_kinematics, joint_positions
from mocap.body.motion import Motion
from mocap.editing.bodies import ARM, Body
from mocap.editing.displacements import displaced, right_jacobian, spline_basis
from mocap.editing.pins import Pins
from mocap.feet.ankle_targets import smooth_fill

# Metres: a joint so near to the end of its box shall keep to it in the next step. With 0 a head under a bar
# leaves the bar and comes back, and 100 passes do not end; with 1e-3 they end as soon.
NEAR = 1e-4

RIDGE = 1e-13  # of the largest entry: a clip of fewer frames than splines leaves some of them unseen


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
    lead : seconds: above 0 joints are led from pin to pin, and to the first and from the last in this time.

    Examples
    --------
    >>> Basis(knots=0.125).alone, Basis().alone
    (False, True)

    Notebook: 14-levels
    """

    knots: float = 0.0
    calm: float = 0.0
    weight: float = 300.0
    damping: float = 1.0
    passes: int = 30
    lead: float = 0.0

    @property
    def alone(self) -> bool:
        """Whether each frame is by itself."""
        return self.knots == self.calm == 0


def led(base: Motion, pins: Pins, seconds: float) -> Pins:
    """Pin joints between their pins, too: to their own way, moved by the curve that bends least [ours].

    Without it angles change smoothly, but a foot at the end of a chain of them accelerates.
    """
    places, low, high = joint_positions(base)[:, list(pins.joints)], pins.low.copy(), pins.high.copy()
    for joint, axis in np.argwhere(pins.held[:, : len(pins.joints)].any(axis=0)):
        at, held = np.s_[:, joint, axis], pins.held[:, joint, axis]
        away = np.where(held, low[at] - places[at], 0.0)[:, None]
        way = places[at] + smooth_fill(away, held, base.fps, seconds)[:, 0]
        free = np.isinf(low[at]) & np.isinf(high[at])
        low[at], high[at] = np.where(free, way, low[at]), np.where(free, way, high[at])
    return Pins(pins.joints, low, high, pins.turns)


def linear(base: Motion, body: Body, x: Array, pins: Pins) -> tuple[Array, Array]:
    """Measure what is left to do at m₀ ⊕ x, and how it closes with x (F, n), in all frames at once.

    Gives the gaps (F, m), metres, and the slopes (F, m, n), three rows for each box. Rows of axes for which
    nothing is to do are 0: free ones, and boxes that the joint is in.

    A joint at p_j, turned in the world by R_j and by d_j already, turns about its own axis a: a joint e below
    moves by ∂p_e = (R_j J(d_j) a) × (p_e - p_j), with J the right Jacobian. The root's place moves all by 1.
    How joint i is turned, v = log(r⁻¹ R_i), changes by ∂v = J(v)⁻¹ R_iᵀ R_j J(d_j) a: `ARM` times this are
    more rows.
    """
    change = body.displacement(x, len(base.skeleton))
    moved = displaced(base, change)
    poses = forward_kinematics(moved)
    joints, which = np.unique(body.joints, return_inverse=True)
    spins = poses.matrices[:, joints] @ right_jacobian(change.turns[:, joints])
    axes = np.einsum("ftij,tj->fti", spins[:, which], body.axes)  # in the world, (F, T, 3)
    places = pins.places(moved, poses)
    slopes = np.zeros((*places.shape, x.shape[1]))
    slopes[:, : len(pins.joints), :, :3] = np.eye(3)
    for number, (end, movers) in enumerate(zip(pins.ends, pins.movers(base.skeleton), strict=True)):
        above = np.flatnonzero(np.isin(body.joints, movers))
        if number < len(pins.joints):
            arms = poses.positions[:, [end]] - poses.positions[:, body.joints[above]]
            ways = np.swapaxes(np.cross(axes[:, above], arms), 1, 2)
        else:
            inside = np.einsum("fji,ftj->fit", poses.matrices[:, end], axes[:, above])
            ways = ARM * np.linalg.solve(right_jacobian(places[:, number] / ARM), inside)
        slopes[:, number][..., 3 + above] = ways
    slopes *= (places != np.clip(places, pins.low + NEAR, pins.high - NEAR))[..., None]
    return pins.gap(places).reshape(len(base), -1), slopes.reshape(len(base), -1, x.shape[1])


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

    def step(self, c: Array, gap: Array, slopes: Array, damping: Array) -> Array:
        """Take one step of Levenberg and Marquardt: the next control points c (K, n).

        With the gap and the slopes J that `linear` gives, and the price P of c,
        ‖c'‖²_P + w² ‖gap - J (c' - c)‖² + λ ‖c' - c‖²_P is least where

            (w² JᵀJ + (1 + λ) P) c' = w² Jᵀ (gap + J c) + λ P c;

        λ is (1, 1), or (F, 1) by frame. These large matrices are banded.
        """
        (knots, n), diagonal = c.shape, np.arange(c.shape[1])
        x, upward = self.basis @ c, self.weight**2 * np.swapaxes(slopes, 1, 2)
        matrix = upward @ slopes
        matrix[:, diagonal, diagonal] += (1 + damping) * self.price
        wanted = gap + np.einsum("fmn,fn->fm", slopes, x)
        pull = np.einsum("fnm,fm->fn", upward, wanted) + damping * self.price * x
        right = self.basis.T @ pull + damping * self.price * (self.bends.T @ (self.bends @ c))
        band = np.zeros((len(self.pairs) * n, knots * n))  # lower form: entry (i, j) stands at (i - j, j)
        for d, (pair, bent) in enumerate(zip(self.pairs, self.bent, strict=True)):
            blocks = (pair @ matrix.reshape(len(matrix), -1)).reshape(-1, n, n)  # of splines k and k + d
            blocks[:, diagonal, diagonal] += (1 + damping) * bent[:, None] * self.price
            for j in range(n):
                top = max(d * n - j, 0)
                band[top : (d + 1) * n - j, j : (knots - d) * n : n] = blocks[:, j, top + j - d * n :].T
        band[0] += RIDGE * band[0].max()
        solved = solveh_banded(band, right.ravel(), lower=True, check_finite=False)
        return np.asarray(solved.reshape(knots, n))

    def cost(self, c: Array, gap: Array) -> Array:
        """Add up what is to be least, for each frame by itself (F, 1), or for all together (1, 1)."""
        each = ((self.basis @ c) ** 2) @ self.price + self.weight**2 * (gap**2).sum(axis=1)
        if self.alone:
            return np.asarray(each[:, None])
        return np.array([[each.sum() + (((self.bends @ c) ** 2) @ self.price).sum()]])
