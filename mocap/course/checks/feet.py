"""Checks of notebook 04b."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mocap._shared.arrays import Array
from mocap.course.check import Check, Mistake

Marks = NDArray[np.bool_]


def _stray(points: Array, planted: Marks, *, about: Array | None = None) -> float:
    """Measure the largest distance of planted points from their mean, or from another point, in cm."""
    centre = points[planted].mean(axis=0) if about is None else about
    return float(100 * np.linalg.norm(points[planted] - centre, axis=1).max())


def _first_to_last(places: Array) -> float:
    return float(100 * np.linalg.norm(places[-1] - places[0]))


def _path_length(places: Array) -> float:
    return float(100 * np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


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
        Mistake(
            lambda positions, planted: _first_to_last(positions[planted][:, [0, 2]]),
            "that is from the first planted frame to the last; a foot may slide away and come back.",
        ),
        Mistake(
            lambda positions, planted: _path_length(positions[planted][:, [0, 2]]),
            "that is the length of the joint's path; the largest distance from its mean place is asked for.",
        ),
    ],
)


def _speeds(rng: np.random.Generator) -> tuple[Array, float, float]:
    """Draw the speed of a joint: slow and fast stretches with noise, and two thresholds."""
    level = np.repeat(rng.uniform(0.0, 1.0, 8), rng.integers(2, 6, 8))
    return np.abs(level + rng.normal(0, 0.08, len(level))), 0.25, 0.5


def _grown(speed: Array, start: float, stay: float, *, ways: tuple[int, ...] = (1, -1)) -> Marks:
    """Mark frames below `start`, and grow the marks one frame at a time while the speed is below `stay`."""
    marks = speed < start
    for way in ways:
        order = range(len(speed))[::way]
        for before, frame in pairwise(order):
            marks[frame] |= marks[before] and speed[frame] < stay
    return marks


plant_marks = Check(
    name="plant_marks",
    asks="marks: True in every run of frames below `stay` that has a frame below `start`",
    start="begin with marks = speed < start. Then go through the frames and let a mark pass to the next one.",
    draw=_speeds,
    truth=_grown,
    mistakes=[
        Mistake(
            lambda speed, start, stay: speed < start,
            "that uses `start` alone: noise cuts a plant in pieces. A plant lasts until the speed is above "
            "`stay`.",
        ),
        Mistake(
            lambda speed, start, stay: speed < stay,
            "that uses `stay` alone: a joint that only slows down, and never falls below `start`, does not "
            "stand.",
        ),
        Mistake(
            lambda speed, start, stay: _grown(speed, start, stay, ways=(1,)),
            "a plant also begins earlier: from the first frame below `start`, go back while the speed is "
            "below `stay`.",
        ),
        Mistake(
            lambda speed, start, stay: _grown(speed, start, stay, ways=(-1,)),
            "a plant also lasts longer: from the last frame below `start`, go on while the speed is below "
            "`stay`.",
        ),
        Mistake(
            lambda speed, start, stay: ~_grown(speed, start, stay),
            "the marks are the wrong way round: True where the joint stands.",
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
