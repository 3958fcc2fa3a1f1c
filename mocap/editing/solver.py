"""One solver for all edits: the smallest smooth change of a motion that brings its joints to their pins.

The change x (F, n) holds the root's place and the turns of a body's joints, and m = m₀ ⊕ x. It is a curve
x = B c, and

    Σ_f x_fᵀ M x_f  +  Σ_f τ⁴ ẍ_fᵀ M ẍ_f  +  w² Σ ‖gap‖²

is least: M holds the body's prices, τ says what a bend costs, w is a weight. With B = 1 and τ = 0 each frame
is by itself: inverse kinematics. With splines for B all frames hang together: spacetime [Gle98]. Several such
`Stage` are solved one after the other, each from where the one before ended [Gle98, finer knots]. Prices, τ,
and the weight in place of [Gle98]'s Lagrange multipliers are ours.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.linalg import solveh_banded

from mocap._shared.arrays import Array, Mask
from mocap._shared.records import NamedTuple
from mocap.body.kinematics import forward_kinematics
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, body_of, require_reachable, warn_of_gaps
from mocap.editing.displacements import displaced, right_jacobian, spline_basis
from mocap.editing.pins import Pins, require_pins_of
from mocap.editing.tuned import TUNED
from mocap.errors import MocapError
from mocap.feet.ankle_targets import smooth_fill

MET = 5e-10  # metres: pins that are so near are met

NEAR = 1e-4  # metres: so near to the end of its box a joint keeps to it in the next step; with 0 it leaves
RIDGE = 1e-13  # of the largest entry: a clip of fewer frames than splines leaves some of them unseen
KEPT = 2  # frames on either side of those that may change: beside them a change and its rate are 0
EVERY_FRAME = slice(None)


class Stage(NamedTuple):
    """How a change may run over time, and how it is solved for.

    Parameters
    ----------
    knots : seconds between the knots of its splines: 0.5 leaves centimetres, 0.125 millimetres, and below
        accelerations grow. With 0 each frame has its own numbers.
    decay : τ, seconds: a change dies away within about τ of a pin. With 0 bends cost nothing.
    weight : w, per metre. On splines 100 leaves 10 mm on a stone of 20 cm, 300 leaves 3 mm, 1000 no less.
    damping : λ at first, as a share of the prices: a step is one of the weight w / √(1 + λ).
    passes : at most.
    lead : seconds: above 0 joints are led from pin to pin, and to the first and from the last in this time.

    Examples
    --------
    >>> Stage()
    Stage(knots=0.0, decay=0.0, weight=300.0, damping=1.0, passes=30, lead=0.0)
    >>> [stage.is_framewise for stage in (Stage(), Stage(knots=0.125), Stage(decay=0.1))]
    [True, False, False]

    Notebook: 14-levels
    """

    knots: float = 0.0
    decay: float = 0.0
    weight: float = 300.0
    damping: float = 1.0
    passes: int = 30
    lead: float = 0.0

    @property
    def is_framewise(self) -> bool:
        """Whether each frame is by itself."""
        return self.knots == self.decay == 0


REACH = Stage(weight=TUNED.reach_weight, damping=TUNED.reach_damping, passes=TUNED.reach_passes)
"""Each frame by itself: inverse kinematics, as [LS99] need it."""


def closing_stages() -> tuple["Stage", "Stage"]:
    """Return the stages that close what splines leave, to the last digit.

    Examples
    --------
    >>> [stage.is_framewise for stage in closing_stages()]
    [False, False]
    """
    stage = Stage(
        decay=TUNED.close_decay,
        weight=TUNED.close_weight,
        damping=TUNED.close_damping,
    )
    return stage, stage


class Solved(NamedTuple):
    """The solver's answer: the `motion`, and the worst gap at first and after each pass, metres.

    `change` (F, n) holds the numbers of the body that the last basis added.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> Solved(walk, [0.02, 0.001], np.zeros((9, 13))).worst[-1]
    0.001
    """

    motion: Motion
    worst: list[float]
    change: Array


def solve(  # noqa: PLR0913 (a motion, constraints, how to solve, and two options)
    base: Motion,
    pins: Pins,
    bases: Sequence[Stage],
    body: Body | None = None,
    *,
    quiet: bool = False,
    frames: slice = EVERY_FRAME,
) -> Solved:
    """Bring joints to their pins by the smallest smooth change, in one basis after the other.

    In the paper: [Gle98, objective; finer knots], [LS99, inverse kinematics].

    Steps of Levenberg and Marquardt, `solver.Curve.step`, on the control points c. The time grows with F.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    bases : one or more. `REACH` brings each frame by itself to its pins; those without pins stay as they are.
    body : which joints turn, at what price; `body_of(base, pins)` by default. For a single frame, make
        it from the whole clip, which shows the hinges.
    quiet : whether to say nothing of pins that are missed.
    frames : those that may change, in a row. All others stay the same to the last bit, and the change begins
        and ends smoothly.

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
    >>> solve(walk, wishes, [Stage(knots=0.125)]).worst[-1] < 0.005
    True

    Notebook: 13-retargeting
    """
    require_pins_of(base, pins)
    require_reachable(base, pins)
    if not len(bases):
        raise MocapError("To solve takes a basis or more, got none.")
    body = body or body_of(base, pins)
    change, worst = np.zeros((len(base), len(body.price))), list[float]()
    first, stop, _ = frames.indices(len(base))
    window = slice(max(first - KEPT, 0), stop + KEPT)
    stays = np.ones(len(base), bool)
    stays[first:stop] = False
    before = base
    for number, way in enumerate(bases):
        if number == 0 and (np.isfinite(pins.high) & ~pins.held)[:, : len(pins.joints)].any():
            way = way._replace(damping=TUNED.bar_damping)
        if not (way.knots >= 0 <= way.decay and way.weight > 0 <= way.damping and way.lead >= 0 < way.passes):
            raise MocapError(f"A basis needs a weight and a pass above 0, and no number below 0; got {way}.")
        poses = forward_kinematics(base)
        places = pins.places(base, poses)
        missed = np.linalg.norm(pins.gap(places), axis=-1).max(axis=1, initial=0.0)
        rows = np.flatnonzero((missed > MET) & ~stays) if way.is_framewise else window
        worst, change = worst or [float(missed.max(initial=0.0))], np.zeros_like(change)
        if (missed > MET).any():
            wanted = led(places, pins, base.fps, way.lead) if way.lead else pins
            change[rows], left = _descend(base[rows], wanted.at(rows), body, way, stays[rows])
            base = displaced(base, body.displacement(change, len(base.skeleton)))
            worst += left
    base = with_frames_of(base, before, stays)
    if not quiet:
        warn_of_gaps(base, pins)
    return Solved(base, worst, change)


def with_frames_of(motion: Motion, source: Motion, chosen: Mask) -> Motion:
    """Replace the chosen frames (F,) by those of the source: poses and contacts, to the last bit."""
    if not chosen.any():
        return motion
    roots = np.where(chosen[:, None], source.root_positions, motion.root_positions)
    turned = np.where(chosen[:, None, None], source.rotations, motion.rotations)
    contacts = dict(motion.contacts)
    for name, mark in source.contacts.items():
        contacts[name] = np.where(chosen, mark, contacts.get(name, mark))
    return replace(motion, root_positions=roots, rotations=turned, contacts=contacts)


def _descend(base: Motion, pins: Pins, body: Body, way: Stage, stays: Mask) -> tuple[Array, list[float]]:
    """Improve the change (F, n) pass by pass; also give the worst gap after each pass, metres."""
    curve = Curve(way, base, body.price, stays)
    if not curve.basis.shape[1]:  # no curve of this basis leaves in place the frames that stay
        return np.zeros((len(base), len(body.price))), []
    worst: list[float] = []
    c = np.zeros((curve.basis.shape[1], len(body.price)))
    damping = np.full((len(base) if way.is_framewise else 1, 1), way.damping)
    gap, slopes = linear(base, body, curve.basis @ c, pins)
    while len(worst) < way.passes:
        step = curve.step(c, gap, slopes, damping) - c
        turned = np.abs(curve.basis @ step)[:, 3:].max(
            axis=1 if way.is_framewise else None, keepdims=True, initial=0
        )
        new = c + step / np.maximum(1, turned / TUNED.leap)
        left, then = linear(base, body, curve.basis @ new, pins)
        before = curve.cost(c, gap)
        gain = before - curve.cost(new, left)  # of each frame by itself, or of all together
        helps = gain > 0
        c = np.where(helps, new, c)
        gap, slopes = np.where(helps, left, gap), np.where(helps[..., None], then, slopes)
        more = (np.abs(gain) > np.where(helps, TUNED.gain, TUNED.loss) * before) | (helps & (damping > 1))
        damping = np.where(helps, damping / TUNED.fall, damping * TUNED.rise)
        worst.append(float(np.linalg.norm(gap.reshape(-1, 3), axis=-1).max()))
        if not more.any() or worst[-1] < MET:
            break
    return curve.basis @ c, worst


def led(places: Array, pins: Pins, fps: float, seconds: float) -> Pins:
    """Pin joints between their pins, too: to their own places, moved by the curve that bends least [ours].

    Without it angles change smoothly, but a foot at the end of a chain of them accelerates.
    """
    low, high = pins.low.copy(), pins.high.copy()
    for joint, axis in np.argwhere(pins.held[:, : len(pins.joints)].any(axis=0)):
        at, held = np.s_[:, joint, axis], pins.held[:, joint, axis]
        away = np.where(held, low[at] - places[at], 0.0)[:, None]
        way = places[at] + smooth_fill(away, held, fps, seconds)[:, 0]
        free = np.isinf(low[at]) & np.isinf(high[at])
        low[at], high[at] = np.where(free, way, low[at]), np.where(free, way, high[at])
    return Pins(pins.joints, low, high, pins.turns)


def linear(base: Motion, body: Body, x: Array, pins: Pins) -> tuple[Array, Array]:
    """Measure what is left to do at m₀ ⊕ x, and how it closes with x (F, n), in all frames at once.

    Gives the gaps (F, m), metres, and the slopes (F, m, n), three rows for each box. Rows of axes for which
    nothing is to do are 0: free ones, and boxes that the joint is in.

    A joint at p_j, turned in the world by R_j and by d_j already, turns about its own axis a: a joint e below
    moves by ∂p_e = (R_j J(d_j) a) × (p_e - p_j), with J the right Jacobian. The root's place moves all by 1.
    How joint i is turned, v = log(r⁻¹ R_i), changes by ∂v = J(v)⁻¹ R_iᵀ R_j J(d_j) a: `TUNED.arm` times this
    are more rows.
    """
    change = body.displacement(x, len(base.skeleton))
    moved = displaced(base, change)
    poses = forward_kinematics(moved)
    joints, which = np.unique(body.joints, return_inverse=True)
    spins = poses.matrices[:, joints] @ right_jacobian(change.turns[:, joints])
    axes = np.einsum("ftij,tj->fti", spins[:, which], body.axes)  # in the world, (F, T, 3)
    places, held = pins.places(moved, poses), len(pins.joints)
    moves = np.array([np.isin(body.joints, movers) for movers in pins.movers(base.skeleton)])  # (P + T, T')
    slopes = np.zeros((*places.shape, x.shape[1]))
    slopes[:, :held, :, :3] = np.eye(3)
    arms = poses.positions[:, pins.ends[:held], None] - poses.positions[:, None, body.joints]
    slopes[:, :held, :, 3:] = np.swapaxes(np.cross(axes[:, None], arms), 2, 3)
    inside = np.einsum("fpji,ftj->fpit", poses.matrices[:, pins.ends[held:]], axes)
    slopes[:, held:, :, 3:] = TUNED.arm * np.linalg.solve(
        right_jacobian(places[:, held:] / TUNED.arm), inside
    )
    slopes[..., 3:] *= moves[:, None]
    slopes *= (places != np.clip(places, pins.low + NEAR, pins.high - NEAR))[..., None]
    return pins.gap(places).reshape(len(base), -1), slopes.reshape(len(base), -1, x.shape[1])


class Curve:
    """How a change x = B c may run over F frames, and the least squares of its control points c (K, n).

    `basis` is B (F, K), `bends` are τ² times its second differences (F - 2, K). Splines that are far apart
    share no frame and no bend. So the equations are banded, and the time is linear in F. Those that would
    change a frame that `stays` (F,), at the beginning or the end, are left out.
    """

    def __init__(self, way: Stage, base: Motion, price: Array, stays: Mask | None = None) -> None:
        frames, identity = len(base), sparse.eye_array(len(base), format="csr")
        self.weight, self.price, self.is_framewise = way.weight, price, way.is_framewise
        self.basis = spline_basis(frames, way.knots * base.fps) if way.knots else identity
        if stays is not None and stays.any():
            self.basis = self.basis[:, np.flatnonzero(self.basis[stays].sum(axis=0) == 0)]
        knots, ends = self.basis.shape[1], max(frames - 2, 0)
        second = self.basis[:ends] - 2 * self.basis[1 : ends + 1] + self.basis[2 : ends + 2]
        self.bends = (way.decay * base.fps) ** 2 * second
        near = (self.basis.T @ self.basis + abs(self.bends.T) @ abs(self.bends)).tocoo()
        apart = range(1 + int((near.col - near.row).max(initial=0)))
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
        if self.is_framewise:
            return np.asarray(each[:, None])
        return np.array([[each.sum() + (((self.bends @ c) ** 2) @ self.price).sum()]])
