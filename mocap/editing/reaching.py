"""Each frame by itself: the smallest change of a pose that brings its joints to their pins.

This is inverse kinematics by numbers, for a key that an animator drags, and for the levels of [LS99]. Frames
that are solved alone do not know of each other: pinned ones jump against the free ones next to them.
"""

import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mocap._shared.arrays import Array
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.editing.displacements import displaced
from mocap.editing.linear_bodies import Body, Linear, body_of, linear, require_reachable
from mocap.editing.pins import Pins, Rows, pin_errors, require_pins_of
from mocap.errors import MocapError, MocapWarning

# Metres: what a solver may leave without a warning. The last millimetres are closed by triangles: `edit`.
TOLERANCE = 0.005

MET = 1e-9  # metres: a frame that is so near to its pins stays as it is

# Share of the cost: what a pass must gain, or it is the last.
GAIN = 1e-4

# Damping, as a share of the prices: at the start, and by what it falls where a pass helps and rises where
# not. With 4 in place of 10 the bar's worst frame is 60 mm off after 8 passes, not 14.
DAMPING, FALL, RISE = 1e-3, 4.0, 10.0


class Solved(NamedTuple):
    """A solver's answer: the `motion`, the `change` (F, n) of the `body`'s numbers, and the `worst` gaps.

    `worst` is in metres, pass by pass.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> walk = sample("walk_straight")[:9]
    >>> Solved(walk, np.zeros((9, 13)), Body((), (), np.ones(3)), [0.02, 0.001]).worst[-1]
    0.001
    """

    motion: Motion
    change: Array
    body: Body
    worst: list[float]


def reach(
    base: Motion, pins: Pins, body: Body | None = None, *, weight: float = 100.0, passes: int = 16
) -> Solved:
    """Bring joints to their pins, each frame by itself: the least xᵀ M x + w² Σ ‖gap‖².

    In the paper: [LS99, inverse kinematics].

    Steps of Levenberg and Marquardt, in all frames at once, each frame with its own damping. [LS99] solve the
    trunk by numbers, and limbs in closed form; here numbers do both.

    Parameters
    ----------
    base : F frames.
    pins : of F frames.
    body : which joints turn, at what price; `body_of(base, pins.joints)` by default. For a key, make it from
        the whole clip, which shows the hinges.
    weight : w; with 100 a stone of 30 cm is met to a millimetre, with 1000 to a hundredth.
    passes : at most.

    Returns
    -------
    Frames without pins are as they were.

    Raises
    ------
    MocapError : for pins of another motion, pins that no pose can meet, a weight or passes not above 0.

    Warns
    -----
    MocapWarning : for pins that are missed by more than 5 mm.

    Examples
    --------
    >>> from mocap.datasets import sample
    >>> from mocap.body.kinematics import joint_positions
    >>> from mocap.editing.pins import pin
    >>> walk = sample("walk_straight")[:60]
    >>> hand = joint_positions(walk)[30, walk.skeleton.index("lwrist")]
    >>> reach(walk, pin(walk, "lwrist", [30], hand + [0, 0.2, 0])).worst[-1] < 0.002
    True

    Notebook: 13-retargeting
    """
    body = ready(base, pins, body, weight)
    if not passes >= 1:
        raise MocapError(f"To reach takes at least one pass, got {passes}.")
    change, worst = each_frame(base, pins, body, weight, passes)
    motion = displaced(base, body.displacement(change, len(base.skeleton)))
    warn_of_gaps(motion, pins)
    return Solved(motion, change, body, worst)


def each_frame(base: Motion, pins: Pins, body: Body, weight: float, passes: int) -> tuple[Array, list[float]]:
    """Solve each frame that misses its pins: the change (F, n), and the worst gap after each pass, metres."""
    change, gaps = np.zeros((len(base), len(body.price))), pin_errors(base, pins).max(axis=1, initial=0.0)
    live = np.flatnonzero(gaps > MET)
    damping = np.full(len(base), DAMPING)
    worst: list[float] = []
    here: Linear | None = None
    while len(live) and len(worst) < passes:
        small, own, wishes = pared(base, body, pins, live)
        x = change[live]
        here = here or linear(small, own, x, wishes)
        before = cost(own, x, here.gap, weight)
        matrix, pull = normal_equations(here, own, x, weight, damping[live])
        y = np.asarray(np.linalg.solve(matrix, pull[..., None])[..., 0], float)
        there = linear(small, own, y, wishes)
        gain = before - cost(own, y, there.gap, weight)
        helps = gain > 0
        change[live] = np.where(helps[:, None], y, x)
        damping[live] *= np.where(helps, 1 / FALL, RISE)
        here = here.replaced(helps, there)
        gaps[live] = here.distances.max(axis=-1)
        worst.append(float(gaps.max()))
        more = np.abs(gain) > GAIN * before  # the others have arrived
        live, here = live[more], Linear(here.slopes[more], here.gap[more])
    return change, worst or [float(gaps.max())]


