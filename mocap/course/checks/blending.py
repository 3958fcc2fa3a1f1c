"""Checks of notebook 04."""

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from mocap.blending import weights
from mocap.blending.interpolation import blend
from mocap.body import rotations
from mocap.body.motion import Motion
from mocap.body.skeleton import Skeleton
from mocap.course.check import Check, Mistake, close, close_rotations

NEAR = 1e-4  # radians between quaternions; below, a wrong answer may give anything


def _unit(q: Array) -> Array:
    return np.asarray(q / np.linalg.norm(q, axis=-1, keepdims=True))


def _pair(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw two rotations: far apart, almost the same or the same, and the second with either sign."""
    start, other = _unit(rng.normal(size=(2, 4)))
    away = _unit(other - (other @ start) * start) * 10.0 ** rng.uniform(-9, -5)
    end = (other, other, start + away, start)[rng.integers(4)]
    return start, _unit(end) * rng.choice([-1, 1]), float(rng.uniform(0.1, 0.9))


def _nearer(start: Array, end: Array) -> Array:
    return end if start @ end > 0 else -end


def _sines(start: Array, end: Array, amount: float) -> Array:
    """Weight by sines without a change of sign; NaN, which stands for any answer, near equal or opposite."""
    cosine = float(np.clip(start @ end, -1, 1))
    if abs(cosine) > np.cos(NEAR):
        return np.full(4, np.nan)
    angle = np.arccos(cosine)
    return np.asarray((np.sin((1 - amount) * angle) * start + np.sin(amount * angle) * end) / np.sin(angle))


def _on_a_line(start: Array, end: Array, amount: float) -> Array:
    return (1 - amount) * start + amount * end


def _same_where_known(given: Array, wanted: Array) -> bool:
    """Check whether two rotations are the same; a known mistake leaves open what it gives where it is NaN."""
    return bool(np.isnan(wanted).any()) or close_rotations(given, wanted)


short_way = Check(
    name="short_way",
    asks="the quaternion at `amount` of the way, at constant speed and the short way round",
    start="the angle Ω has the cosine start · end. What must you do with `end` if that is below 0?",
    draw=_pair,
    truth=rotations.slerp,
    mistakes=[
        Mistake(
            _sines,
            "that is the long way round: if start · end is below 0, use -end, which is the same rotation.",
        ),
        Mistake(
            lambda start, end, amount: _sines(start, _nearer(start, end), amount),
            "right where the rotations differ. Where they are equal, or almost, sin Ω is 0, or nearly: "
            "return a point of the straight line there.",
        ),
        Mistake(
            lambda start, end, amount: _sines(start, _nearer(start, end), 1 - amount),
            "amount 0 should give the start, and 1 the end; yours runs backwards.",
        ),
        Mistake(
            lambda start, end, amount: _unit(_on_a_line(start, _nearer(start, end), amount)),
            "the right arc, but not at constant speed: use sines of the angle as weights, not a line.",
        ),
        Mistake(
            lambda start, end, amount: _unit(_on_a_line(start, end, amount)),
            "that is on a straight line, and if start · end is below 0, it is also the long way round.",
        ),
        Mistake(
            lambda start, end, amount: _on_a_line(start, _nearer(start, end), amount),
            "your answer does not have length 1: a straight line cuts through the sphere of rotations.",
        ),
        Mistake(
            _on_a_line,
            "that is a straight line: it does not keep the length 1, and if start · end is below 0, it is "
            "also the long way round.",
        ),
        Mistake(
            lambda start, end, amount: (
                _sines(start, _nearer(start, end), amount) * np.sqrt(max(1 - (start @ end) ** 2, 0))
            ),
            "your answer does not have length 1: divide by the sine of the whole angle.",
        ),
    ],
    same=_same_where_known,
)


quintic = Check(
    name="quintic",
    asks="the weights of a window's frames, by a polynomial of degree five in t = (p + 1) / k",
    start="there are six conditions for six coefficients; those at t = 0 give three of them at once.",
    draw=lambda rng: (int(rng.integers(2, 60)),),
    truth=weights.quintic_weights,
    mistakes=[
        Mistake(
            lambda window: 1 - weights.quintic_weights(window),
            "these rise; the weights of the first motion fall from 1 to 0.",
        ),
        Mistake(
            lambda window: 1 - quintic_step(np.arange(window) / window),
            "one frame late: t is (p + 1) / k, so that the last frame of the window has weight 0.",
        ),
        Mistake(
            lambda window: 1 - quintic_step(np.linspace(0, 1, window)),
            "t is 0 in the frame *before* the window, not in its first frame, which would be wasted.",
        ),
        Mistake(weights.cubic_weights, "that is the cubic: its second derivative jumps at both ends."),
    ],
)


Poses = tuple[Array, Array]


def _two_motions(rng: np.random.Generator) -> tuple[Motion, Motion, Array]:
    """Draw two motions of three joints, in some frames with equal poses, and falling weights."""
    body = Skeleton(
        ["hip", "knee", "foot"], np.array([-1, 0, 1]), np.array([[0, 0, 0], [0, -0.4, 0], [0, -0.4, 0]])
    )
    frames = int(rng.integers(4, 9))
    turns = _unit(rng.normal(size=(2, frames, 3, 4)))
    turns[1, 0] = turns[0, 0] * rng.choice([-1, 1])
    a, b = (Motion(body, rng.normal(size=(frames, 3)), own, 30.0) for own in turns)
    return a, b, np.sort(rng.uniform(0, 1, frames))[::-1].copy()


def _roots(a: Motion, b: Motion, alpha: Array) -> Array:
    return np.asarray(alpha[:, None] * a.root_positions + (1 - alpha[:, None]) * b.root_positions)


def _turns(a: Motion, b: Motion, alpha: Array) -> Array:
    return rotations.slerp(b.rotations, a.rotations, alpha[:, None])


def _lines(a: Motion, b: Motion, alpha: Array, *, signed: bool, unit: bool) -> Array:
    """Mix quaternions on straight lines: with the nearer sign of b's or not, scaled to length 1 or not."""
    share = alpha[:, None, None]
    signs = np.sign((a.rotations * b.rotations).sum(-1, keepdims=True)) if signed else 1.0
    mixed = share * a.rotations + (1 - share) * signs * b.rotations
    return _unit(mixed) if unit else np.asarray(mixed)


def _mixed(a: Motion, b: Motion, alpha: Array) -> Poses:
    result = blend(a, b, alpha)
    return result.root_positions, result.rotations


def _same_poses(given: Poses, wanted: Poses) -> bool:
    roots, turns = given
    return close(roots, wanted[0]) and close_rotations(turns, wanted[1])


mix = Check(
    name="mix",
    asks="the root positions and the rotations of the mix, in this order",
    start="alpha[:, None] has the shape (F, 1). Multiply a's roots by it, b's by one minus it, and add them.",
    draw=_two_motions,
    truth=_mixed,
    mistakes=[
        Mistake(
            lambda a, b, alpha: _mixed(a, b, 1 - alpha),
            "alpha is the share of a; you give that share to b.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, alpha), _turns(a, b, 1 - alpha)),
            "the roots are right, the rotations run backwards: slerp's amount is the share of its second "
            "rotation.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, 1 - alpha), _turns(a, b, alpha)),
            "the rotations are right; in the roots, alpha is the share of a, not of b.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, alpha), a.rotations),
            "the roots are right, but the joints are still a's: mix their rotations as well.",
        ),
        Mistake(
            lambda a, b, alpha: (
                _roots(a, b, alpha),
                np.concatenate([_turns(a, b, alpha)[:, :1], a.rotations[:, 1:]], axis=1),
            ),
            "only the root is mixed: every joint turns, so give slerp the rotations of all joints.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, alpha), _lines(a, b, alpha, signed=False, unit=False)),
            "the roots are right; rotations are mixed by slerp, since a straight line leaves the sphere.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, alpha), _lines(a, b, alpha, signed=False, unit=True)),
            "the rotations are on straight lines, and some go the long way round: use slerp.",
        ),
        Mistake(
            lambda a, b, alpha: (_roots(a, b, alpha), _lines(a, b, alpha, signed=True, unit=True)),
            "the right arcs, but not at constant speed: use slerp instead of a line scaled to length 1.",
        ),
    ],
    same=_same_poses,
)
