"""The bodies of a still picture: which poses it shows, and in which row, so that none hides another.

A motion on the ground is drawn as bodies along its path, and a motion that stays at its position as a row of
poses. Motions at the same positions would hide each other, therefore each has a row of its own.
"""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np

from mocap._shared.arrays import Array
from mocap._shared.records import NamedTuple
from mocap.widgets.filmed_scene import FLAT, XZ, FilmedScene
from mocap.widgets.shaded_picture import YAW

WALKS = 1.0  # metres, the least extent on the ground of a motion that is drawn along its path
POSES = 8  # poses of a motion that stays at its position
BETWEEN = 1.05  # metres between those poses
MOST = 12  # bodies in a row
FEW = 3  # characters: more are drawn at the same moments
MOMENTS = 3  # number of those moments
APART = 0.85  # metres, the least distance between two bodies
NARROWEST = 0.7  # metres: motions with a smaller median distance have a row each
WIDENING = 1.15  # factor of the least distance while there are too many bodies
FORESHORTENED = 0.45  # factor of distances in depth, at which bodies hide each other
ROWS = 6  # largest number of rows


class Body(NamedTuple):
    """A pose in a picture: the character's number, the time in seconds, and the translation in metres."""

    number: int
    time: float
    moved: Array


def walks_on_ground(film: FilmedScene) -> bool:
    """Return whether a character of a scene moves over the ground, or a path is requested."""
    extents = [np.ptp(path[:, XZ], axis=0).max() for path in film.paths]
    return bool(max(extents) >= WALKS or len(film.scene["asked"]))


def bodies_in_rows(film: FilmedScene) -> list[list[Body]]:
    """Choose the bodies of a still picture, a list for each row of the picture.

    Each character has a body. Those on the ground are apart from each other: either by their positions, or
    because characters at the same positions have a row each.
    """
    numbers = range(len(film.clouds))
    if not walks_on_ground(film):
        return [_poses(film, number) for number in numbers]
    if len(numbers) <= ROWS and _hide_each_other(film):
        return [_spaced(film, [number]) for number in numbers]
    return [_spaced(film, list(numbers))]


def yaw_of_paths(film: FilmedScene) -> float:
    """Return the rotation of the camera for which the longest extent of the paths is horizontal."""
    ground = np.concatenate(film.paths) * FLAT
    ground = np.concatenate([ground, requested_path(film)])
    across = np.linalg.svd(ground - ground.mean(axis=0), full_matrices=False)[2][0]
    first = film.paths[0]
    if (first[-1] - first[0]) @ across < 0:
        across = -across
    return float(np.arctan2(-across[2], across[0]))


def requested_path(film: FilmedScene) -> Array:
    """Return the points of the requested path, (N, 3), metres."""
    return np.insert(np.reshape(film.scene["asked"], (-1, 2)), 1, 0.0, axis=1)


def _seen(film: FilmedScene) -> Array:
    """Return the paths of all characters, (N, T, 2), metres across and, foreshortened, in depth."""
    cos = np.cos(yaw_of_paths(film))
    sin = np.sin(yaw_of_paths(film))
    view = np.array([[cos, -sin], [FORESHORTENED * sin, FORESHORTENED * cos]])
    return np.asarray(np.array(film.paths)[..., XZ] @ view.T)


def _hide_each_other(film: FilmedScene) -> bool:
    """Return whether two characters are mostly at the same positions."""
    pairs = combinations(np.array(film.paths)[..., XZ], 2)
    return any(np.median(np.linalg.norm(p - q, axis=-1)) < NARROWEST for p, q in pairs)


def _poses(film: FilmedScene, number: int) -> list[Body]:
    """Return poses of a character at evenly spread times, side by side."""
    right = np.array([np.cos(YAW), 0, -np.sin(YAW)])
    times = np.unique(np.linspace(0, film.seconds, POSES).round(3)).tolist()
    bodies = []
    for place, time in enumerate(times):
        root = film.pose(number, time)[0] * FLAT
        bodies.append(Body(number, time, place * BETWEEN * right - root))
    return bodies


def _spaced(film: FilmedScene, numbers: list[int]) -> list[Body]:
    """Return bodies at a minimum distance from each other, or at the same moments for many characters."""
    if len(numbers) > FEW:
        moments = np.linspace(0, film.seconds, MOMENTS).tolist()
        return [Body(number, time, np.zeros(3)) for time in moments for number in numbers]
    seen = _seen(film)
    distance = APART * (1 + len(numbers)) / 2  # leaves gaps for the others
    chosen = _far_enough(seen, numbers, distance)
    while len(chosen) > MOST:
        distance *= WIDENING
        chosen = _far_enough(seen, numbers, distance)
    for number in set(numbers) - {number for number, _ in chosen}:
        bodies = np.array([seen[pair] for pair in chosen])
        nearest = np.linalg.norm(seen[number][:, None] - bodies, axis=-1).min(axis=1)
        chosen.append((number, int(nearest.argmax())))
    return [Body(number, float(film.times[index]), np.zeros(3)) for number, index in chosen]


def _far_enough(seen: Array, numbers: list[int], distance: float) -> list[tuple[int, int]]:
    """Choose pairs (character, index of its time) that are `APART`, those of one character by `distance`.

    The choice ends as soon as there are too many.
    """
    chosen: list[tuple[int, int]] = []
    for index in range(seen.shape[1]):
        counts = Counter(number for number, _ in chosen)
        for number in sorted(numbers, key=counts.__getitem__):  # characters with few bodies first
            if _is_free(seen, chosen, (number, index), distance):
                chosen.append((number, index))
        if len(chosen) > MOST:
            break
    return chosen


def _is_free(seen: Array, chosen: list[tuple[int, int]], pair: tuple[int, int], distance: float) -> bool:
    """Return whether a body is `APART` from those of other characters, and by `distance` from its own."""
    number, _ = pair
    for chosen_pair in chosen:
        limit = distance if chosen_pair[0] == number else APART
        if np.linalg.norm(seen[chosen_pair] - seen[pair]) <= limit:
            return False
    return True
