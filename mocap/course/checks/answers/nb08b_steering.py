"""Notebook 08b: inputs, right answers and mistakes of `obeys_after`, `crowding_cost` and `next_edge`."""

import numpy as np

from mocap._shared.arrays import Array, Points
from mocap.course.checks.answers.common import Arguments

# ---- obeys_after


def draw_obeys_after(rng: np.random.Generator) -> Arguments:
    """Draw a walk that turns to another heading, often across ±180°; some need not turn, some turn back."""
    frame = int(rng.integers(20, 40))
    back = int(rng.integers(5, 12))
    first = rng.uniform(-np.pi, np.pi)
    side = rng.choice([-1, 1])
    turn = side * rng.choice([*rng.uniform(0.7, np.pi, 2), np.pi, 0.0])
    wait = rng.integers(0, 20)
    duration = rng.integers(15, 60)
    frames = np.arange(frame + rng.integers(20, 120))
    share = np.clip((frames - frame - wait) / duration, 0, 1)
    headings = first + turn * share
    steps = rng.uniform(0.02, 0.05) * np.stack([np.sin(headings), np.cos(headings)], axis=1)
    return np.cumsum(steps, axis=0), float(first + turn), frame, back


def right_obeys_after(track: Array, heading: float, frame: int, back: int) -> int:
    """Find the frame, counted from the command, in which a walk goes the new way."""
    moved = track[back:] - track[:-back]
    difference = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    difference = np.abs((difference + np.pi) % (2 * np.pi) - np.pi)
    obeys = difference[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


def mistake_x_and_z_swapped(track: Array, heading: float, frame: int, back: int) -> object:
    """Measure the walk's direction from the x-axis: arctan2(z, x) - heading."""
    return right_obeys_after(track[:, ::-1], heading, frame, back)


def mistake_not_wrapped(track: Array, heading: float, frame: int, back: int) -> object:
    """Compare the absolute difference of the two angles without reducing it to ±180°."""
    moved = track[back:] - track[:-back]
    difference = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    difference = np.abs(difference)
    obeys = difference[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


def mistake_signed_difference(track: Array, heading: float, frame: int, back: int) -> object:
    """Compare the signed difference with 20°, neither reduced to ±180° nor absolute."""
    moved = track[back:] - track[:-back]
    difference = np.arctan2(moved[:, 0], moved[:, 1]) - heading
    obeys = difference[max(frame - back, 0) :] < np.radians(20)
    return int(obeys.argmax()) if obeys.any() else -1


def mistake_from_start(track: Array, heading: float, frame: int, back: int) -> object:
    """Look from the first frame that has a direction, and count from there instead of from the command."""
    return right_obeys_after(track, heading, back, back)


def mistake_too_late(track: Array, heading: float, frame: int, back: int) -> object:
    """Look and count only from `back` frames after the command."""
    return right_obeys_after(track, heading, frame + back, back)


def mistake_frame_number(track: Array, heading: float, frame: int, back: int) -> object:
    """Return the index of the frame in the track instead of the frames since the command."""
    correct = right_obeys_after(track, heading, frame, back)
    return correct + frame if correct >= 0 else -1


# ---- crowding_cost


def draw_crowding_cost(rng: np.random.Generator) -> Arguments:
    """Draw two lines that come near each other; the other one may be shorter or longer."""
    count = int(rng.integers(30, 50))
    neighbour_count = int(rng.integers(15, 60))
    track = np.stack([np.zeros(count), np.linspace(0, 2, count)], axis=1)
    neighbour = np.stack([np.linspace(-1, 1, neighbour_count), np.full(neighbour_count, 1.0)], axis=1)
    shake = rng.normal(scale=0.03, size=(count, 2))
    return track + shake, neighbour + rng.normal(scale=0.1, size=2), float(rng.uniform(0.6, 1.2))


def right_crowding_cost(track: Array, neighbour: Array, clearance: float) -> float:
    """Add up the squared shortfalls, max(0, clearance - distance)², of two walkers in each frame."""
    positions = neighbour[np.minimum(np.arange(len(track)), len(neighbour) - 1)]
    shortfall = np.maximum(clearance - np.hypot(*(track - positions).T), 0.0)
    return float(np.sum(shortfall**2))


def mistake_stops_with_other(track: Array, neighbour: Array, clearance: float) -> object:
    """Add up the squared shortfalls only over the frames that both tracks have."""
    return right_crowding_cost(track[: len(neighbour)], neighbour[: len(track)], clearance)


def mistake_any_frame(track: Array, neighbour: Array, clearance: float) -> object:
    """Measure each frame to the neighbour's nearest position in any of its frames."""
    offsets = track[:, None] - neighbour
    distances = np.hypot(offsets[..., 0], offsets[..., 1]).min(axis=1)
    shortfall = np.maximum(clearance - distances, 0.0)
    return float(np.sum(shortfall**2))


def mistake_below_zero(track: Array, neighbour: Array, clearance: float) -> object:
    """Add up (clearance - distance)² over all frames, also those farther apart than the clearance."""
    positions = neighbour[np.minimum(np.arange(len(track)), len(neighbour) - 1)]
    shortfall = clearance - np.hypot(*(track - positions).T)
    return float(np.sum(shortfall**2))


def mistake_metres(track: Array, neighbour: Array, clearance: float) -> object:
    """Add up the shortfalls in metres, not their squares."""
    positions = neighbour[np.minimum(np.arange(len(track)), len(neighbour) - 1)]
    shortfall = np.maximum(clearance - np.hypot(*(track - positions).T), 0.0)
    return float(np.sum(shortfall))


def mistake_root(track: Array, neighbour: Array, clearance: float) -> object:
    """Return the square root of the sum of the squared shortfalls."""
    return np.sqrt(right_crowding_cost(track, neighbour, clearance))


# ---- next_edge


def draw_next_edge(rng: np.random.Generator) -> Arguments:
    """Draw tracks whose velocities are near the one asked for, and near those that mistakes ask for."""
    rotation = np.exp(1j * rng.uniform(-3, 3))
    heading = rng.uniform(-3, 3)
    speed = rng.uniform(0.4, 2.0)
    wanted = speed * np.exp(1j * heading)
    fps = float(rng.choice([30, 60]))
    tracks = []
    back = wanted / rotation
    for aim in (back, wanted, 1j * np.conj(wanted) / rotation, 3 * back, back):
        count = int(rng.integers(3, 20))
        velocity = aim * np.exp(rng.normal(scale=0.3) + 1j * rng.normal(scale=0.3))
        sway = 0.02 * rng.normal(size=(count, 2)) @ [1, 1j]
        tracks.append(velocity * np.arange(count) / fps + sway)
    return complex(rotation), tracks, float(heading), float(speed), fps


def right_next_edge(rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float) -> int:
    """Choose the track of n + 1 points whose mean velocity, turned, is nearest to the one asked for."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) * fps for track in tracks]
    return int(np.argmin([abs(rotation * v - wanted) for v in velocities]))


def mistake_not_rotated(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Compare the tracks' velocities in the frame of the clip with the request."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) * fps for track in tracks]
    return int(np.argmin([abs(v - wanted) for v in velocities]))


def mistake_rotated_backwards(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Compare the tracks' velocities, rotated by the inverse rotation, with the request."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) * fps for track in tracks]
    return int(np.argmin([abs(v / rotation - wanted) for v in velocities]))


def mistake_heading_from_x(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Measure the requested heading from +x towards +z: speed · i · exp(-i heading)."""
    wanted = speed * 1j * np.exp(-1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) * fps for track in tracks]
    return int(np.argmin([abs(rotation * v - wanted) for v in velocities]))


def mistake_sum_of_steps(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Compare the displacement of each track in metres with the requested velocity."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) for track in tracks]
    return int(np.argmin([abs(rotation * v - wanted) for v in velocities]))


def mistake_per_frame(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Compare mean velocities in metres per frame with the requested one in metres per second."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) for track in tracks]
    return int(np.argmin([abs(rotation * v - wanted) for v in velocities]))


def mistake_frames_for_steps(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Divide by the number of points n + 1 instead of the n steps between them."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / len(track) * fps for track in tracks]
    return int(np.argmin([abs(rotation * v - wanted) for v in velocities]))


def mistake_direction_alone(
    rotation: complex, tracks: list[Points], heading: float, speed: float, fps: float
) -> object:
    """Choose the track whose mean direction is nearest to the heading, whatever its speed."""
    wanted = speed * np.exp(1j * heading)
    velocities = [complex(track[-1] - track[0]) / (len(track) - 1) * fps for track in tracks]
    return int(np.argmin([abs(rotation * v / abs(v) - wanted / speed) for v in velocities]))
