"""Checks of notebook 08b."""

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.course.check import Check, Mistake


def _seconds_until(track: Array, heading: float, frame: int, back: int, wrap: str = "both") -> float:
    moved = track[back:] - track[:-back]
    off = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    if wrap == "both":
        off = np.abs((off + np.pi) % (2 * np.pi) - np.pi)
    elif wrap == "abs":
        off = np.abs(off)
    obeys = off[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


def _swapped(track: Array, heading: float, frame: int, back: int) -> float:
    return _seconds_until(track[:, ::-1], heading, frame, back)


def _draw_obeys_after(rng: np.random.Generator) -> tuple[Array, float, int, int]:
    """Draw a walk that turns to another heading, often across ±180°; some need not turn, some turn back."""
    frame, back = int(rng.integers(20, 40)), int(rng.integers(5, 12))
    first = rng.uniform(-np.pi, np.pi)
    turn = rng.choice([-1, 1]) * rng.choice([rng.uniform(0.7, np.pi), rng.uniform(0.7, np.pi), np.pi, 0.0])
    wait, takes = rng.integers(0, 20), rng.integers(15, 60)
    share = np.clip((np.arange(frame + rng.integers(20, 120)) - frame - wait) / takes, 0, 1)
    ways = first + turn * share
    steps = rng.uniform(0.02, 0.05) * np.stack([np.sin(ways), np.cos(ways)], axis=1)
    return np.cumsum(steps, axis=0), float(first + turn), frame, back


obeys_after = Check(
    name="obeys_after",
    asks="the number of frames from the command until the character obeys, -1 for never",
    start="its direction in frame i is that of track[i] - track[i - back]; np.arctan2(x, z) gives the angle.",
    draw=_draw_obeys_after,
    truth=_seconds_until,
    mistakes=[
        Mistake(_swapped, "headings start at +z: the angle of (x, z) is np.arctan2(x, z)."),
        Mistake(
            lambda track, heading, frame, back: _seconds_until(track, heading, frame, back, "abs"),
            "350° and -10° are one direction: bring the difference between -180° and 180° first.",
        ),
        Mistake(
            lambda track, heading, frame, back: _seconds_until(track, heading, frame, back, "none"),
            "a difference of -90° is not small: take its absolute value, between -180° and 180°.",
        ),
        Mistake(
            lambda track, heading, frame, back: _seconds_until(track, heading, back, back),
            "count from the command, not from the start of the walk.",
        ),
        Mistake(
            lambda track, heading, frame, back: _seconds_until(track, heading, frame + back, back),
            "you begin to look only when all of the direction lies after the command.",
        ),
        Mistake(
            lambda track, heading, frame, back: (
                _seconds_until(track, heading, frame, back) + frame
                if _seconds_until(track, heading, frame, back) >= 0
                else -1
            ),
            "that is the number of the frame; count from the command.",
        ),
    ],
)


def _crowding(track: Array, other: Array, apart: float, price: float = 1.0) -> float:
    there = other[np.minimum(np.arange(len(track)), len(other) - 1)]
    near = np.maximum(apart - np.hypot(*(track - there).T), 0.0)
    return float(price * np.sum(near**2))


def _leaves(track: Array, other: Array, apart: float) -> float:
    both = min(len(track), len(other))
    return _crowding(track[:both], other[:both], apart)


def _nearest_ever(track: Array, other: Array, apart: float) -> float:
    distance = np.hypot(*(track[:, None] - other).transpose(2, 0, 1)).min(axis=1)
    return float(np.sum(np.maximum(apart - distance, 0.0) ** 2))


def _without_floor(track: Array, other: Array, apart: float) -> float:
    there = other[np.minimum(np.arange(len(track)), len(other) - 1)]
    return float(np.sum((apart - np.hypot(*(track - there).T)) ** 2))


def _linear(track: Array, other: Array, apart: float) -> float:
    there = other[np.minimum(np.arange(len(track)), len(other) - 1)]
    return float(np.sum(np.maximum(apart - np.hypot(*(track - there).T), 0.0)))


def _draw_crowding(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw two lines that come near each other; the other one may be shorter or longer."""
    count, others = int(rng.integers(30, 50)), int(rng.integers(15, 60))
    track = np.stack([np.zeros(count), np.linspace(0, 2, count)], axis=1)
    other = np.stack([np.linspace(-1, 1, others), np.full(others, 1.0)], axis=1)
    shake = rng.normal(scale=0.03, size=(count, 2))
    return track + shake, other + rng.normal(scale=0.1, size=2), float(rng.uniform(0.6, 1.2))


crowding_cost = Check(
    name="crowding_cost",
    asks="one number: the sum of the squared metres too near",
    start="np.hypot gives the distance in each frame; np.maximum(apart - distance, 0) how much is missing.",
    draw=_draw_crowding,
    truth=_crowding,
    mistakes=[
        Mistake(_leaves, "the other one stays where its track ends; you stop counting there."),
        Mistake(
            _nearest_ever, "compare the two in the same frame: they may pass one place at different times."
        ),
        Mistake(_without_floor, "far away costs nothing: what is missing is never below 0."),
        Mistake(_linear, "you sum the metres that are missing; sum their squares."),
        Mistake(
            lambda track, other, apart: np.sqrt(_crowding(track, other, apart)),
            "no square root: the sum of squares itself is the cost.",
        ),
    ],
)


def _nearest(turn: complex, velocities: list[complex], wanted: complex) -> int:
    return int(np.argmin([abs(turn * velocity - wanted) for velocity in velocities]))


def _mean_velocities(tracks: list[Points], fps: float, frames: int = -1) -> list[complex]:
    """Give the mean velocity along each track of n + 1 points, which are n frames apart."""
    return [complex(track[-1] - track[0]) / (len(track) + frames) * fps for track in tracks]


def _draw_choice(rng: np.random.Generator) -> tuple[complex, list[Points], float, float, float]:
    """Draw tracks whose velocities are near the one asked for, and near those that mistakes ask for."""
    turn, heading, speed = np.exp(1j * rng.uniform(-3, 3)), rng.uniform(-3, 3), rng.uniform(0.4, 2.0)
    wanted, fps = speed * np.exp(1j * heading), float(rng.choice([30, 60]))
    tracks = []
    for aim in (wanted / turn, wanted, 1j * np.conj(wanted) / turn, 3 * wanted / turn, wanted / turn):
        count = int(rng.integers(3, 20))
        velocity = aim * np.exp(rng.normal(scale=0.3) + 1j * rng.normal(scale=0.3))
        sway = 0.02 * rng.normal(size=(count, 2)) @ [1, 1j]
        tracks.append(velocity * np.arange(count) / fps + sway)
    return complex(turn), tracks, float(heading), float(speed), fps


def _by_direction(turn: complex, tracks: list[Points], heading: float, speed: float, fps: float) -> int:
    ways = [velocity / abs(velocity) for velocity in _mean_velocities(tracks, fps)]
    return _nearest(turn, ways, complex(np.exp(1j * heading)))


next_edge = Check(
    name="next_edge",
    asks="the number of the track whose mean velocity, placed on the ground, is nearest to the command",
    start="the command is the velocity speed · exp(i · heading); what is the velocity of one track?",
    draw=_draw_choice,
    truth=lambda turn, tracks, heading, speed, fps: _nearest(
        turn, _mean_velocities(tracks, fps), speed * np.exp(1j * heading)
    ),
    mistakes=[
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                1, _mean_velocities(tracks, fps), speed * np.exp(1j * heading)
            ),
            "a track is in the coordinates of its clip, and the clip is turned: multiply by `turn`.",
        ),
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                1 / turn, _mean_velocities(tracks, fps), speed * np.exp(1j * heading)
            ),
            "you turn the track back; `turn` is how its clip is turned on the ground.",
        ),
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                turn, _mean_velocities(tracks, fps), 1j * speed * np.exp(-1j * heading)
            ),
            "a heading of 0 is +z, and points are z + ix: the command is speed · exp(i · heading).",
        ),
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                turn, [track[-1] - track[0] for track in tracks], speed * np.exp(1j * heading)
            ),
            "you compare metres with metres per second: divide by the time that the track takes.",
        ),
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                turn, _mean_velocities(tracks, 1.0), speed * np.exp(1j * heading)
            ),
            "that is a velocity per frame: multiply by fps.",
        ),
        Mistake(
            lambda turn, tracks, heading, speed, fps: _nearest(
                turn, _mean_velocities(tracks, fps, 0), speed * np.exp(1j * heading)
            ),
            "n + 1 points are n frames apart, so the first and the last are n / fps seconds apart.",
        ),
        Mistake(_by_direction, "you compare the directions alone; the command is also a speed."),
    ],
)
