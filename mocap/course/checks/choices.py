"""Random input and answers, right and wrong, for `05b-choices.toml`."""

import itertools
from typing import Any

import numpy as np

from mocap.course.check import close

Point = tuple[float, float]


def draw_choice_points(rng: np.random.Generator) -> tuple[int, list[int], list[int], int]:
    """Draw a clip's length, where transitions leave and enter it, and their window."""
    frames, window = int(rng.integers(60, 300)), int(rng.integers(5, 15))
    leaves, enters = (rng.integers(0, frames - window, rng.integers(1, 9)) for _ in range(2))
    return frames, [*leaves.tolist(), int(leaves[0])], enters.tolist(), window


def same_order(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    return bool(given == wanted) if isinstance(given, set) else close(given, wanted)


def draw_turning_point(rng: np.random.Generator) -> tuple[float, float, float]:
    """Draw a planar transform: often no turn at all, a very small one, or a half turn."""
    angle = rng.choice([0.0, 1e-3, -1e-3, np.pi, *rng.uniform(-3, 3, 4)])
    return float(angle), *rng.uniform(-2, 2, 2).tolist()


def fixed_point(angle: float, x: float, z: float) -> Point | None:
    """Solve T c = c, with the point (x, z) as the complex number z + ix."""
    if angle == 0:
        return None
    centre = complex(z, x) / (1 - np.exp(1j * angle))
    return float(centre.imag), float(centre.real)


def same_point(given: Any, wanted: Point | None) -> bool:  # noqa: ANN401
    """Compare two points, or two answers that no point stays; a division by zero may give inf or nan."""
    if given is None or wanted is None:
        return given is wanted
    a, b = np.asarray(given, float), np.asarray(wanted, float)
    if a.shape == b.shape and not np.isfinite(b).all():
        return not np.isfinite(a).all()
    return a.shape == b.shape and np.allclose(a, b, rtol=1e-6, atol=1e-9)


Places = list[tuple[int, int]]
Following = dict[tuple[int, int], Places]
Links = list[tuple[int, int, int, int]]


def draw_successors_of(rng: np.random.Generator) -> tuple[list[list[int]], Links, int]:
    """Draw the choice points of two or three clips, the transitions between them, and their window."""
    window, lengths = int(rng.integers(3, 9)), rng.integers(60, 120, rng.integers(2, 4))
    points = [{0, int(length)} for length in lengths]
    links = []
    for _ in range(rng.integers(3, 8)):
        source, target = rng.integers(len(lengths), size=2).tolist()
        leave, enter = (int(rng.integers(1, lengths[clip] - window)) for clip in (source, target))
        points[source].add(leave)
        points[target].add(enter + window)
        links.append((source, leave, target, enter))
    return [sorted(frames) for frames in points], links, window


def follow(points: list[list[int]], links: Links, window: int) -> Following:
    """Join each choice point to the next of its clip, and the two ends of each transition."""
    following: Following = {(clip, frame): [] for clip, frames in enumerate(points) for frame in frames}
    for clip, frames in enumerate(points):
        for here, there in itertools.pairwise(frames):
            following[clip, here].append((clip, there))
    for source, leave, target, enter in links:
        following.setdefault((source, leave), []).append((target, enter + window))
    return following


def same_following(given: Any, wanted: Any) -> bool:  # noqa: ANN401
    """Compare what follows each node, in any order."""
    return bool(given.keys() == wanted.keys() and all(sorted(given[n]) == sorted(wanted[n]) for n in wanted))
