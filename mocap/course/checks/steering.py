"""Random input and answers, right and wrong, for `08b-steering.toml`."""

import numpy as np

from mocap._shared.arrays import Array, Points


def seconds_until(track: Array, heading: float, frame: int, back: int) -> float:
    moved = track[back:] - track[:-back]
    off = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    off = np.abs((off + np.pi) % (2 * np.pi) - np.pi)
    obeys = off[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


def draw_obeys_after(rng: np.random.Generator) -> tuple[Array, float, int, int]:
    """Draw a walk that turns to another heading, often across ±180°; some need not turn, some turn back."""
    frame, back = int(rng.integers(20, 40)), int(rng.integers(5, 12))
    first = rng.uniform(-np.pi, np.pi)
    turn = rng.choice([-1, 1]) * rng.choice([rng.uniform(0.7, np.pi), rng.uniform(0.7, np.pi), np.pi, 0.0])
    wait, takes = rng.integers(0, 20), rng.integers(15, 60)
    share = np.clip((np.arange(frame + rng.integers(20, 120)) - frame - wait) / takes, 0, 1)
    ways = first + turn * share
    steps = rng.uniform(0.02, 0.05) * np.stack([np.sin(ways), np.cos(ways)], axis=1)
    return np.cumsum(steps, axis=0), float(first + turn), frame, back


def crowding(track: Array, other: Array, apart: float) -> float:
    there = other[np.minimum(np.arange(len(track)), len(other) - 1)]
    near = np.maximum(apart - np.hypot(*(track - there).T), 0.0)
    return float(np.sum(near**2))


def draw_crowding_cost(rng: np.random.Generator) -> tuple[Array, Array, float]:
    """Draw two lines that come near each other; the other one may be shorter or longer."""
    count, others = int(rng.integers(30, 50)), int(rng.integers(15, 60))
    track = np.stack([np.zeros(count), np.linspace(0, 2, count)], axis=1)
    other = np.stack([np.linspace(-1, 1, others), np.full(others, 1.0)], axis=1)
    shake = rng.normal(scale=0.03, size=(count, 2))
    return track + shake, other + rng.normal(scale=0.1, size=2), float(rng.uniform(0.6, 1.2))


def nearest(turn: complex, velocities: list[complex], wanted: complex) -> int:
    return int(np.argmin([abs(turn * velocity - wanted) for velocity in velocities]))


def mean_velocities(tracks: list[Points], fps: float, frames: int = -1) -> list[complex]:
    """Give the mean velocity along each track of n + 1 points, which are n frames apart."""
    return [complex(track[-1] - track[0]) / (len(track) + frames) * fps for track in tracks]


def draw_next_edge(rng: np.random.Generator) -> tuple[complex, list[Points], float, float, float]:
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