def pared(base: Motion, body: Body, pins: Pins, rows: Rows) -> tuple[Motion, Body, Pins]:
    """Keep some frames, and only the joints that are pinned, turn, or have such joints below them.

    No pinned joint's place depends on the others, and `linear` is the quicker without them.
    """
    skeleton = base.skeleton
    kept = sorted({0}.union(*(skeleton.path_to_root(joint) for joint in (*pins.joints, *body.joints))))
    number = {joint: n for n, joint in enumerate(kept)}
    small = Skeleton(
        [skeleton.names[joint] for joint in kept],
        np.array([number.get(int(skeleton.parents[joint]), -1) for joint in kept]),
        skeleton.offsets[kept],
    )
    turns = base.rotations[:, kept][rows]
    motion = Motion(small, base.root_positions[rows], turns, base.fps, base.name)
    own = Pins(tuple(number[joint] for joint in pins.joints), pins.low[rows], pins.high[rows])
    return motion, replace(body, joints=tuple(number[joint] for joint in body.joints)), own


def normal_equations(
    here: Linear, body: Body, change: Array, weight: float, damping: float | Array
) -> tuple[Array, Array]:
    """Build the equations G y = g, frame by frame, for the next change y from the change x = `change`.

    With the slopes J the sum yᵀ M y + w² ‖gap - J (y - x)‖² + λ (y - x)ᵀ M (y - x) is least where
    (M (1 + λ) + w² Jᵀ J) y = w² Jᵀ (gap + J x) + λ M x: a step of Levenberg and Marquardt.

    Parameters
    ----------
    here : the gaps and the slopes at x.
    body : its prices are the diagonal of M.
    change : x, shape (F, n).
    weight : w.
    damping : λ, one number or one for each frame, shape (F,).

    Returns
    -------
    G, shape (F, n, n), and g, shape (F, n).
    """
    upward = weight**2 * np.swapaxes(here.slopes, 1, 2)  # (F, n, 3P)
    damped = np.multiply.outer(damping, body.price)  # (n,) or (F, n)
    matrix = upward @ here.slopes
    diagonal = np.arange(len(body.price))
    matrix[:, diagonal, diagonal] += body.price + damped
    wanted = here.gap + np.einsum("fmn,fn->fm", here.slopes, change)
    return matrix, np.einsum("fnm,fm->fn", upward, wanted) + damped * change


def cost(body: Body, change: Array, gap: Array, weight: float) -> Array:
    """Add up xᵀ M x + w² ‖gap‖² for each frame, shape (F,)."""
    return np.asarray((change**2 * body.price).sum(axis=-1) + weight**2 * (gap**2).sum(axis=-1))


def ready(base: Motion, pins: Pins, body: Body | None, weight: float) -> Body:
    """Raise `MocapError` for what cannot be solved; else give the body, chosen by default."""
    require_pins_of(base, pins)
    require_reachable(base, pins)
    if not (np.isfinite(weight) and weight > 0):
        raise MocapError(f"A weight of pins is above 0, got {weight}.")
    if body is None:
        return body_of(base, pins.joints)
    if not all(0 <= joint < len(base.skeleton) for joint in body.joints):
        raise MocapError(f"The body turns joints that '{base.name}' lacks: it has {len(base.skeleton)}.")
    return body


def warn_of_gaps(motion: Motion, pins: Pins, tolerance: float | Array = TOLERANCE) -> None:
    """Warn of the pin that is missed by most beyond its tolerance (metres, broadcast to (F, P))."""
    errors = pin_errors(motion, pins)
    beyond = errors - tolerance
    if beyond.size and beyond.max() > 0:
        frame, joint = np.unravel_index(beyond.argmax(), beyond.shape)
        warnings.warn(
            f"'{motion.name}', frame {frame}: '{motion.skeleton.names[pins.joints[joint]]}' is "
            f"{1000 * errors[frame, joint]:.3g} mm off its pin, and pins of {int((beyond > 0).any(1).sum())} "
            "frames are missed: are they within reach, and do they agree?",
            MocapWarning,
            stacklevel=3,
        )
