"""One solver for all edits: the smallest smooth change of a motion that brings its joints to their pins.

The change x (F, n) holds the root's place and the turns of a body's joints, and m = m₀ ⊕ x. It is a curve
x = B c, and

    Σ_f x_fᵀ M x_f  +  Σ_f τ⁴ ẍ_fᵀ M ẍ_f  +  w² Σ ‖gap‖²

is least: M holds the body's prices, τ says what a bend costs, w is a weight. With B = 1 and τ = 0 each frame
is by itself: inverse kinematics. With splines for B all frames hang together: spacetime [Gle98]. Several such
`Basis` are solved one after the other, each from where the one before ended [Gle98, finer knots]. Prices, τ,
and the weight in place of [Gle98]'s Lagrange multipliers are ours.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.editing.bodies import Body, body_of, require_reachable
from mocap.editing.displacements import displaced
from mocap.editing.pins import Pins, pin_errors, require_pins_of
from mocap.editing.steps import Basis, Curve, led, linear
from mocap.errors import MocapError, warn

TOLERANCE = 0.005  # metres: what the solver may leave without a warning
MET = 5e-10  # metres: pins that are so near are met

GAIN = 3e-5  # share of the cost: what a pass must gain, or it is the last; a hundredth where it does not help
FALL, RISE = 3.0, 10.0  # the damping falls so where a pass helps, and rises so where it does not

# The damping at first where pins hold a ceiling. The first pass is then one of a small weight, and
# the body bows. With the weight at once a neck folds by up to 360°.
CEILING = 1000.0


REACH = Basis(weight=100.0, damping=1e-3, passes=16)
"""Each frame by itself: inverse kinematics, as [LS99] need it."""

CLOSE = Basis(calm=0.06, weight=1e6, damping=0.1)
"""What splines leave, closed to the last digit."""


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


def solve(
    base: Motion, pins: Pins, bases: Sequence[Basis], body: Body | None = None, *, quiet: bool = False
) -> Solved:
    """Bring joints to their pins by the smallest smooth change, in one basis after the other.

    In the paper: [Gle98, objective; finer knots], [LS99, inverse kinematics].

    Steps of Levenberg and Marquardt, `Curve.step`, on the control points c of x = B c. The time grows with
    the frames.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    bases : one or more. `REACH` brings each frame by itself to its pins; those without pins stay as they are.
    body : which joints turn, at what price; `body_of(base, pins)` by default. For a single frame, make
        it from the whole clip, which shows the hinges.
    quiet : whether to say nothing of pins that are missed.

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
    require_pins_of(base, pins)
    require_reachable(base, pins)
    if not len(bases):
        raise MocapError("To solve takes a basis or more, got none.")
    body = body or body_of(base, pins)
    change, worst = np.zeros((len(base), len(body.price))), [float(pin_errors(base, pins).max(initial=0.0))]
    for number, way in enumerate(bases):
        if number == 0 and (np.isfinite(pins.high) & ~pins.held)[:, : len(pins.joints)].any():
            way = way._replace(damping=CEILING)
        if not (way.knots >= 0 <= way.calm and way.weight > 0 <= way.damping and way.lead >= 0 < way.passes):
            raise MocapError(f"A basis needs a weight and a pass above 0, and no number below 0; got {way}.")
        missed = pin_errors(base, pins).max(axis=1, initial=0.0) > MET
        rows = np.flatnonzero(missed) if way.alone else slice(None)
        change = np.zeros_like(change)
        if missed.any():
            some = Motion(base.skeleton, base.root_positions[rows], base.rotations[rows], base.fps)
            wanted = led(base, pins, way.lead) if way.lead else pins
            change[rows], left = _descend(some, wanted.at(rows), body, way)
            base = displaced(base, body.displacement(change, len(base.skeleton)))
            worst += left
    if not quiet:
        warn_of_gaps(base, pins)
    return Solved(base, worst, change)


def _descend(base: Motion, pins: Pins, body: Body, way: Basis) -> tuple[Array, list[float]]:
    """Improve the change (F, n) pass by pass; also give the worst gap after each pass, metres."""
    curve = Curve(way, base, body.price)
    worst: list[float] = []
    c = np.zeros((curve.basis.shape[1], len(body.price)))
    damping = np.full((len(base) if way.alone else 1, 1), way.damping)
    gap, slopes = linear(base, body, curve.basis @ c, pins)
    while len(worst) < way.passes:
        new = curve.step(c, gap, slopes, damping)
        left, then = linear(base, body, curve.basis @ new, pins)
        before = curve.cost(c, gap)
        gain = before - curve.cost(new, left)  # of each frame by itself, or of all together
        helps = gain > 0
        c = np.where(helps, new, c)
        gap, slopes = np.where(helps, left, gap), np.where(helps[..., None], then, slopes)
        more = (np.abs(gain) > np.where(helps, GAIN, GAIN / 100) * before) | (helps & (damping > 1))
        damping = np.where(helps, damping / FALL, damping * RISE)
        worst.append(float(np.linalg.norm(gap.reshape(-1, 3), axis=-1).max()))
        if not more.any() or worst[-1] < MET:
            break
    return curve.basis @ c, worst


def warn_of_gaps(motion: Motion, pins: Pins, tolerance: float = TOLERANCE) -> None:
    """Warn of the pin that is missed by most beyond a tolerance, metres."""
    errors = pin_errors(motion, pins)
    if errors.max(initial=0.0) > tolerance:
        frame, joint = np.unravel_index(errors.argmax(), errors.shape)
        name, far = motion.skeleton.names[pins.ends[joint]], 1000 * errors[frame, joint]
        off = f"'{name}' is {far:.3g} mm off its pin"
        missed = f"pins of {int((errors > tolerance).any(1).sum())} frames are missed"
        why = "are they within reach, and do they agree?"
        warn(f"'{motion.name}', frame {frame}: {off}, and {missed}: {why}")
