"""Checks of notebook 04."""

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap._shared.easing import quintic_step
from mocap.blending import weights
from mocap.body import rotations
from mocap.course.check import Check, Mistake, close_rotations


def _pair(rng: np.random.Generator) -> tuple[Array, Array, float]:
    start, end = (q / np.linalg.norm(q) for q in rng.normal(size=(2, 4)))
    return start, end, float(rng.uniform(0.1, 0.9))


def _sines(start: Array, end: Array, amount: float) -> Array:
    """Weight two quaternions by sines, without a change of sign: the long way round if they point apart."""
    angle = np.arccos(start @ end)
    return np.asarray((np.sin((1 - amount) * angle) * start + np.sin(amount * angle) * end) / np.sin(angle))


def _on_a_line(start: Array, end: Array, amount: float) -> Array:
    return (1 - amount) * start + amount * end


def _nearer(start: Array, end: Array) -> Array:
    return end if start @ end > 0 else -end


def _unit(q: Array) -> Array:
    return np.asarray(q / np.linalg.norm(q))


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
            lambda start, end, amount: (
                _sines(start, _nearer(start, end), amount) * np.sqrt(1 - (start @ end) ** 2)
            ),
            "your answer does not have length 1: divide by the sine of the whole angle.",
        ),
    ],
    same=close_rotations,
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


def _stray(points: Array, planted: NDArray[np.bool_], *, about: Array | None = None) -> float:
    """Measure the largest distance of planted points from their mean, or from another point, in cm."""
    centre = points[planted].mean(axis=0) if about is None else about
    return float(100 * np.linalg.norm(points[planted] - centre, axis=1).max())


slide = Check(
    name="slide",
    asks="the largest distance over the ground, in centimetres, of the planted joint from its mean place",
    start="keep only the planted frames, and of those x and z. Where is the joint on average?",
    draw=lambda rng: (
        rng.normal(size=(20, 3)).cumsum(axis=0) * 0.01,
        np.arange(20) - rng.integers(0, 10) < rng.integers(4, 10),
    ),
    truth=lambda positions, planted: _stray(positions[:, [0, 2]], planted),
    mistakes=[
        Mistake(_stray, "a heel that lifts does not slide: only x and z count."),
        Mistake(
            lambda positions, planted: _stray(positions[:, [0, 2]], planted) / 100,
            "that is in metres; centimetres are asked for.",
        ),
        Mistake(
            lambda positions, planted: _stray(positions[:, [0, 2]], np.ones(len(planted), bool)),
            "a foot in the air is free to move: count only the frames in which it is planted.",
        ),
        Mistake(
            lambda positions, planted: _stray(
                positions[:, [0, 2]], planted, about=positions[:, [0, 2]].mean(axis=0)
            ),
            "take the mean over the planted frames only.",
        ),
        Mistake(
            lambda positions, planted: _stray(
                positions[:, [0, 2]], planted, about=positions[planted.argmax()][[0, 2]]
            ),
            "measure from the mean place, not from where the plant begins.",
        ),
    ],
)


def _inner(thigh: float, shank: float, distance: float) -> float:
    """Give the angle between thigh and shank, radians."""
    return float(np.arccos((thigh**2 + shank**2 - distance**2) / (2 * thigh * shank)))


knee_bend = Check(
    name="knee_bend",
    asks="how far the knee is bent, in radians: 0 for a straight leg",
    start="the law of cosines gives the angle between thigh and shank. What is that angle in a straight leg?",
    draw=lambda rng: (*(bones := rng.uniform(0.3, 0.5, 2)), float(bones.sum() * rng.uniform(0.5, 0.99))),
    truth=lambda thigh, shank, distance: np.pi - _inner(thigh, shank, distance),
    mistakes=[
        Mistake(_inner, "that is the angle between the bones: π for a straight leg, whose bend is 0."),
        Mistake(
            lambda thigh, shank, distance: 180 - np.degrees(_inner(thigh, shank, distance)),
            "that is in degrees; radians are asked for.",
        ),
        Mistake(
            lambda thigh, shank, distance: _inner(thigh, distance, shank),
            "that is the angle at the hip: the side opposite the knee is the distance.",
        ),
        Mistake(
            lambda thigh, shank, distance: (
                np.arccos((thigh**2 + shank**2 - distance**2) / (thigh * shank) / 2) - np.pi
            ),
            "the size is right, but it has the wrong sign.",
        ),
    ],
)
